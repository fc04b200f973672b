// Scenes that must be refused, each with its message: the table through the library, and what a user sees
// through the executable.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/input/scene_file.hpp"
#include "solver/base/error.hpp"
#include "solver/run/stages.hpp"
#include "tests/support/command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

using namespace myowave;
using ::testing::HasSubstr;

struct BadScene {
  const char* what;
  const char* text;
  const char* message;  // the whole first line after "bad.toml"
};

void PrintTo(const BadScene& bad, std::ostream* stream) { *stream << bad.what; }

std::string refusal(std::string_view text, const std::vector<std::string>& overrides = {}) {
  try {
    apps::parse_scene(text, "bad.toml", overrides);
  } catch (const solver::InputError& error) {
    return error.what();
  }
  return "was accepted";
}

class Refused : public ::testing::TestWithParam<BadScene> {};

TEST_P(Refused, with_its_message) {
  EXPECT_EQ(refusal(GetParam().text), std::string("bad.toml") + GetParam().message);
}

const BadScene bad_scenes[] = {
    {"unknown_section", "[grid]\nn = 5\n[outptu]\nevery = 1",
     ":3:2: unknown section \"outptu\"; did you mean \"output\"?"},
    {"unknown_section_far", "[banana]", ":1:2: unknown section \"banana\""},
    {"key_outside_of_its_section", "n = 5",
     ":1:1: \"n\" stands outside of its section; did you mean \"grid.n\"?"},
    {"unknown_key", "[time]\ntend = 3", ":2:1: unknown key \"tend\" in [time]; did you mean \"t_end\"?"},
    {"key_of_another_section", "[grid]\nmu1 = 3",
     ":2:1: unknown key \"mu1\" in [grid]; it is a key of [excitation]"},
    {"unknown_key_far", "[accuracy]\n  speed = 3",
     ":2:3: unknown key \"speed\" in [accuracy]; keys: preset, dx, precision, scheme, on_unstable"},
    {"unknown_key_of_a_precondition", "[[initial.precondition]]\nduration = 3\nmu3 = 1",
     ":3:1: unknown key \"mu3\" in [initial.precondition.0]; did you mean \"mu1\"?"},
    {"unknown_key_of_a_stimulus", "[[stimulus]]\namplitude = 1\n[[stimulus]]\namplitude = 1\nradius = 2",
     ":5:1: unknown key \"radius\" in [stimulus.1]; keys: start, period, duration, amplitude, count, region"},
    {"section_is_a_value", "grid = 5", ":1:8: grid must be a table, not 5"},
    {"section_is_an_array", "[[grid]]\nn = 5", ":1:1: grid must be a table, not an array of 1"},
    {"stimulus_is_a_value", "stimulus = 'all'",
     ":1:12: stimulus must be a table or an array of tables, not \"all\""},
    {"number_is_a_string", "[grid]\ndx = '0.6'",
     ":2:6: grid.dx must be a number > 0 (length units), not \"0.6\""},
    {"number_is_a_flag", "[excitation]\nmu1 = true",
     ":2:7: excitation.mu1 must be a number >= 0 (1/t.u.), not true"},
    {"number_is_an_array", "[excitation]\na = [1, 2]",
     ":2:5: excitation.a must be a number 0 to 1, not an array of 2"},
    {"number_is_a_date", "[excitation]\nb = 1979-05-27",
     ":2:5: excitation.b must be a finite number, not a date or time"},
    {"integer_is_a_float", "[mechanics]\ninterval = 80.0",
     ":2:12: mechanics.interval must be an integer >= 1 (steps), not 80"},
    {"flag_is_an_integer", "[output]\nframes = 1", ":2:10: output.frames must be true or false, not 1"},
    {"choice_is_misspelt", "[mechanics]\nload = 'folower'",
     ":2:8: mechanics.load must be \"follower\" or \"dead\", not \"folower\"; did you mean \"follower\"?"},
    {"choice_is_another_word", "[feedback]\nmetric = 'full'",
     ":2:10: feedback.metric must be \"none\" or \"conservative\" or \"expanded\", not \"full\""},
    {"choice_is_a_number", "[accuracy]\nprecision = 64",
     ":2:13: accuracy.precision must be \"float64\" or \"float32\", not 64"},
    {"n_of_zero", "[grid]\nn = 0",
     ":2:5: grid.n must be an integer or [rows, columns], each 2 to 10000000, not 0"},
    {"n_of_three_numbers", "[grid]\nn = [5, 5, 5]",
     ":2:5: grid.n must be an integer or [rows, columns], each 2 to 10000000, not an array of 3"},
    {"n_beyond_any_machine", "[grid]\nn = 9223372036854775807",
     ":2:5: grid.n must be an integer or [rows, columns], each 2 to 10000000, not 9223372036854775807"},
    {"dx_of_zero", "[grid]\ndx = 0", ":2:6: grid.dx must be a number > 0 (length units), not 0"},
    {"dt_of_nan", "[time]\ndt = nan", ":2:6: time.dt must be a number > 0 (t.u.), not nan"},
    {"t_end_without_end", "[time]\nt_end = inf", ":2:9: time.t_end must be a number >= 0 (t.u.), not inf"},
    {"t_end_below_zero", "[time]\nt_end = -1e-9",
     ":2:9: time.t_end must be a number >= 0 (t.u.), not -1e-09"},
    {"more_steps_than_can_be_counted", "[time]\nt_end = 1e300",
     ":2:9: time.t_end = 1e+300 with time.dt = 0.02 is 5e+301 steps; at most 1e+15 can be counted"},
    {"dx_whose_square_is_no_number", "[grid]\ndx = 1e-200",
     ":2:6: grid.dx = 1e-200: 1/dx^2 = inf is outside of float64 (2.2e-308 to 1.8e+308)"},
    {"dx_whose_square_is_no_float32", "[grid]\ndx = 1e-20\n[accuracy]\nprecision = 'float32'",
     ":2:6: grid.dx = 1e-20: 1/dx^2 = 1e+40 is outside of float32 (1.2e-38 to 3.4e+38)"},
    {"dt_that_is_no_float32", "[time]\ndt = 1e-40\nt_end = 0\n[accuracy]\nprecision = 'float32'",
     ":2:6: time.dt = 1e-40: dt = 1e-40 is outside of float32 (1.2e-38 to 3.4e+38)"},
    {"mu2_of_zero", "[excitation]\nmu2 = 0.0", ":2:7: excitation.mu2 must be a number > 0, not 0"},
    {"tension_faster_than_the_step", "[tension]\neps0 = 100",
     ":2:8: tension.eps_below = 100 is too fast for time.dt = 0.02: the rate times the step must be <= 1"},
    {"elements_do_not_fit", "[grid]\nn = 256\n[mechanics]",
     ":2:5: grid.n = 256: 256 - 1 = 255 cells are not divisible by mechanics.cells_per_element = 10; the "
     "nearest sizes "
     "that are: 251 and 261"},
    {"elements_do_not_fit_the_rows", "[grid]\nn = [33, 21]\n[mechanics]\ncells_per_element = 5",
     ":2:5: grid.n: rows = 33: 33 - 1 = 32 cells are not divisible by mechanics.cells_per_element = 5; the "
     "nearest sizes "
     "that are: 31 and 36"},
    {"elements_do_not_fit_the_default", "[mechanics]\ncells_per_element = 7",
     ":2:21: grid.n = 251: 251 - 1 = 250 cells are not divisible by mechanics.cells_per_element = 7; the "
     "nearest sizes "
     "that are: 246 and 253"},
    {"element_larger_than_the_sheet", "[grid]\nn = 5\n[mechanics]",
     ":2:5: grid.n = 5: 5 - 1 = 4 cells are not divisible by mechanics.cells_per_element = 10; the smallest "
     "size that is: "
     "11"},
    {"no_stiffness", "[mechanics]\nc1 = 0\nc2 = 0",
     ":2:6: mechanics.c1 and mechanics.c2 are both 0: a sheet without stiffness has no equilibrium"},
    {"no_rest_state", "[mechanics]\nc1 = 3\nc2 = 0",
     ":3:6: mechanics.p = 10: a sheet with c1 = 3 and c2 = 0 has no equilibrium under this load; a follower "
     "load with c2 = 0 needs p < 2 c1 = 6"},
    {"no_rest_state_at_the_bound", "[mechanics]\nc2 = 0\np = 4",
     ":3:5: mechanics.p = 4: a sheet with c1 = 2 and c2 = 0 has no equilibrium under this load; a follower "
     "load with c2 = 0 needs p < 2 c1 = 4"},
    {"dead_load_that_pushes", "[mechanics]\nload = 'dead'\np = -0.5",
     ":3:5: mechanics.p = -0.5: the sheet is not stable under this dead load, it would turn around; with c1 "
     "= 2 "
     "and c2 = 6 a dead load must be 0 to 22.02, a follower load may be any"},
    {"dead_load_too_large", "[mechanics]\nload = 'dead'\np = 22.1",
     ":3:5: mechanics.p = 22.1: the sheet is not stable under this dead load, it would stretch more one way "
     "than the other; with c1 = 2 and c2 = 6 a dead load must be 0 to 22.02, a follower load may be any"},
    {"key_of_another_initial_type", "[initial]\ntype = 'rest'\nwidth = 3",
     ":3:9: initial.width belongs to type = \"broken_front\" and has no effect with type = \"rest\""},
    {"offset_of_a_settled_spiral", "[initial]\ntype = 'settled_spiral'\noffset = [3, 3]",
     ":3:10: initial.offset belongs to type = \"broken_front\" and has no effect with type = "
     "\"settled_spiral\"; did you "
     "mean \"core_offset\"?"},
    {"front_too_narrow", "[initial]\ntype = 'broken_front'\nwidth = 0.5",
     ":3:9: initial.width must be a number >= 1 (nodes), not 0.5"},
    {"front_outside", "[grid]\nn = 31\n[initial]\ntype = 'broken_front'\noffset = [0, 16]",
     ":5:10: initial.offset = [0, 16] puts the end of the front at column 15, row 31, outside of the sheet "
     "(columns 0 to "
     "30, rows 0 to 30)"},
    {"core_outside", "[grid]\nn = 31\n[initial]\ntype = 'settled_spiral'\ncore_offset = [-16, 0]",
     ":5:15: initial.core_offset = [-16, 0] puts the core at column -1, row 15, outside of the sheet "
     "(columns 0 to 30, "
     "rows 0 to 30)"},
    {"settled_spiral_of_another_dx", "[grid]\ndx = 0.3\n[initial]\ntype = 'settled_spiral'",
     ":2:6: initial.type = \"settled_spiral\" is defined at grid.dx = 0.6, not 0.3: set initial.dx = 0.6 for "
     "one that is interpolated, or start from \"broken_front\" or a \"file\""},
    {"grid_of_the_start_does_not_fit", "[grid]\nn = 31\n[initial]\ndx = 0.7",
     ":4:6: initial.dx = 0.7: the sides of the sheet (18 and 18 length units) are no whole numbers of it"},
    {"more_nodes_of_the_start_than_can_be_counted", "[initial]\ndx = 1e-9",
     ":2:6: initial.dx = 1e-09 puts 1.5e+11 nodes along a side of 150 length units; at most 1e+07 are "
     "allowed: "
     "set it to 1.5e-05 or more"},
    {"value_of_a_preset", "[accuracy]\npreset = 'fast'\n[output]\nevery = 0.5\ntips_every = 0.3",
     ":4:9: output.every = 0.5 is not a multiple of time.dt = 0.15; the nearest are 0.45 and 0.6"},
    {"more_nodes_than_can_be_counted", "[accuracy]\ndx = 1e-9",
     ":2:6: accuracy.dx = 1e-09 puts 1.5e+11 nodes along a side of 150 length units; at most 1e+07 are "
     "allowed: "
     "set it to 1.5e-05 or more"},
    {"spacing_whose_square_is_no_float32",
     "[grid]\nn = 2\ndx = 1e-14\n[accuracy]\nprecision = 'float32'\ndx = 1e-20",
     ":6:6: accuracy.dx = 1e-20: 1/dx^2 = 1e+40 is outside of float32 (1.2e-38 to 3.4e+38)"},
    {"core_that_the_settled_sheet_lacks", "[initial]\ntype = 'settled_spiral'\ncore_offset = [9, 0]",
     ":3:15: initial.core_offset = [9, 0]: a window of 251 x 251 nodes with the core there leaves the "
     "settled sheet of 251 "
     "x 251 (core at row 81, column 131)"},
    {"offset_of_fractions", "[initial]\ntype = 'broken_front'\noffset = [0.5, 1]",
     ":3:10: initial.offset must be [columns, rows], two integers (nodes), not an array of 2"},
    {"file_not_named", "[initial]\ntype = 'file'",
     ":2:8: initial.file is missing: type = \"file\" needs the path of an HDF5 file"},
    {"file_not_there", "[initial]\ntype = 'file'\nfile = 'no/such.h5'",
     ":3:8: initial.file: there is no file no/such.h5"},
    {"file_is_a_folder", "[initial]\ntype = 'file'\nfile = '/tmp'", ":3:8: initial.file: /tmp is a folder"},
    {"window_below_zero", "[initial]\ntype = 'file'\nfile = '/dev/null'\nwindow = [-1, 0]",
     ":4:10: initial.window must be [row0, column0], two integers, each >= 0 (nodes), not an array of 2"},
    {"negative_seed", "[initial]\nseed = -1", ":2:8: initial.seed must be an integer >= 0, not -1"},
    {"precondition_without_duration", "[initial.precondition]\nmu1 = 0.1",
     ":1:1: initial.precondition.duration is missing: a number > 0 (t.u.)"},
    {"contraction_without_tension", "[tension]\nlaw = 'none'\n[mechanics]",
     ":2:7: tension.law = \"none\" leaves mechanics.contraction = true without a tension; set it to false, "
     "or the "
     "law to \"delayed\" or \"printed\""},
    {"contraction_of_a_precondition_without_tension",
     "[mechanics]\n[[initial.precondition]]\nduration = 5\ncontraction = true\nlaw = 'none'",
     ":4:15: initial.precondition.0.contraction = true needs a tension.law other than \"none\""},
    {"contraction_of_a_rigid_scene", "[[initial.precondition]]\nduration = 5\ncontraction = true",
     ":3:15: initial.precondition.0.contraction = true needs [mechanics]; this scene is rigid"},
    {"stimulus_without_amplitude", "[[stimulus]]\nstart = 3",
     ":1:1: stimulus.0.amplitude is missing: a finite number (1/t.u.)"},
    {"pulses_that_overlap", "[[stimulus]]\namplitude = 1\nduration = 5\nperiod = 3",
     ":3:12: stimulus.0.duration = 5 is longer than its period = 3: pulses would overlap"},
    {"pulses_without_a_period", "[[stimulus]]\namplitude = 1\ncount = 3",
     ":3:9: stimulus.0.count = 3 needs a period > 0"},
    {"pulse_shorter_than_a_step", "[[stimulus]]\namplitude = 1\nduration = 0.001",
     ":3:12: stimulus.0.duration = 0.001 is shorter than a step (time.dt = 0.02)"},
    {"region_of_no_kind", "[[stimulus]]\namplitude = 1\nregion = 'left'",
     ":3:10: stimulus.0.region must be \"all\", {center = [column, row], radius = R} or {columns = [a, b], "
     "rows = [a, b]}, "
     "not \"left\""},
    {"region_with_a_slip", "[[stimulus]]\namplitude = 1\nregion = {centre = [3, 3], radius = 2}",
     ":3:11: unknown key \"centre\" in stimulus.0.region; did you mean \"center\"?"},
    {"region_of_two_kinds",
     "[[stimulus]]\namplitude = 1\nregion = {center = [3, 3], radius = 2, rows = [0, 1]}",
     ":3:10: stimulus.0.region must be \"all\", {center = [column, row], radius = R} or {columns = [a, b], "
     "rows = [a, b]}, "
     "not a table"},
    {"disc_outside", "[grid]\nn = 31\n[[stimulus]]\namplitude = 1\nregion = {center = [31, 3], radius = 2}",
     ":5:10: stimulus.0.region: center = [31, 3] (column, row) is outside of the sheet (columns 0 to 30, "
     "rows 0 to 30)"},
    {"disc_without_a_node", "[[stimulus]]\namplitude = 1\nregion = {center = [3.5, 3.5], radius = 0.5}",
     ":3:10: stimulus.0.region: no node lies within radius = 0.5 of center = [3.5, 3.5]"},
    {"disc_of_negative_radius", "[[stimulus]]\namplitude = 1\nregion = {center = [3, 3], radius = -1}",
     ":3:37: stimulus.0.region.radius must be a number >= 0 (node spacings), not -1"},
    {"block_outside",
     "[grid]\nn = 31\n[[stimulus]]\namplitude = 1\nregion = {columns = [0, 31], rows = [0, 3]}",
     ":5:10: stimulus.0.region: columns = [0, 31], rows = [0, 3] leave the sheet (columns 0 to 30, rows 0 to "
     "30)"},
    {"block_back_to_front", "[[stimulus]]\namplitude = 1\nregion = {columns = [9, 3]}",
     ":3:10: stimulus.0.region: columns = [9, 3], rows = [0, 250]: the last node comes before the first"},
    {"every_off_the_steps", "[output]\nevery = 0.05",
     ":2:9: output.every = 0.05 is not a multiple of time.dt = 0.02; the nearest are 0.04 and 0.06"},
    {"every_below_a_step", "[output]\ntips_every = 0.001",
     ":2:14: output.tips_every = 0.001 is not a multiple of time.dt = 0.02; the smallest is 0.02"},
    {"probe_outside", "[grid]\nn = [31, 41]\n[output]\nprobes = [[0, 40], [31, 0]]",
     ":4:10: output.probes: [31, 0] (row, column) is outside of the sheet (columns 0 to 40, rows 0 to 30)"},
    {"probe_of_one_number", "[output]\nprobes = [[3]]",
     ":2:10: output.probes must be list of [row, column], not an array of 1"},
};

