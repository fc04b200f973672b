// The meaning of valid scene files. Invalid ones: tests/faults/bad_scenes.cpp.
#include "apps/input/scene_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/base/memory.hpp"
#include "apps/input/schema.hpp"
#include "solver/base/error.hpp"
#include "solver/run/make_plan.hpp"
#include "solver/run/run.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

using namespace myowave;
using apps::parse_scene;
using solver::Scene;
using Set = std::vector<std::string>;

Scene scene(std::string_view text, const Set& overrides = {}) {
  return parse_scene(text, "dir/some.toml", overrides);
}

TEST(scene_file, name_is_that_of_the_file) { EXPECT_EQ(scene("").name, "some"); }

TEST(scene_file, grid_is_a_side_or_rows_and_columns) {
  EXPECT_EQ(scene("grid.n = 31").grid.rows, 31);
  EXPECT_EQ(scene("grid.n = 31").grid.columns, 31);
  EXPECT_EQ(scene("grid.n = [21, 33]").grid.rows, 21);
  EXPECT_EQ(scene("grid.n = [21, 33]").grid.columns, 33);
}

TEST(scene_file, integers_serve_as_numbers) { EXPECT_EQ(scene("[mechanics]\np = -10").mechanics->p, -10.0); }

TEST(scene_file, the_tension_law_sets_the_rates) {
  const auto rates = [](std::string_view keys) {
    const Scene made = scene(std::string("[tension]\n") + std::string(keys));
    const auto tension = solver::tension_parameters(made.tension);
    return std::pair(tension.eps_below, tension.eps_above);
  };
  EXPECT_EQ(rates(""), std::pair(1.0, 0.1));
  EXPECT_EQ(rates("law = 'delayed'"), std::pair(1.0, 0.1));
  EXPECT_EQ(rates("law = 'printed'"), std::pair(1.0, 10.0));
  EXPECT_EQ(rates("law = 'printed'\neps0 = 0.5"), std::pair(0.5, 5.0));
  EXPECT_EQ(rates("eps0 = 2"), std::pair(2.0, 0.2));
  // Rates that are given hold as they are, wherever they stand.
  EXPECT_EQ(rates("eps_above = 3\neps0 = 2\nlaw = 'printed'"), std::pair(2.0, 3.0));
  EXPECT_EQ(rates("eps_below = 4\neps_above = 3"), std::pair(4.0, 3.0));
}

TEST(scene_file, mechanics_is_there_when_its_section_is) {
  EXPECT_FALSE(scene("").mechanics.has_value());
  EXPECT_TRUE(scene("[mechanics]").mechanics.has_value());
  EXPECT_TRUE(scene("[mechanics]\non = true").mechanics.has_value());
  EXPECT_FALSE(scene("[mechanics]\non = false\np = 3").mechanics.has_value());
  EXPECT_FALSE(scene("[mechanics]", {"mechanics.on=false"}).mechanics.has_value());
  EXPECT_TRUE(scene("", {"mechanics.interval=20"}).mechanics.has_value());
}

TEST(scene_file, a_rigid_scene_may_name_a_metric_and_any_size) {
  EXPECT_EQ(scene("grid.n = 7\nfeedback.metric = 'none'").metric, solver::MetricForm::none);
  EXPECT_EQ(scene("grid.n = 7\nmechanics.on = false").grid.rows, 7);
}

TEST(scene_file, preconditions_start_from_the_scene) {
  const Scene made = scene(R"(
[excitation]
mu1 = 0.07
b = 0.12
[tension]
law = "printed"
eps0 = 0.5
[mechanics]
[[initial.precondition]]
duration = 10
mu1 = 0.15
[[initial.precondition]]
duration = 20
contraction = true
law = "delayed"
k_Ta = 30
)");
  ASSERT_EQ(made.initial.preconditions.size(), 2U);
  const auto& [first, second] = std::tie(made.initial.preconditions[0], made.initial.preconditions[1]);
  EXPECT_EQ(first.duration, 10);
  EXPECT_FALSE(first.contraction);
  EXPECT_EQ(first.excitation.mu1, 0.15);
  EXPECT_EQ(first.excitation.b, 0.12);
  EXPECT_EQ(first.tension.eps_above, 5);
  EXPECT_TRUE(second.contraction);
  EXPECT_EQ(second.excitation.mu1, 0.07);
  // Its law, the scene's eps0.
  EXPECT_EQ(second.tension.eps_below, 0.5);
  EXPECT_EQ(second.tension.eps_above, 0.05);
  EXPECT_EQ(second.tension.k_Ta, 30);
  EXPECT_EQ(made.excitation.mu1, 0.07);
}

