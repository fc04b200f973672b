#include "kernels/observe/phase_singularity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

#include "tests/support/fields.hpp"
#include "tests/support/reference_excitation.hpp"

namespace myowave::observe {
namespace {

using test::ExecutionSpace;
using test::MemorySpace;
using test::Values;

constexpr double dx = 0.6;

// dV/dt given as a field.
template <class Real>
struct FieldRate {
  EnsembleField<Real, MemorySpace> values;
  KOKKOS_FUNCTION Real operator()(int m, int i, int j) const { return values(m, i, j); }
};

struct Found {
  int count;
  double largest_V;
  std::vector<PhaseSingularity> tips;  // in row-major order, member by member
};

template <class Real>
Found find(int rows, int columns, const std::vector<Values>& V, const std::vector<Values>& rate,
           std::size_t room = 4096) {
  const Kokkos::View<int, MemorySpace> count("count");
  const Kokkos::View<PhaseSingularity*, MemorySpace> list("tips", room);
  const FieldRate<Real> field{test::to_view<Real>(rows, columns, rate)};
  Found found{};
  found.largest_V = find_phase_singularities(ExecutionSpace(), {rows, columns, dx},
                                             test::to_view<Real>(rows, columns, V), field, count, list);
  Kokkos::deep_copy(found.count, count);
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, list);
  found.tips.assign(host.data(), host.data() + std::min<std::size_t>(found.count, room));
  std::sort(found.tips.begin(), found.tips.end(), [](const auto& a, const auto& b) {
    return std::array{a.member, a.row, a.column} < std::array{b.member, b.row, b.column};
  });
  return found;
}

// (V - 0.5, dV/dt) = f(X1, X2)
using Phase = std::function<std::complex<double>(double, double)>;

struct Fields {
  Values V, rate;
};

Fields sampled(int rows, int columns, const Phase& f) {
  Fields fields;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const auto z = f(j * dx, i * dx);
      fields.V.push_back(0.5 + z.real());
      fields.rate.push_back(z.imag());
    }
  return fields;
}

Values as_float(Values values) {
  for (double& v : values) v = static_cast<float>(v);
  return values;
}

template <class Real>
void expect_reference(int rows, int columns, const Values& V, const Values& rate, std::size_t at_least) {
  const auto found = find<Real>(rows, columns, {V}, {rate});
  const auto expected = reference::phase_singularities({rows, columns, dx}, V, rate);
  ASSERT_EQ(found.tips.size(), expected.size());
  EXPECT_GE(expected.size(), at_least);
  for (std::size_t n = 0; n < expected.size(); ++n) {
    const auto& tip = found.tips[n];
    EXPECT_EQ(tip.column, static_cast<int>(expected[n].x / dx));
    EXPECT_EQ(tip.row, static_cast<int>(expected[n].y / dx));
    EXPECT_NEAR(tip.x, expected[n].x, 1e-10);
    EXPECT_NEAR(tip.y, expected[n].y, 1e-10);
    EXPECT_EQ(tip.charge, expected[n].charge);
    EXPECT_EQ(tip.member, 0);
  }
  EXPECT_EQ(found.largest_V, *std::max_element(V.begin(), V.end()));
}

TEST(WindingNumber, HandCases) {
  // Round the origin once, through all quadrants, either way.
  EXPECT_EQ(winding_number({{-1, 1, 1, -1}}, {{-1, -1, 1, 1}}), 1);
  EXPECT_EQ(winding_number({{-1, -1, 1, 1}}, {{-1, 1, 1, -1}}), -1);
  // There and back: a plane wave's square.
  EXPECT_EQ(winding_number({{-1, 1, 1, -1}}, {{1, 1, 1, 1}}), 0);
  EXPECT_EQ(winding_number({{-1, 1, 1, -1}}, {{-1, -1, -1, -1}}), 0);
  EXPECT_EQ(winding_number({{-1, 1, -1, 1}}, {{1, 2, 1, 2}}), 0);
  // A slanted edge passes the origin on its left or on its right.
  EXPECT_EQ(winding_number({{-1, 1, 1, 0.5}}, {{-1, -1, 1, 0.4}}), 0);
  EXPECT_EQ(winding_number({{-1, 1, 1, 0.5}}, {{-1, -1, 1, 0.6}}), 1);
  EXPECT_EQ(winding_number({{-1, 1, -0.4, -2}}, {{-1, -1, 2, -0.9}}), 1);
  EXPECT_EQ(winding_number({{-1, 1, 1, 1}}, {{-1, -1, 1, 0}}), 0);
  // A corner on the line u = 0 belongs to u > 0.
  EXPECT_EQ(winding_number({{0, 1, 0, -1}}, {{-1, 0, 1, 0}}), 1);
  EXPECT_EQ(winding_number({{0, -1, 0, 1}}, {{-1, 0, 1, 0}}), -1);
  EXPECT_EQ(winding_number({{0, 0, 0, 0}}, {{0, 0, 0, 0}}), 0);
}

