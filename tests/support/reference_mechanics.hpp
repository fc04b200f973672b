// A plain serial reference of the membrane's equilibrium (Eqs 5-19, 21 with the plane-stress
// closure): loops over indices, Eigen's dense algebra, no Kokkos, nothing shared with kernels/ or solver/.
// Written to be obviously right; meshes of up to a few hundred elements.
//
// Elements are squares of edge h, I along X2, J along X1; node (I, J) lies at X1 = J h, X2 = I h.
// Nodes are x1, x2 of node 0, x1, x2 of node 1, ...; coordinate k of node n is entry 2 n + k.
#pragma once

#include <array>
#include <vector>

#include "solver/scene/scene.hpp"

namespace myowave::reference {

using Values = std::vector<double>;
using Tensor = std::array<std::array<double, 2>, 2>;

// The grid of the fields, row-major: node (i, j) lies at X1 = j dx, X2 = i dx.
struct Grid {
  int rows = 0;
  int columns = 0;
  double dx = 0;

  int size() const { return rows * columns; }
  int node(int i, int j) const { return i * columns + j; }
};

struct Mesh {
  int rows = 0;     // elements along X2
  int columns = 0;  // elements along X1
  double h = 0;

  int elements() const { return rows * columns; }
  int nodes() const { return (rows + 1) * (columns + 1); }
  int node(int I, int J) const { return I * (columns + 1) + J; }
};

Values undeformed(const Mesh&);

double determinant(const Tensor&);
Tensor inverse(const Tensor&);

// F_iM = dx_i/dX_M in element (I, J) at xi_1, xi_2 in [0, 1].
Tensor deformation_gradient(const Mesh&, const Values& x, int I, int J, double xi1, double xi2);

// x_,12: the only second derivative of a bilinear element, constant in it.
std::array<double, 2> mixed_derivative(const Mesh&, const Values& x, int I, int J);

// Bilinear interpolation of a grid field to the Gauss points: entry 4 (I columns + J) + 2 q2 + q1.
Values tension_to_gauss(const Mesh&, const Grid&, const Values& Ta);

// w and its derivatives by C, per undeformed area, of the passive membrane with T33 = 0 and Ta in
// the plane: S_MN and D_MNPQ = dS_MN/dE_PQ.
double energy_density(const solver::MechanicsSettings&, double Ta, const Tensor& F);
Tensor stress(const solver::MechanicsSettings&, double Ta, const Tensor& F);
std::array<std::array<Tensor, 2>, 2> stiffness(const solver::MechanicsSettings&, double Ta, const Tensor& F);

// Pi, R = dPi/dx and K = dR/dx (dense, row-major) of the whole sheet, held coordinates included.
double energy(const Mesh&, const solver::MechanicsSettings&, const Values& Ta_gauss, const Values& x);
Values residual(const Mesh&, const solver::MechanicsSettings&, const Values& Ta_gauss, const Values& x);
Values tangent(const Mesh&, const solver::MechanicsSettings&, const Values& Ta_gauss, const Values& x);

// Coordinates that stay where they are: the three pins, or with fixed edges the whole boundary.
std::vector<bool> held_coordinates(const Mesh&, const solver::MechanicsSettings&);

// Smallest det F at any corner of any element.
double smallest_corner_J(const Mesh&, const Values& x);

// Deformed area of every element.
Values element_areas(const Mesh&, const Values& x);

// Newton from x, globalised by the energy, to settings.tolerance. Throws std::runtime_error.
Values solve_equilibrium(const Mesh&, const solver::MechanicsSettings&, const Values& Ta_gauss, Values x);

// Stretch of the equibiaxial equilibrium under uniform Ta, by bisection.
double equibiaxial_stretch(const solver::MechanicsSettings&, double Ta);

}  // namespace myowave::reference