INSTANTIATE_TEST_SUITE_P(scenes, Refused, ::testing::ValuesIn(bad_scenes),
                         [](const auto& one) { return std::string(one.param.what); });

TEST(bad_scenes, toml_errors_have_their_place) {
  EXPECT_THAT(refusal("[grid\nn = 5"), HasSubstr("bad.toml:1:6: "));
  EXPECT_THAT(refusal("[grid]\nn = = 5"), HasSubstr("bad.toml:2:5: "));
  EXPECT_THAT(refusal("[grid]\nn = 5\nn = 6"), HasSubstr("bad.toml:3:"));
  EXPECT_THAT(refusal("[grid]\nn = 99999999999999999999"), HasSubstr("bad.toml:2:"));
  EXPECT_THAT(refusal("a = 'open"), HasSubstr("bad.toml:1:"));
}

TEST(bad_scenes, all_errors_come_at_once_in_the_order_of_the_file) {
  EXPECT_EQ(refusal("[time]\ndt = 0\nt_emd = 3\n[grid]\nn = 1\ndx = -1\n[tension]\nlaw = 'late'\n",
                    {"excitation.mu2=0", "grid.m=3"}),
            "bad.toml:2:6: time.dt must be a number > 0 (t.u.), not 0\n"
            "bad.toml:3:1: unknown key \"t_emd\" in [time]; did you mean \"t_end\"?\n"
            "bad.toml:5:5: grid.n must be an integer or [rows, columns], each 2 to 10000000, not 1\n"
            "bad.toml:6:6: grid.dx must be a number > 0 (length units), not -1\n"
            "bad.toml:8:7: tension.law must be \"delayed\" or \"printed\" or \"none\", not \"late\"\n"
            "--set excitation.mu2: excitation.mu2 must be a number > 0, not 0\n"
            "--set grid.m: unknown key \"m\" in [grid]; keys: n, dx");
}

