// Sweep files: the runs they make, and the errors of invalid ones.
#include "apps/sweep/sweep_file.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <set>

#include "apps/input/scene_file.hpp"
#include "solver/base/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace myowave::apps {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr const char* small_scene = "[scene.grid]\nn = 11\n[scene.initial]\ntype = \"broken_front\"\n";

SweepPlan parse(const std::string& text) { return parse_sweep(text + small_scene, "folder/test.toml"); }

std::string refusal(const std::string& text) {
  try {
    parse(text);
  } catch (const solver::InputError& error) {
    return error.what();
  }
  return "";
}

std::vector<double> mu1_of(const SweepPlan& plan) {
  std::vector<double> values;
  for (const auto& run : plan.runs) values.push_back(run.scene.excitation.mu1);
  return values;
}

TEST(SweepFile, MultipliesAxesTheLastFastest) {
  const auto plan = parse(
      "[stop]\non = [\"breakup\", \"death\"]\nt_end = 7\n"
      "[[axis]]\nkey = \"excitation.mu1\"\nvalues = [0.1, 0.2]\n"
      "[[axis]]\nkey = \"tension.k_Ta\"\nmin = 10\nmax = 30\nnum = 3\n");
  EXPECT_THAT(mu1_of(plan), ElementsAre(0.1, 0.1, 0.1, 0.2, 0.2, 0.2));
  std::vector<double> k_Ta;
  std::set<std::string> ids;
  for (const auto& run : plan.runs) {
    k_Ta.push_back(run.scene.tension.k_Ta);
    ids.insert(run.id);
    EXPECT_EQ(run.scene.time.t_end, 7);
    EXPECT_TRUE(run.scene.time.stop_on.breakup && run.scene.time.stop_on.death);
  }
  EXPECT_THAT(k_Ta, ElementsAre(10, 20, 30, 10, 20, 30));
  EXPECT_EQ(ids.size(), 6u);
  EXPECT_EQ(plan.name, "test");
}

// A value from a list and the same value from a range make the same run.
TEST(SweepFile, RangesHaveTheNumbersThatAReaderWrites) {
  const auto range = parse("[[axis]]\nkey = \"excitation.mu1\"\nmin = 0.0975\nmax = 0.12\nnum = 10\n");
  const auto list = parse(
      "[[axis]]\nkey = \"excitation.mu1\"\n"
      "values = [0.0975, 0.1, 0.1025, 0.105, 0.1075, 0.11, 0.1125, 0.115, 0.1175, 0.12]\n");
  ASSERT_EQ(range.runs.size(), 10u);
  for (std::size_t n = 0; n < 10; ++n) {
    EXPECT_EQ(mu1_of(range)[n], mu1_of(list)[n]);
    EXPECT_EQ(range.runs[n].id, list.runs[n].id);
  }
  const auto log =
      parse("[[axis]]\nkey = \"excitation.mu1\"\nmin = 0.01\nmax = 1\nnum = 3\nscale = \"log\"\n");
  EXPECT_THAT(mu1_of(log), ElementsAre(0.01, 0.1, 1));
}

TEST(SweepFile, ZipsAxesAndDrawsSeeds) {
  const auto plan = parse(
      "combine = \"zip\"\n[[axis]]\nkey = \"excitation.mu1\"\nvalues = [0.1, 0.2, 0.3]\n"
      "[[axis]]\nkey = \"initial.seed\"\nseeds = 3\n");
  EXPECT_THAT(mu1_of(plan), ElementsAre(0.1, 0.2, 0.3));
  for (std::size_t n = 0; n < 3; ++n) EXPECT_EQ(plan.runs[n].scene.initial.seed, n + 1);
}

