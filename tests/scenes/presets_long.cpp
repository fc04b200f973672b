// What README says of the presets, on one spiral of 150 x 150 length units.
#include <gmock/gmock.h>

#include "tests/support/scene_run.hpp"

namespace myowave {
namespace {

nlohmann::json settings_of_spiral(const std::vector<std::string>& overrides) {
  setenv("XDG_CACHE_HOME", MYOWAVE_TEST_CACHE, 1);
  const test::TemporaryFolder folder;
  std::vector<std::string> arguments{"tradeoff", MYOWAVE_SOURCE_DIR "/apps/scenes/contracting_spiral.toml",
                                     "--out",    (folder / "out").string(),
                                     "--axes",   "precision=float64",
                                     "--levels", "1,2,3",
                                     "--set",    "time.t_end=100",
                                     "--set",    "output.period_from=20"};
  for (const auto& one : overrides) arguments.insert(arguments.end(), {"--set", one});
  const test::Outcome outcome = test::run_myowave(arguments);
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  return nlohmann::json::parse(test::read_text(folder / "out" / "tradeoff.json"))["settings"];
}

double error(const nlohmann::json& settings, const std::string& name, const std::string& of) {
  for (const auto& one : settings)
    if (one["name"] == name) return one["errors"][of]["error"];
  ADD_FAILURE() << "there is no setting " << name;
  return 0;
}

void expect_promises(const nlohmann::json& settings, std::vector<std::string> also) {
  std::vector<std::string> balanced{"cv", "apd", "period", "field_half", "field_end"}, fast{"cv", "period"};
  balanced.insert(balanced.end(), also.begin(), also.end());
  fast.insert(fast.end(), also.begin(), also.end());
  for (const auto& of : balanced)
    EXPECT_LT(error(settings, "balanced", of), error(settings, "paper", of)) << of;
  for (const auto& of : fast) EXPECT_LT(error(settings, "fast", of), 2) << of;
  for (const char* of : {"apd", "field_half", "field_end"})
    EXPECT_LT(error(settings, "balanced", of), error(settings, "fast", of)) << of;
}

TEST(Presets, OnARigidSheetHaveTheDocumentedErrors) {
  expect_promises(settings_of_spiral({"mechanics.on=false"}), {});
}

TEST(Presets, OnAContractingSheetHaveTheDocumentedErrors) {
  expect_promises(settings_of_spiral({}), {"shortening"});
}

}  // namespace
}  // namespace myowave