TEST(scene_file, one_precondition_may_be_one_table) {
  for (const char* text :
       {"[initial.precondition]\nduration = 5", "[initial]\nprecondition = {duration = 5}",
        "[initial]\nprecondition = [{duration = 5}]", "[[initial.precondition]]\nduration = 5"}) {
    ASSERT_EQ(scene(text).initial.preconditions.size(), 1U) << text;
    EXPECT_EQ(scene(text, {"initial.precondition.0.duration=6"}).initial.preconditions[0].duration, 6)
        << text;
  }
}

TEST(scene_file, stimuli_and_their_regions) {
  using Shape = solver::Stimulus::Shape;
  const Scene made = scene(R"(
[grid]
n = [41, 61]
[[stimulus]]
amplitude = 0.5
[[stimulus]]
amplitude = 2
start = 10
period = 30
duration = 2
region = {center = [30, 20.5], radius = 3}
[[stimulus]]
amplitude = -1
period = 30
count = 4
region = {columns = [0, 60], rows = [3, 5]}
[[stimulus]]
amplitude = 1
region = {columns = [0, 2]}
)");
  ASSERT_EQ(made.stimuli.size(), 4U);
  EXPECT_EQ(made.stimuli[0].shape, Shape::all);
  EXPECT_EQ(made.stimuli[0].count, 1);
  EXPECT_EQ(made.stimuli[1].shape, Shape::disc);
  EXPECT_EQ(made.stimuli[1].center, (std::array{30.0, 20.5}));
  EXPECT_EQ(made.stimuli[1].radius, 3);
  EXPECT_EQ(made.stimuli[1].count, -1) << "a period without a count repeats without end";
  EXPECT_EQ(made.stimuli[2].shape, Shape::block);
  EXPECT_EQ(made.stimuli[2].columns, (std::array{0, 60}));
  EXPECT_EQ(made.stimuli[2].rows, (std::array{3, 5}));
  EXPECT_EQ(made.stimuli[2].count, 4);
  EXPECT_EQ(made.stimuli[3].rows, (std::array{0, 40})) << "the side that is not named is whole";
}

TEST(scene_file, outputs_follow_every) {
  const auto output = [](const Set& overrides) { return scene("", overrides).output; };
  EXPECT_EQ(output({"output.every=4"}).tips_every, 4);
  EXPECT_EQ(output({"output.every=4", "output.tips_every=0.2"}).tips_every, 0.2);
  EXPECT_EQ(output({"output.tips_every=0.2", "output.every=4"}).tips_every, 0.2);
  EXPECT_EQ(output({"output.tips_every=0.2", "output.every=4"}).probes_every, 4);
  // Without a word on outputs the step may be anything.
  EXPECT_DOUBLE_EQ(output({"time.dt=0.03"}).every, 0.99);
  EXPECT_DOUBLE_EQ(output({"time.dt=0.03"}).tips_every, 0.99);
}

TEST(scene_file, decimal_multiples_of_dt_count_as_such) {
  for (const char* every : {"0.02", "0.06", "0.2", "0.58", "1.14", "333.34", "1e6"}) {
    EXPECT_NO_THROW(scene("", {std::string("output.every=") + every})) << every;
  }
}

TEST(scene_file, default_probes_are_a_quarter_from_the_corners) {
  const Scene made = scene("grid.n = [41, 63]");  // q = 40/4 = 10 and 62/4 = 15
  const std::vector<std::array<int, 2>> expected{{10, 15}, {10, 47}, {30, 15}, {30, 47}};
  EXPECT_EQ(made.output.probes, expected);
}

TEST(scene_file, paths_are_relative_to_the_file_and_of_set_to_the_working_directory) {
  const test::TemporaryFolder temporary;
  const std::string folder = temporary.path().string();
  const std::string state = folder + "/state.h5";
  std::ofstream(state) << "not read here";
  const std::string text = "[initial]\ntype = 'file'\nfile = 'state.h5'";
  EXPECT_EQ(parse_scene(text, folder + "/a.toml").initial.file, state);
  const std::string from_here = std::filesystem::relative(state).string();
  EXPECT_EQ(parse_scene(text, "elsewhere/a.toml", {"initial.file=" + from_here}).initial.file, from_here);
  EXPECT_EQ(
      parse_scene("initial.type = 'file'\ninitial.file = '" + state + "'", "elsewhere/a.toml").initial.file,
      state);
}