TEST(bad_scenes, one_wrong_value_does_not_draw_others_along) {
  EXPECT_EQ(refusal("[grid]\nn = 1\n[mechanics]\n[output]\nprobes = [[300, 300]]\n[[stimulus]]\namplitude = "
                    "1\nregion = "
                    "{center = [300, 300], radius = 1}"),
            "bad.toml:2:5: grid.n must be an integer or [rows, columns], each 2 to 10000000, not 1");
}

// Steps that are certainly unstable are refused from the numbers of a scene, before anything runs.
TEST(bad_scenes, unstable_steps_are_refused_with_their_bound) {
  const auto past = [](const char* dt, const char* bound, const char* proposed, const char* where = "") {
    return fmt::format(
        "time.dt = {} is past the stability bound {} of the undeformed sheet{}, 2 C_m / (8 D / dx^2 + k "
        "max(a, "
        "1 - a)). Set time.dt to {} or less, or use a larger grid.dx",
        dt, bound, where, proposed);
  };
  const auto lifts = [](const char* amplitude, const char* rise, const char* limit, const char* proposed) {
    return fmt::format(
        "stimulus.0.amplitude = {} moves V by {} in one step; from {} on the explicit step blows up. Set it "
        "to {} "
        "or less in magnitude, or use a smaller time.dt",
        amplitude, rise, limit, proposed);
  };
  const std::pair<const char*, std::string> cases[] = {
      // finite, and wrong
      {"time.dt = 0.077", past("0.077", "0.0679758", "0.0673")},
      {"time.dt = 0.085", past("0.085", "0.0679758", "0.0673")},
      {"time.dt = 0.077\naccuracy = {on_unstable = 'substep', precision = 'float32'}",
       past("0.077", "0.0679758", "0.0673")},
      {"excitation.k = 200", past("0.02", "0.00989011", "0.00979")},
      // at rest the slope is k a
      {"excitation = {k = 100, a = 0.95}", past("0.02", "0.0170616", "0.0169")},
      {"time.dt = 0.03\nexcitation.D = 4", past("0.03", "0.0208141", "0.0206")},
      {"excitation.C_m = 0.25", past("0.02", "0.016994", "0.0168")},
      {"[[initial.precondition]]\nduration = 5\nk = 200",
       past("0.02", "0.00989011", "0.00979", " during a precondition")},
      {"excitation.eps = 60",
       "time.dt = 0.02 is too long for excitation.eps = 60: r at rest would turn its sign from step to step. "
       "Set "
       "time.dt to 0.0165 or less"},
      {"stimulus = {amplitude = 1e4}", lifts("10000", "200", "4.11", "204")},
      {"stimulus = {amplitude = -250}", lifts("-250", "-5", "3.01", "149")},
  };
  for (const auto& [text, message] : cases) {
    const solver::Scene scene = apps::parse_scene(text, "bad.toml", {});
    std::string refused = "was accepted";
    try {
      solver::require_stable_step(scene);
    } catch (const solver::InputError& error) {
      refused = error.what();
    }
    EXPECT_EQ(refused, message) << text;
  }
}

