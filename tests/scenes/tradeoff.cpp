// `myowave tradeoff` through the executable: a rigid and a contracting sheet.
#include <gmock/gmock.h>

#include <fstream>

#include "tests/support/scene_run.hpp"

namespace myowave {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class Tradeoff {
 public:
  Tradeoff(const std::string& scene, std::vector<std::string> arguments) {
    setenv("XDG_CACHE_HOME", MYOWAVE_TEST_CACHE, 1);
    std::ofstream(folder_ / "sheet.toml") << scene;
    arguments.insert(arguments.begin(), {"tradeoff", (folder_ / "sheet.toml").string(), "--out",
                                         out().string(), "--levels", "1,2,3", "--repetitions", "1"});
    outcome = test::run_myowave(arguments);
  }
  std::filesystem::path out() const { return folder_ / "out"; }
  nlohmann::json results() const { return nlohmann::json::parse(test::read_text(out() / "tradeoff.json")); }

  test::Outcome outcome;

 private:
  test::TemporaryFolder folder_;
};

nlohmann::json setting(const nlohmann::json& results, const std::string& name) {
  for (const auto& one : results["settings"])
    if (one["name"] == name) return one;
  ADD_FAILURE() << "there is no setting " << name;
  return {};
}

double error(const nlohmann::json& results, const std::string& name, const std::string& of) {
  return setting(results, name)["errors"][of]["error"];
}

constexpr const char* rigid = R"(# Kept in words.
[grid]
n = 61
[time]
t_end = 30
[initial]
type = "broken_front"
offset = [0, 20]
[output]
every = 5
period_from = 0
)";

TEST(Tradeoff, OfARigidSheetReportsCostAndErrorOfEachSetting) {
  const Tradeoff made(rigid, {"--axes", "time.dt=0.01,0.05,0.5;precision", "--target", "cv=2%,apd=2%"});
  ASSERT_EQ(made.outcome.status, 0) << made.outcome.errors;
  const auto results = made.results();
  EXPECT_EQ(setting(results, "paper")["speed_up"], 1);
  EXPECT_GT(setting(results, "fast")["speed_up"], 1);
  EXPECT_LT(error(results, "reference", "cv"), 0.3 * error(results, "paper", "cv"));
  EXPECT_LT(error(results, "reference", "field_end"), error(results, "paper", "field_end"));
  EXPECT_NEAR(results["reference"]["values"]["cv"]["order"], 2, 1.5);
  for (const char* of : {"cv", "apd", "field_end"})
    EXPECT_LE(error(results, "balanced", of), error(results, "paper", of)) << of;
  EXPECT_LT(error(results, "fast", "cv"), 2);
  EXPECT_THAT(setting(results, "paper, time.dt=0.5")["trouble"].get<std::string>(), StartsWith("refused: "));
  EXPECT_FALSE(results["reference"]["chaotic"]);

  EXPECT_THAT(test::read_text(made.out() / "tradeoff.csv"), HasSubstr("cv_error,cv_uncertainty,cv_on_front"));
  for (const char* name : {"error_cv", "error_field_end"}) {
    EXPECT_THAT(test::read_text(made.out() / (std::string(name) + ".png")), StartsWith("\x89PNG"));
    EXPECT_THAT(test::read_text(made.out() / (std::string(name) + ".svg")), HasSubstr("</svg>"));
  }
  EXPECT_THAT(test::read_text(made.out() / "index.html"), HasSubstr("data:image/png;base64,"));

  const auto target = made.out() / "target.toml";
  const test::Outcome check = test::run_myowave({"check", target.string()});
  EXPECT_EQ(check.status, 0) << check.errors << test::read_text(target);
}

TEST(Tradeoff, OfAContractingSheetHasTheMechanicsDialsAndNamesTheNearestSetting) {
  const Tradeoff made(
      std::string(rigid) + "[mechanics]\n",
      {"--set", "time.t_end=20", "--axes", "metric=none;interval=40", "--target", "area=1e-9"});
  ASSERT_EQ(made.outcome.status, 3) << made.outcome.output << made.outcome.errors;
  EXPECT_THAT(made.outcome.errors, HasSubstr("the nearest is \""));
  EXPECT_FALSE(std::filesystem::exists(made.out() / "target.toml"));
  const auto results = made.results();
  EXPECT_LT(error(results, "reference", "cv"), 0.3 * error(results, "paper", "cv"));
  EXPECT_EQ(error(results, "paper, feedback.metric=none", "cv"), error(results, "paper", "cv"));
  EXPECT_GT(error(results, "paper, feedback.metric=none", "field_end"),
            2 * error(results, "paper", "field_end"));
  EXPECT_TRUE(setting(results, "balanced, mechanics.interval=40")["errors"].contains("shortening"));
}

// P15 at mu1 = 0.105: with the paper's steps, which make waves 3 % slow, the spiral does not break up.
TEST(Tradeoff, ReportsWhenASpiralBreaksUp) {
  const Tradeoff made(R"(
[grid]
n = 121
[time]
t_end = 75
[excitation]
mu1 = 0.105
[initial]
type = "broken_front"
offset = [-5, 40]
precondition = { duration = 270, mu1 = 0.15 }
)",
                      {"--axes", "none"});
  ASSERT_EQ(made.outcome.status, 0) << made.outcome.errors;
  const auto results = made.results();
  EXPECT_EQ(results["settings"].size(), 4u) << "the presets alone";
  const auto& breakup = results["reference"]["values"]["breakup"];
  EXPECT_NEAR(breakup["value"], 65, 1);
  EXPECT_LT(breakup["uncertainty"], 1);
  for (const char* preset : {"fast", "balanced", "reference"})
    EXPECT_LT(error(results, preset, "breakup"), 3) << preset;
  EXPECT_TRUE(setting(results, "paper")["errors"]["breakup"]["error"].is_null());
  EXPECT_THAT(made.outcome.output, testing::ContainsRegex("paper .* does not occur"));
}

TEST(Tradeoff, LeavesOutWhatExceedsTheBudgetAndSaysSo) {
  const Tradeoff made(rigid, {"--axes", "dt=0.01", "--budget", "1e-9"});
  ASSERT_EQ(made.outcome.status, 0) << made.outcome.errors;
  const auto results = made.results();
  EXPECT_EQ(setting(results, "paper")["speed_up"], 1);
  EXPECT_EQ(setting(results, "fast")["trouble"], "left out: the budget was spent");
  EXPECT_THAT(made.outcome.output, HasSubstr("fast: left out: the budget was spent"));
}

TEST(Tradeoff, RefusesInvalidInputBeforeItRuns) {
  const auto errors = [](std::vector<std::string> arguments) {
    const Tradeoff made(rigid, std::move(arguments));
    EXPECT_EQ(made.outcome.status, 2);
    return made.outcome.errors;
  };
  EXPECT_THAT(errors({"--axes", "mechanics.interval"}), HasSubstr("has no effect"));
  EXPECT_THAT(errors({"--target", "speed=1%"}), HasSubstr("no error \"speed\""));
  EXPECT_THAT(errors({"--starts", "0"}), HasSubstr("--starts must be at least 1"));
  EXPECT_THAT(errors({"--set", "time.dt=3"}), HasSubstr("time.dt"));
  const test::Outcome list = test::run_myowave({"tradeoff", "--list"});
  EXPECT_EQ(list.status, 0);
  EXPECT_THAT(list.output, HasSubstr("mechanics.cells_per_element"));
}

}  // namespace
}  // namespace myowave