// One sample in each of N equal parts, on each axis; the same ones for the same seed.
TEST(SweepFile, SamplesALatinHypercube) {
  const std::string axes =
      "[[axis]]\nkey = \"excitation.mu1\"\nmin = 0\nmax = 1\n"
      "[[axis]]\nkey = \"tension.k_Ta\"\nmin = 1\nmax = 100\nscale = \"log\"\n";
  const auto plan = parse("[latin_hypercube]\nsamples = 20\nseed = 7\n" + axes);
  ASSERT_EQ(plan.runs.size(), 20u);
  std::set<int> mu1, k_Ta;
  for (const auto& run : plan.runs) {
    mu1.insert(int(run.scene.excitation.mu1 * 20));
    k_Ta.insert(int(std::log10(run.scene.tension.k_Ta) / 2 * 20));
  }
  EXPECT_EQ(mu1.size(), 20u);
  EXPECT_EQ(k_Ta.size(), 20u);
  EXPECT_NE(mu1_of(plan), (std::vector<double>(mu1.begin(), mu1.end())));
  EXPECT_EQ(mu1_of(plan), mu1_of(parse("[latin_hypercube]\nsamples = 20\nseed = 7\n" + axes)));
  EXPECT_NE(mu1_of(plan), mu1_of(parse("[latin_hypercube]\nsamples = 20\nseed = 8\n" + axes)));
  const auto with_others = parse("[latin_hypercube]\nsamples = 20\n" + axes +
                                 "[[axis]]\nkey = \"excitation.a\"\nvalues = [0.1, 0.2]\n");
  EXPECT_EQ(with_others.runs.size(), 40u);
}

TEST(SweepFile, PairsOfTheSameState) {
  const auto plan = parse(
      "[scene.mechanics]\n[[axis]]\nkey = \"mechanics.on\"\nvalues = [true, false]\n"
      "[[axis]]\nkey = \"initial\"\nnames = [\"front\", \"rest\"]\n"
      "values = [{type = \"broken_front\", precondition = {duration = 3, mu1 = 0.15}}, {type = \"rest\"}]\n"
      "[pair]\nkey = \"mechanics.on\"\n");
  ASSERT_TRUE(plan.pairs);
  EXPECT_EQ(plan.pairs->axis, 0u);
  EXPECT_EQ(plan.pairs->reference, 1u);  // rigid
  EXPECT_EQ(plan.pairs->other, 0u);
  ASSERT_EQ(plan.runs.size(), 4u);
  EXPECT_TRUE(plan.runs[0].scene.mechanics);
  EXPECT_FALSE(plan.runs[2].scene.mechanics);
  ASSERT_EQ(plan.runs[2].scene.initial.preconditions.size(), 1u);
  EXPECT_EQ(plan.runs[2].scene.initial.preconditions[0].excitation.mu1, 0.15);
  EXPECT_TRUE(plan.runs[3].scene.initial.preconditions.empty());
  EXPECT_EQ(plan.axes[1].values[0].shown, "front");
}

TEST(SweepFile, ReadsAnotherFilesSceneAndPathsBesideItself) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directories(folder / "sweeps");
  std::filesystem::create_directories(folder / "scenes");
  std::ofstream(folder / "scenes/one.toml") << "[grid]\nn = 12\n";
  std::ofstream(folder / "sweeps/state.h5") << "first";
  std::ofstream(folder / "sweeps/s.toml") << "scene = \"../scenes/one.toml\"\n[[axis]]\nkey = \"initial\"\n"
                                             "names = [\"file\"]\n"
                                             "values = [{type = \"file\", file = \"state.h5\"}]\n";
  const auto plan = read_sweep(folder / "sweeps/s.toml");
  EXPECT_EQ(plan.runs.at(0).scene.grid.rows, 12);
  EXPECT_EQ(plan.runs[0].scene.initial.file, (folder / "sweeps/state.h5").string());
  // The content of the file changes the run's identity; its path does not.
  std::ofstream(folder / "sweeps/state.h5") << "second";
  const auto other = read_sweep(folder / "sweeps/s.toml");
  EXPECT_NE(other.runs[0].id, plan.runs[0].id);
  std::filesystem::rename(folder / "sweeps", folder / "moved");
  EXPECT_EQ(read_sweep(folder / "moved/s.toml").runs[0].id, other.runs[0].id);
}

