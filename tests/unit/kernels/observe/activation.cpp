#include "kernels/observe/activation.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "solver/analysis/rhythm.hpp"
#include "tests/support/fields.hpp"

namespace myowave::observe {
namespace {

using test::ExecutionSpace;
using test::MemorySpace;
using test::Values;

template <class Real>
class Maps {
 public:
  Maps(int rows, int columns, double from) : rows_(rows), columns_(columns), from_(from) {}

  void add_sample(double t, const std::vector<Values>& members) {
    const auto V = test::to_view<Real>(rows_, columns_, members);
    if (fields_.marks.size() == 0) {
      const std::size_t m = members.size(), n = rows_, k = columns_;
      fields_ = {Fields::Marks("myowave::test::marks", m, n, k),
                 Fields::Records("myowave::test::records", m, n, k)};
      begin_activation(ExecutionSpace(), V, fields_);
    } else {
      sample_activation(ExecutionSpace(), V, ActivationInterval{t_, t, from_, {}}, fields_);
    }
    ExecutionSpace().fence();
    t_ = t;
  }

  std::vector<ActivationRecord> records() const {
    const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, fields_.records);
    return {host.data(), host.data() + host.size()};
  }

 private:
  int rows_, columns_;
  double from_, t_ = 0;
  using Fields = ActivationFields<MemorySpace>;
  Fields fields_;
};

ActivationRecord record_of(std::initializer_list<double> V, double from = 0) {
  Maps<double> maps(1, 1, from);
  double t = 0;
  for (const double v : V) maps.add_sample(t++, {{v}});
  return maps.records().front();
}

TEST(Activation, OfAHandCase) {
  const ActivationRecord node = record_of({0, 0.8, 0.05, 0.25, 0.75, 0});
  EXPECT_NEAR(node.first, 0.625, 1e-6);
  EXPECT_NEAR(node.last, 3.5, 1e-6);
  EXPECT_EQ(node.beats, 2);
  EXPECT_EQ(node.periods, 1);
  EXPECT_NEAR(node.mean_period, 2.875, 1e-6);
  EXPECT_EQ(node.apds, 2);
  EXPECT_NEAR(node.total_apd, (1 + 0.7 / 0.75 - 0.625) + (4 + 0.65 / 0.75 - 3.5), 1e-4)
      << "marks of excited nodes are coarser";
}

TEST(Activation, IsArmedBelowItsLevelOnly) {
  EXPECT_EQ(record_of({0, 1, 0.2, 1, 0.3, 1}).beats, 1) << "ripples of one beat";
  EXPECT_EQ(record_of({0, 1, 0.19, 1}).beats, 2);
  EXPECT_EQ(record_of({1, 0, 1}).beats, 1) << "an excited start is no activation";
  EXPECT_EQ(record_of({0.4, 1, 0, 1}).beats, 1);
  EXPECT_EQ(record_of({0.4, 1, 0, 1}).apds, 0) << "nor has it a duration";
}

TEST(Activation, CountsFromATimeOn) {
  const ActivationRecord node = record_of({0, 1, 0, 0, 1, 0, 1, 0}, 1);  // at 0.5, 3.5, 5.5
  EXPECT_EQ(node.beats, 3);
  EXPECT_NEAR(node.first, 0.5, 1e-6);
  EXPECT_EQ(node.periods, 1);
  EXPECT_NEAR(node.mean_period, 2, 1e-6);
  EXPECT_EQ(node.apds, 2);
}

// Sine pulses of node-dependent period and phase against solver::BeatDetector.
template <class Real>
void expect_as_a_plain_detector(int rows, int columns) {
  const auto V_of = [](int m, int i, int j, double t) {
    const double period = 9 + 0.37 * i + 0.11 * j + m, s = std::fmod(t + 0.7 * j + 0.2 * i, period);
    return s < 7 ? static_cast<double>(static_cast<Real>(std::sin(std::numbers::pi * s / 7))) : 0;
  };
  constexpr double every = 0.2;
  Maps<Real> maps(rows, columns, 10);
  std::vector<solver::BeatRecorder> recorders;
  for (int n = 0; n < 2 * rows * columns; ++n) recorders.emplace_back(1, 10);
  for (int n = 0; n < 400; ++n) {
    std::vector<Values> members(2);
    for (int m = 0; m < 2; ++m)
      for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
          const double V = V_of(m, i, j, n * every);
          members[m].push_back(V);
          recorders[(m * rows + i) * columns + j].add(n * every, std::array{V});
        }
    maps.add_sample(n * every, members);
  }
  const auto records = maps.records();
  ASSERT_EQ(records.size(), recorders.size());
  for (std::size_t n = 0; n < records.size(); ++n) {
    recorders[n].finish();
    const auto beats = recorders[n].take();
    ASSERT_EQ(records[n].beats, static_cast<int>(beats.size())) << n;
    EXPECT_NEAR(records[n].first, beats.front().beat.upstroke, 1e-5);
    EXPECT_NEAR(records[n].last, beats.back().beat.upstroke, 1e-5);
    const auto period = recorders[n].period(), apd90 = recorders[n].apd90();
    ASSERT_EQ(records[n].periods, period.n);
    EXPECT_NEAR(records[n].mean_period, period.mean, 1e-5);
    EXPECT_NEAR(std::sqrt(records[n].squared_deviations / (records[n].periods - 1)), period.sd, 1e-5);
    ASSERT_EQ(records[n].apds, apd90.n);
    EXPECT_NEAR(records[n].total_apd / records[n].apds, apd90.mean, 1e-3) << "the peak is sampled too";
  }
}

TEST(Activation, IsThatOfAPlainDetectorAtEachNode) {
  for (const auto& [rows, columns] : {std::pair{1, 1}, {3, 31}, {5, 33}, {7, 67}}) {
    expect_as_a_plain_detector<double>(rows, columns);
    expect_as_a_plain_detector<float>(rows, columns);
  }
}

}  // namespace
}  // namespace myowave::observe