struct BadOverride {
  const char* override;
  const char* message;
};

TEST(bad_scenes, errors_of_set_are_named_by_their_key) {
  const BadOverride bad_overrides[] = {
      {"grid.n=1", "--set grid.n: grid.n must be an integer or [rows, columns], each 2 to 10000000, not 1"},
      {"grid.dx=wide", "--set grid.dx: grid.dx must be a number > 0 (length units), not \"wide\""},
      {"grid.dx=", "--set grid.dx: grid.dx must be a number > 0 (length units), not \"\""},
      {"grid.dx", "--set grid.dx: must be section.key=value"},
      {"", "--set : must be section.key=value"},
      {"=3", "--set =3: must be section.key=value"},
      {"grid..n=3", "--set grid..n=3: must be section.key=value"},
      {".n=3", "--set .n=3: must be section.key=value"},
      {"gr id.n=3", "--set gr id.n=3: must be section.key=value"},
      {"n=3", "--set n: \"n\" stands outside of its section; did you mean \"grid.n\"?"},
      {"gird.n=3", "--set gird.n: unknown section \"gird\"; did you mean \"grid\"?"},
      {"grid.m=3", "--set grid.m: unknown key \"m\" in [grid]; keys: n, dx"},
      {"grid=3", "--set grid: grid must be a table, not 3"},
      {"grid.n.rows=3", "--set grid.n.rows: grid.n is one value and has no \"rows\""},
      {"stimulus.2.amplitude=3", "--set stimulus.2.amplitude: there is no stimulus 2: the scene has 1"},
      {"stimulus.amplitude=3",
       "--set stimulus.amplitude: stimulus is an array: name an element, for example stimulus.0"},
      {"stimulus.0.amplitude=high",
       "--set stimulus.0.amplitude: stimulus.0.amplitude must be a finite number (1/t.u.), not \"high\""},
      {"initial.precondition.0.duration=3",
       "--set initial.precondition.0.duration: there is no initial.precondition 0: the scene has 0"},
      {"initial.type=spiral",
       "--set initial.type: initial.type must be \"rest\" or \"broken_front\" or \"settled_spiral\" or "
       "\"file\", not "
       "\"spiral\""},
      {"initial.type=file",
       "--set initial.type: initial.file is missing: type = \"file\" needs the path of an HDF5 file"},
      {"output.every=0.03",
       "--set output.every: output.every = 0.03 is not a multiple of time.dt = 0.02; the nearest are 0.02 "
       "and 0.04"},
      {"mechanics.cells_per_element=4",
       "--set mechanics.cells_per_element: grid.n = 251: 251 - 1 = 250 cells are not divisible by "
       "mechanics.cells_per_element = 4; the nearest sizes that are: 249 and 253"},
  };
  for (const BadOverride& bad : bad_overrides) {
    EXPECT_EQ(refusal("grid.dx = 0.6\ngrid.n = 251\n[[stimulus]]\namplitude = 1", {bad.override}),
              bad.message)
        << bad.override;
  }
}

