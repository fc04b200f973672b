// Explicit steps on sheets that are held deformed: where they are right, finite but wrong, or blow up.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>

#include "solver/studies/step_maps.hpp"
#include "solver/studies/step_trial.hpp"

namespace myowave {
namespace {

using solver::MapTable;
using solver::MetricForm;
using solver::Precision;
using solver::StepOutcome;
using solver::StepTrial;

// 61 x 61 nodes; element nodes at x(X1, X2).
template <class Placement>
StepTrial sheet_of(MetricForm form, Precision precision, int cells, const Placement& x) {
  StepTrial trial;
  trial.grid = {61, 61, 0.6};
  trial.form = form;
  trial.precision = precision;
  trial.cells_per_element = cells;
  const double h = cells * trial.grid.dx;
  for (int I = 0; I <= 60 / cells; ++I)
    for (int J = 0; J <= 60 / cells; ++J)
      for (const double coordinate : x(J * h, I * h)) trial.nodes.push_back(coordinate);
  return trial;
}

using Place = std::array<double, 2>;

Place undeformed(double X1, double X2) { return {X1, X2}; }

// Neighbouring element nodes moved by `moved` edges in opposite directions along the diagonal: the smallest
// corner J is 1 - 4 moved.
solver::DeformedSheet crumpled(MetricForm form, double moved) {
  return {moved, sheet_of(form, Precision::float64, 10, [=](double X1, double X2) -> Place {
            const double step = 6 * (std::lround((X1 + X2) / 6) % 2 != 0 ? moved : -moved);
            return {X1 + step, X2 + step};
          })};
}

const MapTable& crumpled_map() {
  static const MapTable table =
      solver::map_of_steps("crumpled", "", {"moved", "element edges"},
                           {crumpled(MetricForm::conservative, 0.1), crumpled(MetricForm::conservative, 0.23),
                            crumpled(MetricForm::expanded, 0.1), crumpled(MetricForm::expanded, 0.2),
                            crumpled(MetricForm::expanded, 0.23)},
                           [](double) {});
  return table;
}

double number(const MapTable& table, const solver::MapRow& row, const std::string& column) {
  const auto found = std::ranges::find(table.columns, column, &solver::MapColumn::name);
  return std::get<double>(row.cells.at(static_cast<std::size_t>(found - table.columns.begin())));
}

TEST(StabilityMaps, RigidSheetAtThePapersSpacing) {
  const auto sheet = sheet_of(MetricForm::none, Precision::float64, 10, undeformed);
  EXPECT_NEAR(solver::stability_bounds(sheet).excited, 2 / (8 / 0.36 + 7.2), 1e-12);
  EXPECT_NEAR(solver::stability_bounds(sheet).at_rest, 2 / (8 / 0.36 + 0.8), 1e-12);
  for (const double dt : {0.02, 0.06, 0.067})
    EXPECT_EQ(solver::try_steps(sheet, dt).outcome(), StepOutcome::right) << dt;
  // finite and wrong: what a run must refuse
  for (const double dt : {0.077, 0.08, 0.083, 0.085}) {
    const auto report = solver::try_steps(sheet, dt);
    EXPECT_EQ(report.outcome(), StepOutcome::wrong) << dt;
    EXPECT_GT(report.max_V, 1.1) << dt;
    EXPECT_GT(report.noise, 0.2) << dt;
  }
  for (const double dt : {0.087, 0.09, 0.12})
    EXPECT_EQ(solver::try_steps(sheet, dt).outcome(), StepOutcome::blown_up) << dt;
}

TEST(StabilityMaps, UndeformedMetricsEndAsTheRigidSheet) {
  for (const auto form : {MetricForm::conservative, MetricForm::expanded})
    for (const auto precision : {Precision::float64, Precision::float32}) {
      const auto sheet = sheet_of(form, precision, 10, undeformed);
      EXPECT_EQ(solver::try_steps(sheet, 0.067).outcome(), StepOutcome::right);
      EXPECT_EQ(solver::try_steps(sheet, 0.08).outcome(), StepOutcome::wrong);
      EXPECT_EQ(solver::try_steps(sheet, 0.09).outcome(), StepOutcome::blown_up);
    }
}

struct Deformation {
  const char* name;
  int cells;
  Place (*x)(double, double);
};

void PrintTo(const Deformation& deformation, std::ostream* stream) { *stream << deformation.name; }

const Deformation deformations[] = {
    {"contracted", 10,
     [](double X1, double X2) -> Place {
       return {0.5 * X1, 0.5 * X2};
     }},
    {"stretched", 10,
     [](double X1, double X2) -> Place {
       return {1.5 * X1, 1.5 * X2};
     }},
    {"narrowed", 10,
     [](double X1, double X2) -> Place {
       return {0.4 * X1, X2};
     }},
    {"sheared", 10,
     [](double X1, double X2) -> Place {
       return {X1 + 1.5 * X2, X2};
     }},
    {"bilinear", 60,
     [](double X1, double X2) -> Place {
       return {X1 * (1 - 0.8 * X2 / 36), X2};
     }},
};

class Bound : public ::testing::TestWithParam<Deformation> {};

TEST_P(Bound, HoldsForTheConservativeForm) {
  for (const auto precision : {Precision::float64, Precision::float32}) {
    const auto sheet = sheet_of(MetricForm::conservative, precision, GetParam().cells, GetParam().x);
    const double bound = solver::stability_bounds(sheet).excited;
    for (const double ratio : {0.5, 0.9, 1.0})
      EXPECT_EQ(solver::try_steps(sheet, ratio * bound).outcome(), StepOutcome::right) << ratio;
  }
}

// A less strict bound would gain a run little.
TEST_P(Bound, IsAtMostATenthTooStrict) {
  const auto sheet = sheet_of(MetricForm::conservative, Precision::float64, GetParam().cells, GetParam().x);
  const double bound = solver::stability_bounds(sheet).excited;
  EXPECT_NE(solver::try_steps(sheet, 1.1 * bound).outcome(), StepOutcome::right);
}

INSTANTIATE_TEST_SUITE_P(StabilityMaps, Bound, ::testing::ValuesIn(deformations),
                         [](const auto& test) { return std::string(test.param.name); });

// The checks of a run and the outcomes of the maps are computed independently.
TEST(StabilityMaps, TheChecksOfARunFindWrongStatesAndNoOthers) {
  const auto sheet = sheet_of(MetricForm::none, Precision::float64, 10, undeformed);
  for (const double dt : {0.02, 0.067}) EXPECT_FALSE(solver::try_steps(sheet, dt).told) << dt;
  for (const double dt : {0.072, 0.077, 0.085, 0.09}) EXPECT_TRUE(solver::try_steps(sheet, dt).told) << dt;
}

TEST(StabilityMaps, EveryOutcomeOccursAndNoneIsMissed) {
  std::set<std::size_t> outcomes;
  for (const auto& row : crumpled_map().rows) {
    outcomes.insert(row.outcome);
    EXPECT_TRUE(row.handled);
  }
  EXPECT_EQ(outcomes, (std::set<std::size_t>{0, 1, 2}));
}

TEST(StabilityMaps, TheConservativeFormIsRightUpToTheBound) {
  int admitted = 0;
  for (const auto& row : crumpled_map().rows) {
    if (row.cells[0] != solver::MapCell("conservative")) continue;
    if (number(crumpled_map(), row, "dt") > number(crumpled_map(), row, "bound")) continue;
    EXPECT_EQ(row.outcome, 0u) << number(crumpled_map(), row, "moved");
    ++admitted;
  }
  EXPECT_EQ(admitted, 10);
}

// The bound does not hold for the expanded form where an element is nearly inverted: at a corner J of 0.08
// half of it is unstable. From J = 0.2 on it holds.
TEST(StabilityMaps, TheExpandedFormIsRightUpToTheBoundWhereNoElementIsNearlyInverted) {
  bool broken = false;
  for (const auto& row : crumpled_map().rows) {
    if (row.cells[0] != solver::MapCell("expanded")) continue;
    if (number(crumpled_map(), row, "dt") > number(crumpled_map(), row, "bound")) continue;
    const double moved = number(crumpled_map(), row, "moved");
    if (moved > 0.2)
      broken = broken || row.outcome != 0;
    else
      EXPECT_EQ(row.outcome, 0u) << moved;
  }
  EXPECT_TRUE(broken);
}

}  // namespace
}  // namespace myowave
