// Stress against the energy, tangent against the stress, objectivity, hand cases.
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

// C + 2 e in the component: unit steps of E_11, E_22 and of E_12 = E_21 together.
Sym2 strained(const Sym2& C, int component, double e) {
  return {C.m11 + (component == 0 ? 2 * e : 0), C.m12 + (component == 2 ? 2 * e : 0),
          C.m22 + (component == 1 ? 2 * e : 0)};
}

TEST_P(Stress, IsTheDerivativeOfTheEnergy) {
  const auto& c = GetParam();
  const Sym2 C = right_cauchy_green(c.F);
  const Sym2 S = second_piola_kirchhoff(membrane_energy(c.membrane, c.Ta, C), C);
  const double expected[3] = {S.m11, S.m22, 2 * S.m12};
  const double scale = std::abs(S.m11) + std::abs(S.m22) + std::abs(S.m12);
  for (int k = 0; k < 3; ++k) {
    const double found =
        derivative([&](double e) { return membrane_energy(c.membrane, c.Ta, strained(C, k, e)).w; }, 1e-4);
    EXPECT_NEAR(found, expected[k], 1e-7 * scale) << "component " << k;
  }
}

TEST_P(Stress, TangentIsTheDerivativeOfTheStress) {
  const auto& c = GetParam();
  const Sym2 C = right_cauchy_green(c.F);
  const MaterialTangent D = material_tangent(membrane_energy(c.membrane, c.Ta, C), C);
  const double expected[3][3] = {
      {D.d1111, D.d1122, D.d1112}, {D.d1122, D.d2222, D.d2212}, {D.d1112, D.d2212, D.d1212}};
  double scale = 0;
  for (const auto& row : expected) {
    for (const double d : row) scale = std::max(scale, std::abs(d));
  }
  for (int l = 0; l < 3; ++l) {
    const auto stress = [&](int k, double e) {
      const Sym2 Ce = strained(C, l, e);
      const Sym2 S = second_piola_kirchhoff(membrane_energy(c.membrane, c.Ta, Ce), Ce);
      return k == 0 ? S.m11 : k == 1 ? S.m22 : S.m12;
    };
    // A step of E_12 = E_21 is one of 2 E_12 by two.
    const double factor = l == 2 ? 0.5 : 1;
    for (int k = 0; k < 3; ++k) {
      const double found = factor * derivative([&](double e) { return stress(k, e); }, 1e-4);
      EXPECT_NEAR(found, expected[k][l], 1e-7 * scale) << "entry " << k << ", " << l;
    }
  }
}

TEST_P(Stress, FirstPiolaKirchhoffAndItsTangentAreDerivativesByF) {
  const auto& c = GetParam();
  const auto moved = [&](int k, double e) {
    return Mat2{c.F.m11 + (k == 0 ? e : 0), c.F.m12 + (k == 1 ? e : 0), c.F.m21 + (k == 2 ? e : 0),
                c.F.m22 + (k == 3 ? e : 0)};
  };
  const auto energy = [&](const Mat2& F) {
    return membrane_energy(c.membrane, c.Ta, right_cauchy_green(F)).w -
           c.membrane.load.dead * (F.m11 + F.m22);
  };
  const auto first = [&](const Mat2& F) {
    const Sym2 C = right_cauchy_green(F);
    return first_piola_kirchhoff(c.membrane, F,
                                 second_piola_kirchhoff(membrane_energy(c.membrane, c.Ta, C), C));
  };
  const auto component = [](const Mat2& P, int k) {
    return k == 0 ? P.m11 : k == 1 ? P.m12 : k == 2 ? P.m21 : P.m22;
  };
  const Sym2 C = right_cauchy_green(c.F);
  const auto w = membrane_energy(c.membrane, c.Ta, C);
  const SpatialTangent A = spatial_tangent(c.F, second_piola_kirchhoff(w, C), material_tangent(w, C));
  const Mat2 P = first(c.F);
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(derivative([&](double e) { return energy(moved(k, e)); }, 1e-4), component(P, k), 1e-7 * 100);
    for (int l = 0; l < 4; ++l) {
      EXPECT_NEAR(derivative([&](double e) { return component(first(moved(l, e)), k); }, 1e-4), A.a[k][l],
                  1e-7 * 100)
          << "entry " << k << ", " << l;
      EXPECT_NEAR(A.a[k][l], A.a[l][k], 1e-12 * 100);
    }
  }
}