// ---- the executable ---------------------------------------------------------------------------

class Executable : public ::testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return (folder_ / name).string();
  }

  test::TemporaryFolder folder_;
};

TEST_F(Executable, refuses_the_table_with_status_2_and_leaves_no_folder) {
  for (const int index : {0, 3, 11, 20, 30}) {
    const BadScene& bad = bad_scenes[index];
    const std::string scene = file("bad.toml", bad.text);
    const std::string out = (folder_ / "out").string();
    for (const auto& arguments : {std::vector<std::string>{"check", scene}, {"run", scene, "--out", out}}) {
      const test::Outcome outcome = test::run_myowave(arguments);
      EXPECT_EQ(outcome.status, 2) << bad.what;
      EXPECT_EQ(outcome.errors, scene + bad.message + "\n") << bad.what;
      EXPECT_EQ(outcome.output, "") << bad.what;
    }
    EXPECT_FALSE(std::filesystem::exists(out)) << bad.what;
  }
}

TEST_F(Executable, meets_nasty_files_with_status_2) {
  std::string binary;
  for (int i = 0; i < 4096; ++i) binary += static_cast<char>(i * 7919 >> 3);
  std::string dotted = "a";
  for (int i = 0; i < 200000; ++i) dotted += ".a";
  std::string digits = "1.1";  // each pair looks like a number
  for (int i = 0; i < 100000; ++i) digits += " . 1.1";
  const std::pair<std::string, const char*> cases[] = {
      {(folder_ / "absent.toml").string(), "there is no such file"},
      {folder_.path().string(), "is a folder"},
      {"", "there is no such file"},
      {file("binary.toml", binary), "binary.toml:1:"},
      {file("zeros.toml", std::string(1000, '\0')), "zeros.toml:1:"},
      {file("not_utf8.toml", "[grid]\nn = \xff\xfe\n"), "not_utf8.toml:2:"},
      {file("arrays.toml", "grid = " + std::string(100000, '[')), "arrays.toml:1:"},
      {file("tables.toml", "[" + dotted + "]\nb = 1"),
       "tables.toml:1:4003: more than 2000 dots outside of numbers"},
      {file("keys.toml", "\n" + dotted + " = 1"), "keys.toml:2:4002: more than 2000 dots outside of numbers"},
      {file("digits.toml", digits + " = 1"), "digits.toml:1:"},
      {file("large.toml", std::string(3 << 20, '#')), "larger than 1 MiB"},
      {file("long_name.toml", std::string(500000, 'k') + " = 1"), "unknown section \"kkk"},
  };
  for (const auto& [scene, message] : cases) {
    const test::Outcome outcome = test::run_myowave({"check", scene});
    EXPECT_EQ(outcome.status, 2) << scene;
    EXPECT_THAT(outcome.errors, HasSubstr(message));
    EXPECT_LT(outcome.errors.size(), 1000U) << scene;
  }
}

