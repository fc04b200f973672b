// Stress against the energy, tangent against the stress, objectivity, hand cases, the logarithm.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernels/elastic/element.hpp"
#include "tests/support/finite_difference.hpp"

namespace myowave::elastic {
namespace {

using test::derivative;

struct Case {
  const char* name;
  Membrane membrane;
  double Ta;
  Mat2 F;
};
std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

const Mat2 sheared{1.1, 0.35, -0.2, 0.8};
const Mat2 squeezed{0.5, 0.1, 0.2, 0.7};
const Mat2 stretched{1.6, -0.4, 0.3, 1.2};

class Stress : public testing::TestWithParam<Case> {};

// S = F^-1 P, second Piola-Kirchhoff, symmetric; the laws below are written in S.
Mat2 second_piola_kirchhoff(const EnergyDerivatives& w, const Mat2& F) {
  const Mat2 P = first_piola_kirchhoff(w, F);
  const double J = determinant(F);
  return {(F.m22 * P.m11 - F.m12 * P.m21) / J, (F.m22 * P.m12 - F.m12 * P.m22) / J,
          (F.m11 * P.m21 - F.m21 * P.m11) / J, (F.m11 * P.m22 - F.m21 * P.m12) / J};
}

TEST_P(Stress, FirstPiolaKirchhoffAndItsTangentAreDerivativesByF) {
  const auto& c = GetParam();
  const auto moved = [&](int k, double e) {
    return Mat2{c.F.m11 + (k == 0 ? e : 0), c.F.m12 + (k == 1 ? e : 0), c.F.m21 + (k == 2 ? e : 0),
                c.F.m22 + (k == 3 ? e : 0)};
  };
  const auto energy = [&](const Mat2& F) { return membrane_energy(c.membrane, c.Ta, F).w; };
  const auto first = [&](const Mat2& F) {
    return first_piola_kirchhoff(membrane_energy(c.membrane, c.Ta, F), F);
  };
  const auto component = [](const Mat2& P, int k) {
    return k == 0 ? P.m11 : k == 1 ? P.m12 : k == 2 ? P.m21 : P.m22;
  };
  const SpatialTangent A = spatial_tangent(membrane_energy(c.membrane, c.Ta, c.F), c.F);
  const double expected[4][4] = {{A.a1111, A.a1112, A.a1121, A.a1122},
                                 {A.a1112, A.a1212, A.a1221, A.a1222},
                                 {A.a1121, A.a1221, A.a2121, A.a2122},
                                 {A.a1122, A.a1222, A.a2122, A.a2222}};
  const Mat2 P = first(c.F);
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(derivative([&](double e) { return energy(moved(k, e)); }, 1e-4), component(P, k), 1e-7 * 100);
    for (int l = 0; l < 4; ++l) {
      EXPECT_NEAR(derivative([&](double e) { return component(first(moved(l, e)), k); }, 1e-4),
                  expected[k][l], 1e-7 * 100)
          << "entry " << k << ", " << l;
    }
  }
}

// A rotation before the deformation changes neither energy nor stress and turns P.
TEST_P(Stress, IsObjective) {
  const auto& c = GetParam();
  const double angle = 0.7, cosine = std::cos(angle), sine = std::sin(angle);
  const Mat2 turned{cosine * c.F.m11 - sine * c.F.m21, cosine * c.F.m12 - sine * c.F.m22,
                    sine * c.F.m11 + cosine * c.F.m21, sine * c.F.m12 + cosine * c.F.m22};
  const auto w = membrane_energy(c.membrane, c.Ta, c.F), wt = membrane_energy(c.membrane, c.Ta, turned);
  EXPECT_NEAR(wt.w, w.w, 1e-12 * (1 + std::abs(w.w)));
  const Mat2 S = second_piola_kirchhoff(w, c.F), St = second_piola_kirchhoff(wt, turned);
  EXPECT_NEAR(S.m12, S.m21, 1e-11);
  EXPECT_NEAR(St.m11, S.m11, 1e-11);
  EXPECT_NEAR(St.m12, S.m12, 1e-11);
  EXPECT_NEAR(St.m22, S.m22, 1e-11);
  const Mat2 P = first_piola_kirchhoff(w, c.F), Pt = first_piola_kirchhoff(wt, turned);
  EXPECT_NEAR(Pt.m11, cosine * P.m11 - sine * P.m21, 1e-11);
  EXPECT_NEAR(Pt.m12, cosine * P.m12 - sine * P.m22, 1e-11);
  EXPECT_NEAR(Pt.m21, sine * P.m11 + cosine * P.m21, 1e-11);
  EXPECT_NEAR(Pt.m22, sine * P.m12 + cosine * P.m22, 1e-11);
}

const Membrane paper{};
const Membrane follower{.passive = {}, .load = {.follower = 10, .dead = 0}};
const Membrane neo_hooke{.passive = {.c1 = 3, .c2 = 0}, .load = {.follower = -7, .dead = 0}};

INSTANTIATE_TEST_SUITE_P(All, Stress,
                         testing::Values(Case{"passive sheared", paper, 0, sheared},
                                         Case{"passive squeezed", paper, 0, squeezed},
                                         Case{"active stretched", paper, 30, stretched},
                                         Case{"follower sheared", follower, 0, sheared},
                                         Case{"follower active squeezed", follower, 47.9, squeezed},
                                         Case{"active stretched a little", paper, 12, stretched},
                                         Case{"c1 alone, compressed", neo_hooke, 5, sheared}));

TEST(MooneyRivlin, UndeformedSheetIsFreeOfStress) {
  const auto w = passive_energy({}, 2, 1);
  EXPECT_DOUBLE_EQ(w.w, 3 * 2 + 3 * 6);
  const Mat2 P = first_piola_kirchhoff(w, {1, 0, 0, 1});
  EXPECT_DOUBLE_EQ(P.m11, 0);
  EXPECT_DOUBLE_EQ(P.m12, 0);
  EXPECT_DOUBLE_EQ(P.m22, 0);
}

// By principal stretches, w = c1 (a^2 + b^2 + 1/(ab)^2) + c2 (a^2 b^2 + 1/a^2 + 1/b^2),
// P_11 = dw/da and P_22 = dw/db; here a = 2, b = 1.
TEST(MooneyRivlin, UniaxialStretchByTwo) {
  const auto w = passive_energy({.c1 = 2, .c2 = 6}, 5, 4);
  EXPECT_DOUBLE_EQ(w.w, 2 * 5.25 + 6 * 5.25);
  const Mat2 P = first_piola_kirchhoff(w, {2, 0, 0, 1});
  EXPECT_NEAR(P.m11, 8 * 3.75, 1e-13);
  EXPECT_NEAR(P.m22, 2 * (2 - 0.5) + 6 * (8 - 2), 1e-13);
}

// Linear limit: an incompressible membrane has Young's modulus 6 (c1 + c2) and Poisson's ratio 1/2.
TEST(MooneyRivlin, SmallStrainModuli) {
  const SpatialTangent A = spatial_tangent(passive_energy({}, 2, 1), {1, 0, 0, 1});
  const double E = 6 * 8, nu = 0.5;
  EXPECT_NEAR(A.a1111, E / (1 - nu * nu), 1e-12);
  EXPECT_NEAR(A.a1122, nu * E / (1 - nu * nu), 1e-12);
  EXPECT_NEAR(A.a1212, E / (2 * (1 + nu)), 1e-12);
  EXPECT_NEAR(A.a1221, A.a1212, 1e-12);
  EXPECT_NEAR(A.a1112, 0, 1e-12);
}

TEST(ActiveStress, IsTaTimesTheInverseOfC) {
  const Mat2 F{1.2, 0.3, -0.1, 0.8};
  EnergyDerivatives w;
  add_active_tension(30, determinant(F) * determinant(F), w);
  const Mat2 S = second_piola_kirchhoff(w, F);
  const Sym2 g = inverse(right_cauchy_green(F));
  EXPECT_NEAR(S.m11, 30 * g.m11, 1e-13);
  EXPECT_NEAR(S.m12, 30 * g.m12, 1e-13);
  EXPECT_NEAR(S.m22, 30 * g.m22, 1e-13);
}

// Near 1, where the logarithm is small; at the ends of the mantissa; and over the range of numbers.
TEST(NaturalLogarithm, IsTheLibrarysToItsRounding) {
  for (const double x : {1.0, 1 + 1e-15, 1 - 1e-15, 0.9, 1.1, std::sqrt(0.5), std::sqrt(2.0), 0.70710678,
                         1.4142136, 2.0, 0.5, 3.7, 1e-3, 1e-300, 1e300}) {
    EXPECT_NEAR(natural_logarithm(x), std::log(x), 4e-16 * std::abs(std::log(x))) << x;
  }
}

}  // namespace
}  // namespace myowave::elastic