TEST(RunId, DependsOnWhatTheResultsDependOn) {
  const auto id = [](const std::string& override_text) {
    return run_id(parse_scene("[grid]\nn = 11\n[mechanics]\n", "scene.toml", {override_text}));
  };
  const std::string plain = id("grid.n=11");
  for (const char* shown : {"output.frames=true", "output.fields=true", "output.element_areas=true",
                            "time.ms_per_tu=12.9", "output.from=3"})
    EXPECT_EQ(id(shown), plain) << shown;
  for (const char* changed : {"excitation.mu1=0.13", "time.t_end=401", "mechanics.on=false", "initial.seed=1",
                              "output.tips_every=0.5", "output.period_from=50", "time.stop_on=[\"death\"]"})
    EXPECT_NE(id(changed), plain) << changed;
}

TEST(SweepFile, ReportsAllErrorsWithTheirPlaces) {
  const std::string text = refusal(
      "[[axis]]\nkey = \"excitation.mu\"\nvalues = [1]\n"              // lines 1 to 3
      "[[axis]]\nkey = \"tension.k_Ta\"\nmin = 3\nmax = 2\nnum = 5\n"  // 4 to 8
      "[keep]\nobservables = [\"perod\"]\n[stp]\non = []\n");
  EXPECT_THAT(text,
              HasSubstr("folder/test.toml:2:7: a scene has no key \"excitation.mu\" to be the key of an "
                        "axis; did you mean \"excitation.mu1\"?"));
  EXPECT_THAT(text, HasSubstr("folder/test.toml:7:7: axis.2.max must be above min = 3, not 2"));
  EXPECT_THAT(text,
              HasSubstr("test.toml:10:16: keep.observables has no \"perod\"; did you mean \"period\"?"));
  EXPECT_THAT(text, HasSubstr("test.toml:11:2: unknown key \"stp\"; did you mean \"stop\"?"));
}

TEST(SweepFile, NamesTheValueThatMakesAnInvalidScene) {
  const std::string text = refusal(
      "[[axis]]\nkey = \"excitation.mu1\"\nvalues = [0.1, -0.2, \"x\"]\n"
      "[[axis]]\nkey = \"excitation.a\"\nvalues = [0.1, 0.2]\n");
  EXPECT_EQ(text,
            "folder/test.toml:3:16: value 2 of axis \"excitation.mu1\": excitation.mu1 must be a number >= 0 "
            "(1/t.u.), not -0.2\n"
            "folder/test.toml:3:22: value 3 of axis \"excitation.mu1\": excitation.mu1 must be a number >= 0 "
            "(1/t.u.), not \"x\"");
  EXPECT_THAT(refusal("[[axis]]\nkey = \"time.dt\"\nvalues = [0.01, 0.5]\n"),
              AllOf(HasSubstr("folder/test.toml: run 2 (time.dt = 0.5): "), HasSubstr("bound")));
}

struct Wrong {
  const char *text, *message;
};