TEST_F(Executable, an_empty_file_is_a_default_scene) {
  const test::Outcome outcome = test::run_myowave({"check", file("empty.toml", ""), "--set", "grid.n=31"});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("valid"));
}

TEST_F(Executable, refuses_more_memory_than_is_free_before_it_takes_any) {
  const std::string scene = file("huge.toml", "[grid]\nn = 2000000\n");
  for (const char* command : {"check", "run"}) {
    const test::Outcome outcome = test::run_myowave({command, scene});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.errors, HasSubstr("scene \"huge\" (2000000 x 2000000 nodes) needs"));
    EXPECT_THAT(outcome.errors, HasSubstr("are free"));
  }
}

TEST_F(Executable, check_looks_into_the_file_of_the_initial_state) {
  const std::string state = file("state.h5", "no HDF5");
  const std::string scene =
      file("from_file.toml", "[grid]\nn = 11\n[initial]\ntype = 'file'\nfile = 'state.h5'");
  const test::Outcome outcome = test::run_myowave({"check", scene});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.errors, HasSubstr(state));
}

TEST_F(Executable, a_run_refused_at_its_start_leaves_no_folder) {
  // Past the stability bound of the rigid sheet, which only the run checks.
  const std::string scene = file("unstable.toml", "grid.n = 11\ntime.dt = 0.1");
  const std::string out = (folder_ / "out").string();
  const test::Outcome outcome = test::run_myowave({"run", scene, "--out", out});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("dt"));
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(Executable, results_are_replaced_only_by_force) {
  const std::string scene = file("short.toml", "grid.n = 11\ntime.t_end = 1");
  const std::string out = (folder_ / "out").string();
  EXPECT_EQ(test::run_myowave({"run", scene, "--out", out}).status, 0);
  const test::Outcome refused = test::run_myowave({"run", scene, "--out", out});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("--force"));
  EXPECT_TRUE(std::filesystem::exists(out + "/summary.json")) << "a refusal takes nothing away";
  EXPECT_EQ(test::run_myowave({"run", scene, "--out", out, "--force", "--until", "2"}).status, 0);
  const auto summary = nlohmann::json::parse(std::ifstream(out + "/summary.json"));
  EXPECT_EQ(summary["t"], 2.0);
  EXPECT_EQ(test::run_myowave({"run", scene, "--out", out, "--force", "--set", "time.dt=0.1"}).status, 2);
  EXPECT_TRUE(std::filesystem::exists(out + "/summary.json")) << "--force does not help a refused run";
}