// A rotation before the deformation changes neither energy nor stress and turns P.
TEST_P(Stress, IsObjective) {
  const auto& c = GetParam();
  const double angle = 0.7, cosine = std::cos(angle), sine = std::sin(angle);
  const Mat2 turned{cosine * c.F.m11 - sine * c.F.m21, cosine * c.F.m12 - sine * c.F.m22,
                    sine * c.F.m11 + cosine * c.F.m21, sine * c.F.m12 + cosine * c.F.m22};
  const Sym2 C = right_cauchy_green(c.F), Ct = right_cauchy_green(turned);
  const auto w = membrane_energy(c.membrane, c.Ta, C), wt = membrane_energy(c.membrane, c.Ta, Ct);
  EXPECT_NEAR(wt.w, w.w, 1e-12 * (1 + std::abs(w.w)));
  const Sym2 S = second_piola_kirchhoff(w, C), St = second_piola_kirchhoff(wt, Ct);
  EXPECT_NEAR(St.m11, S.m11, 1e-11);
  EXPECT_NEAR(St.m12, S.m12, 1e-11);
  EXPECT_NEAR(St.m22, S.m22, 1e-11);
  Membrane no_dead = c.membrane;
  no_dead.load.dead = 0;
  const Mat2 P = first_piola_kirchhoff(no_dead, c.F, S), Pt = first_piola_kirchhoff(no_dead, turned, St);
  EXPECT_NEAR(Pt.m11, cosine * P.m11 - sine * P.m21, 1e-11);
  EXPECT_NEAR(Pt.m12, cosine * P.m12 - sine * P.m22, 1e-11);
  EXPECT_NEAR(Pt.m21, sine * P.m11 + cosine * P.m21, 1e-11);
  EXPECT_NEAR(Pt.m22, sine * P.m12 + cosine * P.m22, 1e-11);
}

const Membrane paper{};
const Membrane follower{.passive = {}, .load = {.follower = 10, .dead = 0}};
const Membrane dead{.passive = {}, .load = {.follower = 0, .dead = 10}};
const Membrane neo_hooke{.passive = {.c1 = 3, .c2 = 0}, .load = {.follower = -7, .dead = 0}};

INSTANTIATE_TEST_SUITE_P(All, Stress,
                         testing::Values(Case{"passive sheared", paper, 0, sheared},
                                         Case{"passive squeezed", paper, 0, squeezed},
                                         Case{"active stretched", paper, 30, stretched},
                                         Case{"follower sheared", follower, 0, sheared},
                                         Case{"follower active squeezed", follower, 47.9, squeezed},
                                         Case{"dead active stretched", dead, 12, stretched},
                                         Case{"c1 alone, compressed", neo_hooke, 5, sheared}));

TEST(MooneyRivlin, UndeformedSheetIsFreeOfStress) {
  const auto w = passive_energy({}, 2, 1);
  EXPECT_DOUBLE_EQ(w.w, 3 * 2 + 3 * 6);
  const Sym2 S = second_piola_kirchhoff(w, {1, 0, 1});
  EXPECT_DOUBLE_EQ(S.m11, 0);
  EXPECT_DOUBLE_EQ(S.m12, 0);
  EXPECT_DOUBLE_EQ(S.m22, 0);
}

// By principal stretches, w = c1 (a^2 + b^2 + 1/(ab)^2) + c2 (a^2 b^2 + 1/a^2 + 1/b^2),
// a S_11 = dw/da and b S_22 = dw/db; here a = 2, b = 1.
TEST(MooneyRivlin, UniaxialStretchByTwo) {
  const auto w = passive_energy({.c1 = 2, .c2 = 6}, 5, 4);
  EXPECT_DOUBLE_EQ(w.w, 2 * 5.25 + 6 * 5.25);
  const Sym2 S = second_piola_kirchhoff(w, {4, 0, 1});
  EXPECT_NEAR(2 * S.m11, 8 * 3.75, 1e-13);
  EXPECT_NEAR(S.m22, 2 * (2 - 0.5) + 6 * (8 - 2), 1e-13);  // dw/db
}

// Linear limit: an incompressible membrane has Young's modulus 6 (c1 + c2) and Poisson's ratio 1/2.
TEST(MooneyRivlin, SmallStrainModuli) {
  const MaterialTangent D = material_tangent(passive_energy({}, 2, 1), {1, 0, 1});
  const double E = 6 * 8, nu = 0.5;
  EXPECT_NEAR(D.d1111, E / (1 - nu * nu), 1e-12);
  EXPECT_NEAR(D.d1122, nu * E / (1 - nu * nu), 1e-12);
  EXPECT_NEAR(D.d1212, E / (2 * (1 + nu)), 1e-12);
  EXPECT_NEAR(D.d1112, 0, 1e-12);
}

TEST(ActiveStress, IsTaTimesTheInverseOfC) {
  const Sym2 C{1.5, 0.2, 0.8};
  EnergyDerivatives w;
  add_active_tension(30, determinant(C), w);
  const Sym2 S = second_piola_kirchhoff(w, C), g = inverse(C);
  EXPECT_NEAR(S.m11, 30 * g.m11, 1e-13);
  EXPECT_NEAR(S.m12, 30 * g.m12, 1e-13);
  EXPECT_NEAR(S.m22, 30 * g.m22, 1e-13);
}

}  // namespace
}  // namespace myowave::elastic