TEST(scene_file, set_takes_bare_and_quoted_strings_arrays_and_tables) {
  EXPECT_EQ(scene("", {"tension.law=printed"}).tension.law, solver::TensionLaw::printed);
  EXPECT_EQ(scene("", {"tension.law=\"printed\""}).tension.law, solver::TensionLaw::printed);
  EXPECT_EQ(scene("", {"tension.law='printed'"}).tension.law, solver::TensionLaw::printed);
  EXPECT_EQ(scene("", {" tension.law = printed "}).tension.law, solver::TensionLaw::printed);
  EXPECT_EQ(scene("", {"grid.n=[21,31]"}).grid.columns, 31);
  EXPECT_EQ(scene("", {"stimulus=[{amplitude=1},{amplitude=2}]"}).stimuli.at(1).amplitude, 2);
  EXPECT_EQ(scene("", {"initial.precondition={duration=3}"}).initial.preconditions.at(0).duration, 3);
  EXPECT_EQ(scene("[[stimulus]]\namplitude = 1", {"stimulus.0.region={columns=[3,4]}"}).stimuli[0].columns[1],
            4);
  EXPECT_EQ(scene("[[stimulus]]\namplitude = 1", {"stimulus.0.amplitude=7"}).stimuli[0].amplitude, 7);
}

TEST(scene_file, the_last_set_wins) { EXPECT_EQ(scene("grid.n = 5", {"grid.n=7", "grid.n=9"}).grid.rows, 9); }

TEST(scene_file, a_preset_leaves_what_the_scene_names_and_set_changes_it) {
  const Scene fast = scene("accuracy.preset = 'fast'\ntime.dt = 0.05");
  EXPECT_EQ(fast.preset, "fast");
  EXPECT_EQ(fast.scheme, solver::Scheme::split);
  EXPECT_EQ(fast.precision, solver::Precision::float32);
  EXPECT_EQ(fast.time.dt, 0.05);
  EXPECT_FALSE(fast.mechanics.has_value());
  const Scene paper = scene("[time]\ndt = 0.05\n[mechanics]\ninterval = 20", {"accuracy.preset=paper"});
  EXPECT_EQ(paper.time.dt, 0.02);
  EXPECT_EQ(paper.mechanics->interval, 80);
  EXPECT_EQ(scene("[mechanics]", {"accuracy.preset=balanced", "mechanics.interval=7"}).mechanics->interval,
            7);
}

TEST(scene_file, another_spacing_leaves_the_sheet_as_large) {
  const std::string text = R"(
[grid]
n = [101, 251]
[mechanics]
[output]
probes = [[50, 125], [100, 250]]
[[stimulus]]
amplitude = 1
region = {center = [125, 50], radius = 5}
[[stimulus]]
amplitude = 1
region = {columns = [0, 10]}
)";
  const Scene coarse = scene(text, {"accuracy.dx=1"});
  EXPECT_EQ(coarse.grid.dx, 1.0);
  EXPECT_EQ(coarse.grid.rows, 61);
  EXPECT_EQ(coarse.grid.columns, 151);
  EXPECT_EQ(coarse.mechanics->cells_per_element, 6);
  EXPECT_EQ(coarse.output.probes, (std::vector<std::array<int, 2>>{{30, 75}, {60, 150}}));
  EXPECT_EQ(coarse.stimuli[0].center, (std::array{75.0, 30.0}));
  EXPECT_EQ(coarse.stimuli[0].radius, 3.0);
  EXPECT_EQ(coarse.stimuli[1].columns, (std::array{0, 6}));
  EXPECT_EQ(coarse.stimuli[1].rows, (std::array{0, 60}));
  EXPECT_EQ(coarse.initial.dx, 0.6);
  // Nothing moves where the sheet has that spacing already.
  EXPECT_EQ(apps::effective_configuration(scene(text, {"accuracy.dx=0.6"}))["grid"],
            apps::effective_configuration(scene(text))["grid"]);
}

TEST(scene_file, the_spacing_is_the_largest_up_to_that_which_fits) {
  const auto spacing = [](const std::string& text, double dx) {
    return scene(text, {fmt::format("accuracy.dx={}", dx)}).grid.dx;
  };
  EXPECT_DOUBLE_EQ(spacing("mechanics.cells_per_element = 10", 0.8), 0.75);
  EXPECT_DOUBLE_EQ(spacing("mechanics.cells_per_element = 10", 0.5), 0.5);
  EXPECT_DOUBLE_EQ(spacing("mechanics.cells_per_element = 1", 1), 0.6);
  EXPECT_DOUBLE_EQ(spacing("grid.n = 128", 1), 127 * 0.6 / 77);
  EXPECT_DOUBLE_EQ(spacing("grid.n = 11\ngrid.dx = 1e-9", 1), 1e-8) << "larger than the sheet";
  EXPECT_DOUBLE_EQ(spacing("grid.n = [101, 251]", 0.9), 30.0 / 34);
}