TEST(WindingNumber, ChangesSignWithTheDirection) {
  const Values random = test::random_field(8 * 1000, -1, 1, 3);
  int turns = 0;
  for (int n = 0; n < 1000; ++n) {
    const double* z = &random[8 * n];
    const Corners u{{z[0], z[1], z[2], z[3]}}, v{{z[4], z[5], z[6], z[7]}};
    const Corners u_back{{z[3], z[2], z[1], z[0]}}, v_back{{z[7], z[6], z[5], z[4]}};
    EXPECT_EQ(winding_number(u, v), -winding_number(u_back, v_back));
    EXPECT_EQ(winding_number(u, v), -winding_number(v, u)) << "mirrored";
    turns += std::abs(winding_number(u, v));
  }
  EXPECT_GT(turns, 100);
}

TEST(BilinearRoot, OfLinearFunctions) {
  // u = s - 1/4, v = t - 3/4, and turned by 45 degrees
  const auto straight = bilinear_root({{-0.25, 0.75, 0.75, -0.25}}, {{-0.75, -0.75, 0.25, 0.25}});
  EXPECT_DOUBLE_EQ(straight.first, 0.25);
  EXPECT_DOUBLE_EQ(straight.second, 0.75);
  const auto turned = bilinear_root({{-1, 0, 1, 0}}, {{0.5, -0.5, 0.5, 1.5}});
  EXPECT_DOUBLE_EQ(turned.first, 0.75);
  EXPECT_DOUBLE_EQ(turned.second, 0.25);
}

TEST(BilinearRoot, OfBilinearFunctions) {
  // u = (s - 0.3)(1 + t), v = (t - 0.6)(2 - s)
  const auto u = [](double s, double t) { return (s - 0.3) * (1 + t); };
  const auto v = [](double s, double t) { return (t - 0.6) * (2 - s); };
  const auto root =
      bilinear_root({{u(0, 0), u(1, 0), u(1, 1), u(0, 1)}}, {{v(0, 0), v(1, 0), v(1, 1), v(0, 1)}});
  EXPECT_NEAR(root.first, 0.3, 1e-15);
  EXPECT_NEAR(root.second, 0.6, 1e-15);
}

TEST(BilinearRoot, LiesInTheSquareAndSolvesBoth) {
  const Values random = test::random_field(8 * 4000, -1, 1, 4);
  int roots = 0;
  for (int n = 0; n < 4000; ++n) {
    const double* z = &random[8 * n];
    const Corners u{{z[0], z[1], z[2], z[3]}}, v{{z[4], z[5], z[6], z[7]}};
    if (winding_number(u, v) == 0) continue;
    ++roots;
    const auto [column, row] = bilinear_root(u, v);
    const auto interpolated = [s = column, t = row](const Corners& c) {
      return (1 - t) * ((1 - s) * c.value[0] + s * c.value[1]) + t * (s * c.value[2] + (1 - s) * c.value[3]);
    };
    EXPECT_TRUE(0 <= column && column <= 1 && 0 <= row && row <= 1);
    EXPECT_NEAR(interpolated(u), 0, 1e-12);
    EXPECT_NEAR(interpolated(v), 0, 1e-12);
  }
  EXPECT_GT(roots, 400);
}

TEST(PhaseSingularity, OfARotatingWaveHasItsPlaceAndCharge) {
  const std::complex<double> center{7.31, 5.02};
  for (const int charge : {1, -1})
    for (const double phase : {0.0, 0.4, 1.6, 2.9, 4.5}) {
      const Fields f = sampled(21, 27, [&](double X1, double X2) {
        const auto z = std::complex<double>{X1, X2} - center;
        return 0.1 * std::polar(1.0, phase) * (charge > 0 ? z : std::conj(z));
      });
      for (const auto& found :
           {find<double>(21, 27, {f.V}, {f.rate}), find<float>(21, 27, {f.V}, {f.rate})}) {
        ASSERT_EQ(found.count, 1);
        EXPECT_EQ(found.tips[0].charge, charge);
        EXPECT_NEAR(found.tips[0].x, center.real(), 1e-5);  // the float's
        EXPECT_NEAR(found.tips[0].y, center.imag(), 1e-5);
      }
      EXPECT_NEAR(find<double>(21, 27, {f.V}, {f.rate}).tips[0].x, center.real(), 1e-12);
    }
}

TEST(PhaseSingularity, OppositePairIsFoundAsTwo) {
  const std::complex<double> plus{4.1, 6.2}, minus{11.3, 6.5};
  const Fields f = sampled(23, 29, [&](double X1, double X2) {
    const std::complex<double> z{X1, X2};
    return (z - plus) * std::conj(z - minus);
  });
  const auto found = find<double>(23, 29, {f.V}, {f.rate});
  ASSERT_EQ(found.count, 2);
  EXPECT_EQ(found.tips[0].charge, 1);
  EXPECT_EQ(found.tips[1].charge, -1);
  EXPECT_NEAR(found.tips[0].x, plus.real(), 0.05);
  EXPECT_NEAR(found.tips[1].x, minus.real(), 0.05);
}