TEST(SweepFile, RefusesInvalidFiles) {
  const char* mu1 = "[[axis]]\nkey = \"excitation.mu1\"\n";
  for (const auto& [text, message] : {
           Wrong{"", "a sweep needs one or more tables [[axis]]"},
           Wrong{"[[axis]]\nvalues = [1]\n", "axis.1.key is missing"},
           Wrong{"[[axis]]\nkey = \"mu1\"\nvalues = [1]\n", "did you mean \"excitation.mu1\"?"},
           Wrong{"[[axis]]\nkey = \"excitaton.mu1\"\nvalues = [1]\n", "did you mean \"excitation.mu1\"?"},
           Wrong{"[[axis]]\nkey = \"initial\"\nvalues = [{type = \"rest\"}]\n", "axis.1.names is missing"},
           Wrong{"[[axis]]\nkey = \"grid.n\"\nseeds = 3\n", "\"initial.seed\" where there are seeds"},
       })
    EXPECT_THAT(refusal(text), HasSubstr(message)) << text;
  for (const auto& [rest, message] : {
           Wrong{"", "axis.1 needs one of: values, min and max, seeds"},
           Wrong{"values = []\n", "axis.1.values must be an array of 1 to 100000 values"},
           Wrong{"values = [0.1, 0.1]\n", "0.1 stands there twice"},
           Wrong{"values = [0.1]\nnames = [\"a\", \"b\"]\n", "axis.1.names must be 1 names, one a value"},
           Wrong{"min = 0\nmax = 1\n", "axis.1.num is missing"},
           Wrong{"min = 0\nmax = 1\nnum = 1\n", "axis.1.num must be a number of values, 2 to 100000, not 1"},
           Wrong{"min = 0\nmax = 1\nnum = 3\nscale = \"log\"\n", "axis.1.min must be above 0 on a log scale"},
           Wrong{"min = nan\nmax = 1\nnum = 3\n", "axis.1.min must be a number, not nan"},
           Wrong{"values = [0.1]\n[[axis]]\nkey = \"excitation.mu1\"\nvalues = [0.2]\n", "is set twice"},
           Wrong{"values = [0.1]\n[pair]\nkey = \"excitation.mu1\"\n", "has 1 values; a pair needs 2"},
           Wrong{"values = [0.1]\n[pair]\nkey = \"mechanics.on\"\n", "pair.key must be the key of an axis"},
           Wrong{"min = 0\nmax = 1\nnum = 1000\n[[axis]]\nkey = \"tension.k_Ta\"\nmin = 0\nmax = 1\nnum = "
                 "101\n",
                 "the axes make more than 100000 runs"},
           Wrong{"values = [0.1]\n[stop]\non = [\"brekup\"]\n", "did you mean \"breakup\"?"},
       })
    EXPECT_THAT(refusal(mu1 + std::string(rest)), HasSubstr(message)) << rest;
  EXPECT_THAT(refusal("combine = \"zip\"\n[[axis]]\nkey = \"excitation.mu1\"\nvalues = [0.1, 0.2]\n"
                      "[[axis]]\nkey = \"excitation.a\"\nvalues = [0.1]\n"),
              HasSubstr("axis \"excitation.a\" has 1 values, \"excitation.mu1\" has 2"));
  EXPECT_THAT(refusal("scene = "), HasSubstr("test.toml:1:"));
}

// The shipped sweeps are valid and have as many runs as their first lines say.
TEST(SweepFile, ShippedSweeps) {
  const std::string folder = MYOWAVE_SOURCE_DIR "/apps/scenes/sweeps/";
  const auto fig11 = read_sweep(folder + "breakup_mu1.toml");
  EXPECT_EQ(fig11.runs.size(), 80u);
  EXPECT_TRUE(fig11.pairs);
  EXPECT_EQ(fig11.runs[0].scene.grid.rows, 121);
  EXPECT_EQ(read_sweep(folder + "breakup_mu1_fine.toml").runs.size(), 400u);
  EXPECT_EQ(read_sweep(folder + "breakup_map.toml").runs.size(), 70u);
  EXPECT_EQ(read_sweep(folder + "breakup_presets.toml").runs.size(), 40u);
  const auto drift = read_sweep(folder + "drift_presets.toml");
  EXPECT_EQ(drift.runs.size(), 16u);
  EXPECT_EQ(drift.runs[0].scene.time.dt, 0.02);
  EXPECT_EQ(drift.runs[4].scene.time.dt, 0.125);
}

}  // namespace
}  // namespace myowave::apps