TEST(scene_file, what_a_scene_on_another_spacing_says_of_itself_is_that_scene) {
  const auto configuration = apps::effective_configuration(
      scene("[mechanics]\n[initial]\ntype = 'settled_spiral'", {"accuracy.dx=0.8"}));
  std::string text;
  for (const auto& [section, keys] : configuration.items())
    for (const auto& [key, value] : keys.items())
      text += fmt::format("{}.{} = {}\n", section, key, value.dump());
  EXPECT_EQ(apps::effective_configuration(scene(text)), configuration);
}

TEST(scene_file, the_step_of_a_preset_follows_the_spacing) {
  const Scene usual = scene("accuracy.preset = 'fast'"),
              finer = scene("accuracy.preset = 'fast'", {"accuracy.dx=0.6"});
  EXPECT_DOUBLE_EQ(usual.grid.dx, 150.0 / 131);
  EXPECT_LE(finer.time.dt / (0.6 * 0.6), usual.time.dt / (usual.grid.dx * usual.grid.dx) * 1.2);
  EXPECT_EQ(scene("accuracy.preset = 'fast'\ntime.dt = 0.03", {"accuracy.dx=0.6"}).time.dt, 0.03);
  EXPECT_EQ(scene("accuracy.preset = 'fast'\nexcitation.D = 2").time.dt, usual.time.dt / 2);
  // ... and the outputs
  EXPECT_EQ(usual.time.dt, 0.2);
  EXPECT_DOUBLE_EQ(scene("accuracy.preset = 'fast'\noutput.every = 0.5").time.dt, 0.5 / 3);
  EXPECT_DOUBLE_EQ(scene("accuracy.preset = 'fast'\noutput.tips_every = 0.1").time.dt, 0.1);
  EXPECT_DOUBLE_EQ(scene("accuracy.preset = 'balanced'\noutput.tips_every = 0.2").time.dt, 0.1);
}

TEST(scene_file, set_of_the_type_forgives_keys_of_the_file_for_another) {
  const Scene made = scene("[initial]\ntype = 'broken_front'\nwidth = 7", {"initial.type=rest"});
  EXPECT_EQ(made.initial.type, solver::InitialSettings::Type::rest);
}

TEST(scene_file, comments_blank_lines_and_windows_line_ends) {
  EXPECT_EQ(scene("# a\r\n[grid]\r\n\r\nn = 31 # nodes\r\n").grid.rows, 31);
  EXPECT_EQ(scene("\xef\xbb\xbfgrid.n = 31").grid.rows, 31) << "a byte order mark";
}

TEST(scene_file, every_shipped_scene_is_right) {
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(MYOWAVE_SOURCE_DIR "/apps/scenes")) {
    if (entry.path().extension() != ".toml") continue;
    EXPECT_NO_THROW(apps::read_scene(entry.path())) << entry.path();
    ++scenes;
  }
  EXPECT_GE(scenes, 7);
}

TEST(memory, a_sheet_that_does_not_fit_is_refused_by_its_numbers) {
  Scene made = scene("");
  EXPECT_NO_THROW(apps::require_memory(made));
  made.grid.rows = made.grid.columns = 2000000;
  try {
    apps::require_memory(made);
    FAIL() << "was accepted";
  } catch (const solver::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("2000000 x 2000000 nodes) needs"), std::string::npos)
        << error.what();
  }
}

TEST(memory, the_largest_sheet_of_the_schema_does_not_overflow) {
  for (const char* more : {"mechanics.cells_per_element=1", "mechanics.on=false"}) {
    const Scene made = scene("grid.n = 10000000", {more});
    EXPECT_GT(solver::memory_bytes(made), 1'000'000'000'000'000U) << more;
  }
}

TEST(memory, bytes_read_well) {
  EXPECT_EQ(apps::bytes_text(0), "0 B");
  EXPECT_EQ(apps::bytes_text(1023), "1023 B");
  EXPECT_EQ(apps::bytes_text(1536), "1.5 KiB");
  EXPECT_EQ(apps::bytes_text(3ULL << 30), "3.0 GiB");
}

}  // namespace