TEST_F(Executable, a_sheet_without_equilibrium_is_status_3_and_leaves_a_summary_that_says_so) {
  const std::string scene =
      file("strong.toml",
           "grid.n = 21\ntime.t_end = 4\ntension.k_Ta = 1e5\ninitial.type = \"broken_front\"\n[mechanics]");
  const std::string out = (folder_ / "out").string();
  const test::Outcome outcome = test::run_myowave({"run", scene, "--out", out, "--quiet"});
  EXPECT_EQ(outcome.status, 3) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("the numerics failed"));
  const auto summary = nlohmann::json::parse(std::ifstream(out + "/summary.json"));
  EXPECT_TRUE(summary["failure"].is_string());
  EXPECT_EQ(outcome.output, "");
}

TEST_F(Executable, a_run_that_goes_wrong_is_status_3_and_substeps_heal_it) {
  const std::string scene =
      file("current.toml",
           "grid.n = 31\ntime = {dt = 0.06, t_end = 9}\nexcitation.b = 0.5\ninitial.type = \"broken_front\"\n"
           "stimulus = {amplitude = 3, duration = 9}\noutput.every = 1.2");
  const std::string out = (folder_ / "out").string();
  const test::Outcome stopped = test::run_myowave({"run", scene, "--out", out, "--quiet"});
  EXPECT_EQ(stopped.status, 3) << stopped.errors;
  EXPECT_THAT(stopped.errors, HasSubstr("accuracy.on_unstable = \"substep\""));
  EXPECT_TRUE(std::filesystem::exists(out + "/probes.csv")) << "what was computed stays";

  const test::Outcome healed = test::run_myowave(
      {"run", scene, "--out", out, "--force", "--quiet", "--set", "accuracy.on_unstable=substep"});
  EXPECT_EQ(healed.status, 0) << healed.errors;
  const auto summary = nlohmann::json::parse(std::ifstream(out + "/summary.json"));
  EXPECT_EQ(summary["substeps"]["largest"], 2);
  EXPECT_GT(summary["substeps"]["steps"], 0);
  ASSERT_EQ(summary["warnings"].size(), 1U);
  EXPECT_THAT(healed.errors, HasSubstr("myowave: warning: " + summary["warnings"][0].get<std::string>()));
}

