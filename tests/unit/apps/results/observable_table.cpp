#include "apps/results/observable_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

namespace myowave::apps {
namespace {

TEST(ObservableTable, HasEachNameOnceAndGroupsTogether) {
  std::set<std::string_view> paths, columns, errors;
  for (const auto& row : observable_table()) {
    EXPECT_TRUE(paths.insert(row.path).second) << row.path;
    EXPECT_TRUE(row.column.empty() || columns.insert(row.column).second) << row.column;
    EXPECT_TRUE(row.error.kind == ObservableError::Kind::none || errors.insert(row.error.name).second);
    EXPECT_TRUE(row.curve.empty() || !row.column.empty()) << "curves of sweeps are of columns: " << row.path;
  }
  const auto groups = observable_groups();
  EXPECT_EQ(std::set(groups.begin(), groups.end()).size(), groups.size());
  EXPECT_THAT(groups,
              testing::ElementsAre("period", "apd", "apd90", "tips", "trajectories", "core",
                                   "conduction_velocity", "breakup_tu", "death_tu", "area", "shortening"));
}

TEST(ObservableTable, FindsRowsByTheirPath) {
  ASSERT_NE(find_observable_row("core/drift_speed"), nullptr);
  EXPECT_EQ(find_observable_row("core/drift_speed")->unit.text, "length units/t.u.");
  EXPECT_EQ(find_observable_row("core"), nullptr);
}

TEST(ObservableTable, OfARunWithoutAnythingHasNullsAndCountsOfZero) {
  EXPECT_EQ(
      observables_json({}).dump(),
      R"({"period":{"mean":null,"sd":null,"n":0},"apd":{"mean":null,"sd":null,"n":0},"apd90":{"mean":null,"sd":null,"n":0},)"
      R"("tips":{"mean":null,"sd":null,"n":0,"correlation_tu":null,"effective_n":null,"standard_error":null},)"
      R"("trajectories":{"n":0,"born":{"start":0,"pair":0,"boundary":0,"alone":0},)"
      R"("ended":{"end":0,"pair":0,"boundary":0,"alone":0}},"core":null,"conduction_velocity":null,)"
      R"("breakup_tu":null,"death_tu":null,"area":null,"shortening":null})");
}

TEST(ObservableTable, LeavesOutWhatALongestTrajectoryLacks) {
  solver::Observables observables;
  auto& longest = observables.longest_trajectory.emplace();
  EXPECT_TRUE(observables_json(observables)["core"].is_null()) << "no core before one rotation";
  longest.number = 2;
  longest.core = {1, 2, 0.5, 1};
  EXPECT_EQ(observables_json(observables)["core"].dump(),
            R"({"trajectory":2,"x":1.0,"y":2.0,"radius":0.5,"rotations":1,"drift_speed":null,)"
            R"("drift_direction":null,"boundary_tu":null})");
}

}  // namespace
}  // namespace myowave::apps
