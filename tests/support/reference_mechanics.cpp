#include "tests/support/reference_mechanics.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

namespace myowave::reference {
namespace {

using solver::Edges;
using solver::Load;
using solver::MechanicsSettings;

struct Corner {
  int a1, a2;  // 0 or 1 along xi_1, xi_2
};
constexpr std::array<Corner, 4> corners{{{0, 0}, {1, 0}, {0, 1}, {1, 1}}};

double delta(int a, int b) { return a == b ? 1.0 : 0.0; }

Eigen::Matrix2d matrix(const Tensor& a) { return Eigen::Matrix2d{{a[0][0], a[0][1]}, {a[1][0], a[1][1]}}; }
Tensor tensor(const Eigen::Matrix2d& a) { return {{{a(0, 0), a(0, 1)}, {a(1, 0), a(1, 1)}}}; }

// dPsi/dX_1, dPsi/dX_2 of the corner's bilinear function.
Eigen::Vector2d shape_gradient(const Corner& c, double h, double xi1, double xi2) {
  const double f1 = c.a1 == 1 ? xi1 : 1 - xi1, f2 = c.a2 == 1 ? xi2 : 1 - xi2;
  const double slope1 = c.a1 == 1 ? 1 : -1, slope2 = c.a2 == 1 ? 1 : -1;
  return {slope1 * f2 / h, f1 * slope2 / h};
}

double gauss_coordinate(int q) { return 0.5 + (q == 0 ? -0.5 : 0.5) / std::sqrt(3.0); }

// Calls visit(I, J, xi_1, xi_2, index of the Gauss point) at every Gauss point of the sheet.
template <class Visit>
void for_each_gauss_point(const Mesh& mesh, const Visit& visit) {
  for (int I = 0; I < mesh.rows; ++I)
    for (int J = 0; J < mesh.columns; ++J)
      for (int q2 = 0; q2 < 2; ++q2)
        for (int q1 = 0; q1 < 2; ++q1)
          visit(I, J, gauss_coordinate(q1), gauss_coordinate(q2), 4 * (I * mesh.columns + J) + 2 * q2 + q1);
}

double gauss_weight(const Mesh& mesh) { return mesh.h * mesh.h / 4; }

// Edges a -> b of the sheet's boundary, counter-clockwise.
std::vector<std::pair<int, int>> boundary_edges(const Mesh& mesh) {
  std::vector<std::pair<int, int>> edges;
  for (int J = 0; J < mesh.columns; ++J) {
    edges.emplace_back(mesh.node(0, J), mesh.node(0, J + 1));
    edges.emplace_back(mesh.node(mesh.rows, J + 1), mesh.node(mesh.rows, J));
  }
  for (int I = 0; I < mesh.rows; ++I) {
    edges.emplace_back(mesh.node(I, mesh.columns), mesh.node(I + 1, mesh.columns));
    edges.emplace_back(mesh.node(I + 1, 0), mesh.node(I, 0));
  }
  return edges;
}

// C = F^T F and what the membrane's law needs of it.
struct Strain {
  Eigen::Matrix2d C_inverse;
  double t, A, J;
};

Strain strain_of(const Tensor& deformation) {
  const Eigen::Matrix2d F = matrix(deformation), C = F.transpose() * F;
  return {C.inverse(), C.trace(), C.determinant(), F.determinant()};
}

}  // namespace

Values undeformed(const Mesh& mesh) {
  Values x(2 * mesh.nodes());
  for (int I = 0; I <= mesh.rows; ++I)
    for (int J = 0; J <= mesh.columns; ++J) {
      x[2 * mesh.node(I, J)] = J * mesh.h;
      x[2 * mesh.node(I, J) + 1] = I * mesh.h;
    }
  return x;
}

double determinant(const Tensor& a) { return matrix(a).determinant(); }

Tensor inverse(const Tensor& a) { return tensor(matrix(a).inverse()); }

Tensor deformation_gradient(const Mesh& mesh, const Values& x, int I, int J, double xi1, double xi2) {
  Eigen::Matrix2d F = Eigen::Matrix2d::Zero();
  for (const Corner& c : corners) {
    const int n = mesh.node(I + c.a2, J + c.a1);
    F += Eigen::Vector2d(x[2 * n], x[2 * n + 1]) * shape_gradient(c, mesh.h, xi1, xi2).transpose();
  }
  return tensor(F);
}

std::array<double, 2> mixed_derivative(const Mesh& mesh, const Values& x, int I, int J) {
  std::array<double, 2> x_12{};
  for (int i = 0; i < 2; ++i)
    x_12[i] = (x[2 * mesh.node(I, J) + i] - x[2 * mesh.node(I, J + 1) + i] - x[2 * mesh.node(I + 1, J) + i] +
               x[2 * mesh.node(I + 1, J + 1) + i]) /
              (mesh.h * mesh.h);
  return x_12;
}

Values tension_to_gauss(const Mesh& mesh, const Grid& grid, const Values& Ta) {
  Values result(4 * mesh.elements());
  for_each_gauss_point(mesh, [&](int I, int J, double xi1, double xi2, int q) {
    const double column = (J + xi1) * mesh.h / grid.dx, row = (I + xi2) * mesh.h / grid.dx;
    const int j = static_cast<int>(std::floor(column)), i = static_cast<int>(std::floor(row));
    const double u = column - j, v = row - i;
    result[q] = (1 - u) * (1 - v) * Ta[grid.node(i, j)] + u * (1 - v) * Ta[grid.node(i, j + 1)] +
                (1 - u) * v * Ta[grid.node(i + 1, j)] + u * v * Ta[grid.node(i + 1, j + 1)];
  });
  return result;
}

double energy_density(const MechanicsSettings& m, double Ta, const Tensor& F) {
  const Strain e = strain_of(F);
  return m.c1 * (e.t + 1 / e.A) + m.c2 * (e.A + e.t / e.A) + Ta * std::log(e.J);
}

Tensor stress(const MechanicsSettings& m, double Ta, const Tensor& F) {
  const Strain e = strain_of(F);
  const double w_t = m.c1 + m.c2 / e.A;
  const double w_A = -m.c1 / (e.A * e.A) + m.c2 * (1 - e.t / (e.A * e.A));
  return tensor(2 * w_t * Eigen::Matrix2d::Identity() + (2 * e.A * w_A + Ta) * e.C_inverse);
}

std::array<std::array<Tensor, 2>, 2> stiffness(const MechanicsSettings& m, double Ta, const Tensor& F) {
  const Strain e = strain_of(F);
  const Tensor g = tensor(e.C_inverse);
  const double w_A = -m.c1 / (e.A * e.A) + m.c2 * (1 - e.t / (e.A * e.A));
  const double w_tA = -m.c2 / (e.A * e.A);
  const double w_AA = 2 * (m.c1 + m.c2 * e.t) / (e.A * e.A * e.A);
  std::array<std::array<Tensor, 2>, 2> D{};
  for (int M = 0; M < 2; ++M)
    for (int N = 0; N < 2; ++N)
      for (int P = 0; P < 2; ++P)
        for (int Q = 0; Q < 2; ++Q) {
          const double II = (g[M][P] * g[N][Q] + g[M][Q] * g[N][P]) / 2;
          D[M][N][P][Q] = 4 * (e.A * w_tA * (delta(M, N) * g[P][Q] + g[M][N] * delta(P, Q)) +
                               (e.A * e.A * w_AA + e.A * w_A) * g[M][N] * g[P][Q] - e.A * w_A * II) -
                          2 * Ta * II;
        }
  return D;
}

double energy(const Mesh& mesh, const MechanicsSettings& m, const Values& Ta_gauss, const Values& x) {
  double sum = 0;
  for_each_gauss_point(mesh, [&](int I, int J, double xi1, double xi2, int q) {
    sum += gauss_weight(mesh) * energy_density(m, Ta_gauss[q], deformation_gradient(mesh, x, I, J, xi1, xi2));
  });
  // The follower load works on the area that the boundary encloses, the dead load on fixed forces.
  const Values X = undeformed(mesh);
  for (const auto& [a, b] : boundary_edges(mesh)) {
    if (m.load == Load::follower) {
      sum -= m.p * (x[2 * a] * x[2 * b + 1] - x[2 * b] * x[2 * a + 1]) / 2;
    } else {
      const double N1 = X[2 * b + 1] - X[2 * a + 1], N2 = -(X[2 * b] - X[2 * a]);
      sum -= m.p * (N1 * (x[2 * a] + x[2 * b]) / 2 + N2 * (x[2 * a + 1] + x[2 * b + 1]) / 2);
    }
  }
  return sum;
}

Values residual(const Mesh& mesh, const MechanicsSettings& m, const Values& Ta_gauss, const Values& x) {
  Values R(2 * mesh.nodes());
  for_each_gauss_point(mesh, [&](int I, int J, double xi1, double xi2, int q) {
    const Tensor F = deformation_gradient(mesh, x, I, J, xi1, xi2);
    const Eigen::Matrix2d P = matrix(F) * matrix(stress(m, Ta_gauss[q], F));  // first Piola-Kirchhoff
    for (const Corner& c : corners) {
      const Eigen::Vector2d force = gauss_weight(mesh) * P * shape_gradient(c, mesh.h, xi1, xi2);
      for (int j = 0; j < 2; ++j) R[2 * mesh.node(I + c.a2, J + c.a1) + j] += force[j];
    }
  });
  const Values X = undeformed(mesh);
  const Values& loaded = m.load == Load::follower ? x : X;
  for (const auto& [a, b] : boundary_edges(mesh))
    for (const int n : {a, b}) {
      R[2 * n] -= m.p / 2 * (loaded[2 * b + 1] - loaded[2 * a + 1]);
      R[2 * n + 1] += m.p / 2 * (loaded[2 * b] - loaded[2 * a]);
    }
  return R;
}

Values tangent(const Mesh& mesh, const MechanicsSettings& m, const Values& Ta_gauss, const Values& x) {
  const std::size_t size = 2 * mesh.nodes();
  Values K(size * size);
  for_each_gauss_point(mesh, [&](int I, int J, double xi1, double xi2, int q) {
    const Tensor F = deformation_gradient(mesh, x, I, J, xi1, xi2);
    const Tensor S = stress(m, Ta_gauss[q], F);
    const auto D = stiffness(m, Ta_gauss[q], F);
    for (const Corner& cn : corners)
      for (const Corner& cm : corners) {
        const auto gn = shape_gradient(cn, mesh.h, xi1, xi2), gm = shape_gradient(cm, mesh.h, xi1, xi2);
        for (int i = 0; i < 2; ++i)
          for (int j = 0; j < 2; ++j) {
            double sum = 0;
            for (int M = 0; M < 2; ++M)
              for (int N = 0; N < 2; ++N) {
                sum += delta(i, j) * gn[M] * S[M][N] * gm[N];
                // D has the minor symmetries, so that sym() of both factors is already in it.
                for (int P = 0; P < 2; ++P)
                  for (int Q = 0; Q < 2; ++Q) sum += F[i][N] * gn[M] * D[M][N][P][Q] * F[j][P] * gm[Q];
              }
            K[(2 * mesh.node(I + cn.a2, J + cn.a1) + i) * size + 2 * mesh.node(I + cm.a2, J + cm.a1) + j] +=
                gauss_weight(mesh) * sum;
          }
      }
  });
  if (m.load == Load::follower)
    for (const auto& [a, b] : boundary_edges(mesh))
      for (const int n : {a, b}) {
        K[(2 * n) * size + 2 * b + 1] -= m.p / 2;
        K[(2 * n) * size + 2 * a + 1] += m.p / 2;
        K[(2 * n + 1) * size + 2 * b] += m.p / 2;
        K[(2 * n + 1) * size + 2 * a] -= m.p / 2;
      }
  return K;
}

std::vector<bool> held_coordinates(const Mesh& mesh, const MechanicsSettings& m) {
  std::vector<bool> held(2 * mesh.nodes(), false);
  if (m.edges == Edges::fixed) {
    for (const auto& [a, b] : boundary_edges(mesh)) held[2 * a] = held[2 * a + 1] = true;
    return held;
  }
  const int center = mesh.node(mesh.rows / 2, mesh.columns / 2);
  held[2 * center] = held[2 * center + 1] = true;
  held[2 * (center + 1) + 1] = true;
  return held;
}

double smallest_corner_J(const Mesh& mesh, const Values& x) {
  double smallest = determinant(deformation_gradient(mesh, x, 0, 0, 0, 0));
  for (int I = 0; I < mesh.rows; ++I)
    for (int J = 0; J < mesh.columns; ++J)
      for (const Corner& c : corners)
        smallest = std::min(smallest, determinant(deformation_gradient(mesh, x, I, J, c.a1, c.a2)));
  return smallest;
}

Values element_areas(const Mesh& mesh, const Values& x) {
  Values areas;
  for (int I = 0; I < mesh.rows; ++I)
    for (int J = 0; J < mesh.columns; ++J) {
      const std::array<int, 4> loop{mesh.node(I, J), mesh.node(I, J + 1), mesh.node(I + 1, J + 1),
                                    mesh.node(I + 1, J)};
      double area = 0;
      for (int k = 0; k < 4; ++k) {
        const int a = loop[k], b = loop[(k + 1) % 4];
        area += (x[2 * a] * x[2 * b + 1] - x[2 * b] * x[2 * a + 1]) / 2;
      }
      areas.push_back(area);
    }
  return areas;
}

Values solve_equilibrium(const Mesh& mesh, const MechanicsSettings& m, const Values& Ta_gauss, Values x) {
  const std::vector<bool> held = held_coordinates(mesh, m);
  const auto size = static_cast<Eigen::Index>(x.size());
  double mu = 0;
  for (int iteration = 0; iteration < 60; ++iteration) {
    const Values forces = residual(mesh, m, Ta_gauss, x);
    Eigen::VectorXd R = Eigen::VectorXd::Map(forces.data(), size);
    for (Eigen::Index k = 0; k < size; ++k)
      if (held[k]) R[k] = 0;
    if (R.lpNorm<Eigen::Infinity>() / (10 * mesh.h) < m.tolerance) return x;

    const Values full = tangent(mesh, m, Ta_gauss, x);
    Eigen::MatrixXd K = Eigen::MatrixXd::Map(full.data(), size, size);  // symmetric: rows are columns
    for (Eigen::Index k = 0; k < size; ++k)
      if (held[k]) {
        K.row(k).setZero();
        K.col(k).setZero();
        K(k, k) = 1;
      }

    const double Pi = energy(mesh, m, Ta_gauss, x);
    const auto advance = [&] {
      const Eigen::LLT<Eigen::MatrixXd> cholesky(K + mu * Eigen::MatrixXd::Identity(size, size));
      if (cholesky.info() != Eigen::Success) return false;  // not positive definite
      const Eigen::VectorXd d = cholesky.solve(-R);
      const double slope = R.dot(d);
      double s = 1;
      for (int halvings = 0; halvings <= 6; ++halvings, s /= 2) {
        Values trial = x;
        Eigen::VectorXd::Map(trial.data(), size) += s * d;
        if (smallest_corner_J(mesh, trial) > 0 &&
            energy(mesh, m, Ta_gauss, trial) <= Pi + 1e-4 * s * slope + 1e-12 * std::abs(Pi)) {
          x = trial;
          return true;
        }
      }
      return false;
    };
    while (!advance()) {
      mu = std::max(4 * mu, 4.0);
      if (mu > 1e12) throw std::runtime_error("reference mechanics: no step lowers the energy");
    }
    mu = mu / 8 <= 1 ? 0 : mu / 8;
  }
  throw std::runtime_error("reference mechanics: no equilibrium after 60 iterations");
}

double equibiaxial_stretch(const MechanicsSettings& m, double Ta) {
  // s = lambda^2; positive where the sheet pulls harder than the load.
  const auto imbalance = [&](double s) {
    return 2 * (s - 1 / (s * s)) * (m.c1 + m.c2 * s) + Ta -
           m.p * (m.load == Load::follower ? s : std::sqrt(s));
  };
  double low = 0.01, high = 25;
  if (imbalance(low) > 0 || imbalance(high) < 0)
    throw std::runtime_error("reference mechanics: no equibiaxial equilibrium for stretches of 0.1 to 5");
  for (int k = 0; k < 200; ++k) (imbalance((low + high) / 2) < 0 ? low : high) = (low + high) / 2;
  return std::sqrt(low);
}

}  // namespace myowave::reference