TEST(PhaseSingularity, PlaneWaveHasNone) {
  for (const double angle : {0.0, 0.3, std::numbers::pi / 4, std::numbers::pi / 2}) {
    const Fields f = sampled(37, 67, [&](double X1, double X2) {
      return 0.5 * std::polar(1.0, 0.7 * (std::cos(angle) * X1 + std::sin(angle) * X2));
    });
    EXPECT_EQ(find<double>(37, 67, {f.V}, {f.rate}).count, 0);
    EXPECT_EQ(find<float>(37, 67, {f.V}, {f.rate}).count, 0);
  }
  const Values rest(37 * 67);
  EXPECT_EQ(find<double>(37, 67, {rest}, {rest}).count, 0);
}

// A tip in every place where a search in blocks could miss it.
TEST(PhaseSingularity, AtTheEdgesOfTheSheetAndOfABlock) {
  constexpr int rows = 5, columns = 2 * block_columns + 2;
  for (const int row : {0, 1, rows - 2})
    for (const int column : {0, block_columns - 1, block_columns, 2 * block_columns - 1, 2 * block_columns}) {
      const std::complex<double> center{dx * (column + 0.4), dx * (row + 0.7)};
      const Fields f = sampled(rows, columns, [&](double X1, double X2) {
        return std::complex<double>{X1, X2} - center;
      });
      const auto found = find<double>(rows, columns, {f.V}, {f.rate});
      ASSERT_EQ(found.count, 1) << row << ' ' << column;
      EXPECT_EQ(found.tips[0].row, row);
      EXPECT_EQ(found.tips[0].column, column);
      EXPECT_NEAR(found.tips[0].x, center.real(), 1e-12);
      EXPECT_NEAR(found.tips[0].y, center.imag(), 1e-12);
    }
}

TEST(PhaseSingularity, TurbulentFieldsAreTheReferences) {
  for (const auto& [rows, columns] : {std::pair{61, 67}, {40, 129}, {2, 33}, {97, 2}})
    for (unsigned seed = 0; seed < 8; ++seed) {
      Values V = test::smooth_random_field(rows, columns, 2 * seed);
      for (double& v : V) v += 0.5;
      const Values rate = test::smooth_random_field(rows, columns, 2 * seed + 1);
      const std::size_t at_least = rows > 2 && columns > 2 ? 10 : 0;
      expect_reference<double>(rows, columns, V, rate, at_least);
      expect_reference<float>(rows, columns, as_float(V), as_float(rate), at_least);
    }
}

TEST(PhaseSingularity, NoiseIsTheReferences) {
  const Values V = test::random_field(50 * 70, 0, 1, 5), rate = test::random_field(50 * 70, -1, 1, 6);
  expect_reference<double>(50, 70, V, rate, 300);
}

TEST(PhaseSingularity, MembersAreSeparate) {
  Values V[2], rate[2];
  for (unsigned m = 0; m < 2; ++m) {
    V[m] = test::smooth_random_field(31, 45, 70 + m);
    for (double& v : V[m]) v += 0.5;
    rate[m] = test::smooth_random_field(31, 45, 80 + m);
  }
  const auto both = find<double>(31, 45, {V[0], V[1]}, {rate[0], rate[1]});
  std::size_t n = 0;
  for (int m = 0; m < 2; ++m) {
    const auto alone = find<double>(31, 45, {V[m]}, {rate[m]});
    ASSERT_GT(alone.count, 0);
    for (const auto& tip : alone.tips) {
      ASSERT_LT(n, both.tips.size());
      EXPECT_EQ(both.tips[n].member, m);
      EXPECT_EQ(both.tips[n].x, tip.x);
      EXPECT_EQ(both.tips[n].y, tip.y);
      ++n;
    }
  }
  EXPECT_EQ(n, both.tips.size());
}

TEST(PhaseSingularity, TipsBeyondTheCapacityAreCounted) {
  const Values V = test::random_field(50 * 70, 0, 1, 5), rate = test::random_field(50 * 70, -1, 1, 6);
  const auto all = find<double>(50, 70, {V}, {rate}), few = find<double>(50, 70, {V}, {rate}, 3);
  EXPECT_EQ(few.count, all.count);
  ASSERT_EQ(few.tips.size(), 3U);
  for (const auto& tip : few.tips)
    EXPECT_TRUE(std::any_of(all.tips.begin(), all.tips.end(),
                            [&](const auto& other) { return other.x == tip.x && other.y == tip.y; }));
  EXPECT_EQ(find<double>(50, 70, {V}, {rate}, 0).count, all.count);
}

TEST(PhaseSingularity, LargestVIsSeenInTheLastRowAndColumn) {
  for (const auto& [i, j] : {std::pair{0, 0}, {6, 65}, {6, 3}, {2, 65}, {3, 32}}) {
    Values V(7 * 66, -0.2);
    V[66 * i + j] = 0.3;
    EXPECT_EQ(find<double>(7, 66, {V}, {Values(7 * 66)}).largest_V, 0.3) << i << ' ' << j;
  }
}

}  // namespace
}  // namespace myowave::observe