TEST_F(Executable, check_accepts_a_scene_whose_trial_fails) {
  const std::string scene =
      file("current.toml",
           "grid.n = 31\ntime = {dt = 0.06, t_end = 9}\nexcitation.b = 0.5\ninitial.type = \"broken_front\"\n"
           "stimulus = {amplitude = 3, duration = 9}");
  const test::Outcome outcome = test::run_myowave({"check", scene});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("time     unknown: t = "));
}

TEST_F(Executable, check_prints_the_warnings_of_a_run) {
  const std::string scene = file("strong.toml", "grid.n = 11\ntension.k_Ta = 80\n[mechanics]");
  const test::Outcome outcome = test::run_myowave({"check", scene});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("warning  tension.k_Ta = 80 kPa is above 60 kPa"));
}

TEST_F(Executable, bad_usage_is_status_2_and_says_what_to_do) {
  const std::string scene = file("good.toml", "grid.n = 11");
  const std::pair<std::vector<std::string>, const char*> cases[] = {
      {{}, "A subcommand is required"},
      {{"rnu", scene}, "there is no subcommand \"rnu\"; did you mean \"run\"?"},
      {{"run"}, "SCENE is required"},
      {{"run", scene, "--sett", "a=1"}, "--sett"},
      {{"run", scene, "--until", "soon"}, "--until"},
      {{"run", scene, "--until", "-3"}, "--until must be a time >= 0 (t.u.), not -3"},
      {{"run", scene, "--until", "nan"}, "--until must be a time >= 0 (t.u.), not nan"},
      {{"run", scene, "--set"}, "--set"},
      {{"check", scene, "--set", "grid"}, "--set grid: must be section.key=value"},
      {{"describe", "grids"}, "did you mean \"grid\"?"},
  };
  for (const auto& [arguments, message] : cases) {
    const test::Outcome outcome = test::run_myowave(arguments);
    EXPECT_EQ(outcome.status, 2) << message;
    EXPECT_THAT(outcome.errors, HasSubstr(message));
  }
}

TEST_F(Executable, help_version_describe_and_info_are_status_0) {
  const std::pair<std::vector<std::string>, const char*> cases[] = {
      {{"--help"}, "run"},         {{"run", "--help"}, "--set"},  {{"check", "--help"}, "SCENE"},
      {{"--version"}, "myowave "}, {{"describe"}, "[mechanics]"}, {{"describe", "time"}, "t_end"},
      {{"info"}, "Kokkos"},
  };
  for (const auto& [arguments, message] : cases) {
    const test::Outcome outcome = test::run_myowave(arguments);
    EXPECT_EQ(outcome.status, 0);
    EXPECT_THAT(outcome.output, HasSubstr(message));
    EXPECT_EQ(outcome.errors, "");
  }
}

}  // namespace
