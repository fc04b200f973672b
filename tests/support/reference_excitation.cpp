#include "tests/support/reference_excitation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace myowave::reference {
namespace {

// Index of the node that stands for k in 0 .. n-1 when a stencil reaches past the boundary.
int mirrored(int k, int n) {
  if (k < 0) return -k;
  if (k > n - 1) return 2 * (n - 1) - k;
  return k;
}

// Where the midpoint of grid cell (i, j) lies in its element, and F there.
Tensor cell_deformation(const Grid& grid, const Mesh& mesh, const Values& x, int i, int j) {
  const int cells = (grid.columns - 1) / mesh.columns;
  const double xi1 = (j % cells + 0.5) / cells, xi2 = (i % cells + 0.5) / cells;
  return deformation_gradient(mesh, x, i / cells, j / cells, xi1, xi2);
}

// C^-1 = (F^T F)^-1 = F^-1 F^-T.
Tensor contravariant_metric(const Tensor& F) {
  const Tensor f = inverse(F);
  Tensor g{};
  for (int M = 0; M < 2; ++M)
    for (int L = 0; L < 2; ++L) g[M][L] = f[M][0] * f[L][0] + f[M][1] * f[L][1];
  return g;
}

// What Eq 24 needs at a node: g^ML and b^N = g^ML Gamma^N_ML.
struct NodeMetric {
  Tensor g{};
  std::array<double, 2> b{};
};

// Mean over the elements that share grid node (i, j).
NodeMetric node_metric(const Grid& grid, const Mesh& mesh, const Values& x, int i, int j) {
  const int cells = (grid.columns - 1) / mesh.columns;
  NodeMetric mean;
  int sharing = 0;
  for (int I = 0; I < mesh.rows; ++I)
    for (int J = 0; J < mesh.columns; ++J) {
      const int row = i - I * cells, column = j - J * cells;
      if (row < 0 || row > cells || column < 0 || column > cells) continue;
      const double xi1 = static_cast<double>(column) / cells, xi2 = static_cast<double>(row) / cells;
      const Tensor F = deformation_gradient(mesh, x, I, J, xi1, xi2), f = inverse(F);
      const Tensor g = contravariant_metric(F);
      const auto x_12 = mixed_derivative(mesh, x, I, J);
      ++sharing;
      for (int N = 0; N < 2; ++N) {
        mean.g[N][0] += g[N][0];
        mean.g[N][1] += g[N][1];
        // Gamma^N_12 = Gamma^N_21 = (F^-1)^N_k x_k,12; the others vanish in a bilinear element.
        mean.b[N] += 2 * g[0][1] * (f[N][0] * x_12[0] + f[N][1] * x_12[1]);
      }
    }
  for (int N = 0; N < 2; ++N) {
    mean.g[N][0] /= sharing;
    mean.g[N][1] /= sharing;
    mean.b[N] /= sharing;
  }
  return mean;
}

// V_,1 and V_,2 at every node: central differences inside; at an edge the derivative along it is
// central and the one across it is what no flux, N_M g^ML V_,L = 0, makes of it.
struct Gradient {
  Values V_1, V_2;
};

Gradient gradient_of(const Grid& grid, const std::vector<NodeMetric>& metric, const Values& V) {
  Gradient result{Values(grid.size()), Values(grid.size())};
  for (int i = 0; i < grid.rows; ++i)
    for (int j = 0; j < grid.columns; ++j) {
      const bool on_left_or_right = j == 0 || j == grid.columns - 1;
      const bool on_bottom_or_top = i == 0 || i == grid.rows - 1;
      const int n = grid.node(i, j);
      const Tensor& g = metric[n].g;
      // Two independent no-flux conditions at a corner leave no gradient.
      if (on_left_or_right && on_bottom_or_top) continue;
      if (!on_left_or_right)
        result.V_1[n] = (V[grid.node(i, j + 1)] - V[grid.node(i, j - 1)]) / (2 * grid.dx);
      if (!on_bottom_or_top)
        result.V_2[n] = (V[grid.node(i + 1, j)] - V[grid.node(i - 1, j)]) / (2 * grid.dx);
      if (on_left_or_right) result.V_1[n] = -g[0][1] / g[0][0] * result.V_2[n];
      if (on_bottom_or_top) result.V_2[n] = -g[0][1] / g[1][1] * result.V_1[n];
    }
  return result;
}

// V(k-1) - 2 V(k) + V(k+1) along one direction, where the neighbour outside the sheet has the value
// that makes the central difference equal to the edge's derivative.
double second_difference(double before, double here, double after, bool first, bool last, double derivative,
                         double dx) {
  if (first) before = after - 2 * dx * derivative;
  if (last) after = before + 2 * dx * derivative;
  return before - 2 * here + after;
}

double mixed_second_derivative(const Grid& grid, const Gradient& gradient, const Values& V, int i, int j) {
  const bool on_left_or_right = j == 0 || j == grid.columns - 1;
  const bool on_bottom_or_top = i == 0 || i == grid.rows - 1;
  if (on_left_or_right && on_bottom_or_top) return 0;
  if (on_left_or_right)
    return (gradient.V_1[grid.node(i + 1, j)] - gradient.V_1[grid.node(i - 1, j)]) / (2 * grid.dx);
  if (on_bottom_or_top)
    return (gradient.V_2[grid.node(i, j + 1)] - gradient.V_2[grid.node(i, j - 1)]) / (2 * grid.dx);
  return (V[grid.node(i + 1, j + 1)] - V[grid.node(i + 1, j - 1)] - V[grid.node(i - 1, j + 1)] +
          V[grid.node(i - 1, j - 1)]) /
         (4 * grid.dx * grid.dx);
}

// Root in the unit square of the two bilinear interpolants of p and q, given at the corners
// (0,0), (1,0), (0,1), (1,1). With winding number +-1 there is exactly one.
std::array<double, 2> common_root(const std::array<double, 4>& p, const std::array<double, 4>& q) {
  // p = p0 + p1 u + (p2 + p3 u) v; eliminating u leaves a v^2 + b v + c = 0.
  const double p0 = p[0], p1 = p[1] - p[0], p2 = p[2] - p[0], p3 = p[3] - p[2] - p[1] + p[0];
  const double q0 = q[0], q1 = q[1] - q[0], q2 = q[2] - q[0], q3 = q[3] - q[2] - q[1] + q[0];
  const double a = q2 * p3 - p2 * q3;
  const double b = q0 * p3 + q2 * p1 - p0 * q3 - p2 * q1;
  const double c = q0 * p1 - p0 * q1;
  // The form without cancellation; one of the two is infinite or NaN where the equation is linear.
  const double s = -0.5 * (b + std::copysign(std::sqrt(std::max(b * b - 4 * a * c, 0.0)), b));

  std::array<double, 2> best{0.5, 0.5};
  double best_distance = std::numeric_limits<double>::infinity();
  for (const double v : {s / a, c / s}) {
    const double p_slope = p1 + p3 * v, q_slope = q1 + q3 * v;
    const double u =
        std::abs(p_slope) > std::abs(q_slope) ? -(p0 + p2 * v) / p_slope : -(q0 + q2 * v) / q_slope;
    // How far outside the square, where rounding puts a root on its edge.
    const double distance = std::max({-u, u - 1, -v, v - 1});
    if (std::isfinite(distance) && distance < best_distance) {
      best_distance = distance;
      best = {u, v};
    }
  }
  return best;
}

}  // namespace

Values diffusion_identity(const Grid& grid, const Values& V) {
  Values result(grid.size());
  for (int i = 0; i < grid.rows; ++i)
    for (int j = 0; j < grid.columns; ++j) {
      const double left = V[grid.node(i, mirrored(j - 1, grid.columns))];
      const double right = V[grid.node(i, mirrored(j + 1, grid.columns))];
      const double below = V[grid.node(mirrored(i - 1, grid.rows), j)];
      const double above = V[grid.node(mirrored(i + 1, grid.rows), j)];
      result[grid.node(i, j)] = (left + right + below + above - 4 * V[grid.node(i, j)]) / (grid.dx * grid.dx);
    }
  return result;
}

Values diffusion_nine_point(const Grid& grid, const Values& V) {
  Values result(grid.size());
  for (int i = 0; i < grid.rows; ++i)
    for (int j = 0; j < grid.columns; ++j) {
      double sum = 0;
      for (int di = -1; di <= 1; ++di)
        for (int dj = -1; dj <= 1; ++dj) {
          const double weight = di == 0 && dj == 0 ? -20 : (di == 0 || dj == 0 ? 4 : 1);
          sum += weight * V[grid.node(mirrored(i + di, grid.rows), mirrored(j + dj, grid.columns))];
        }
      result[grid.node(i, j)] = sum / (6 * grid.dx * grid.dx);
    }
  return result;
}

Values node_weights(const Grid& grid, const Mesh& mesh, const Values& x) {
  Values M(grid.size());
  for (int i = 0; i < grid.rows - 1; ++i)
    for (int j = 0; j < grid.columns - 1; ++j) {
      const double sqrt_C = determinant(cell_deformation(grid, mesh, x, i, j));
      for (const int n : {grid.node(i, j), grid.node(i, j + 1), grid.node(i + 1, j), grid.node(i + 1, j + 1)})
        M[n] += sqrt_C / 4;
    }
  return M;
}

Values diffusion_conservative(const Grid& grid, const Mesh& mesh, const Values& x, const Values& V,
                              double twist) {
  Values dE(grid.size());
  for (int i = 0; i < grid.rows - 1; ++i)
    for (int j = 0; j < grid.columns - 1; ++j) {
      const Tensor F = cell_deformation(grid, mesh, x, i, j);
      const Tensor g = contravariant_metric(F);
      const double sqrt_C = determinant(F);
      const double G11 = sqrt_C * g[0][0], G12 = sqrt_C * g[0][1], G22 = sqrt_C * g[1][1];
      const int n00 = grid.node(i, j), n10 = grid.node(i, j + 1);
      const int n01 = grid.node(i + 1, j), n11 = grid.node(i + 1, j + 1);
      // E = 1/2 {1/2 G11 [lower^2 + upper^2] + 1/2 G22 [left^2 + right^2] + 2 G12 along1 along2}
      const double lower = V[n10] - V[n00], upper = V[n11] - V[n01];
      const double left = V[n01] - V[n00], right = V[n11] - V[n10];
      const double along1 = (lower + upper) / 2, along2 = (left + right) / 2;
      dE[n00] += -G11 * lower / 2 - G22 * left / 2 + G12 * (-along2 - along1) / 2;
      dE[n10] += G11 * lower / 2 - G22 * right / 2 + G12 * (along2 - along1) / 2;
      dE[n01] += -G11 * upper / 2 + G22 * left / 2 + G12 * (-along2 + along1) / 2;
      dE[n11] += G11 * upper / 2 + G22 * right / 2 + G12 * (along2 + along1) / 2;
      const double twisted = twist * (G11 + G22) * (V[n00] + V[n11] - V[n10] - V[n01]);
      dE[n00] -= twisted, dE[n11] -= twisted;
      dE[n10] += twisted, dE[n01] += twisted;
    }
  const Values M = node_weights(grid, mesh, x);
  Values result(grid.size());
  for (int n = 0; n < grid.size(); ++n) result[n] = -dE[n] / (M[n] * grid.dx * grid.dx);
  return result;
}

Values diffusion_expanded(const Grid& grid, const Mesh& mesh, const Values& x, const Values& V) {
  std::vector<NodeMetric> metric;
  for (int i = 0; i < grid.rows; ++i)
    for (int j = 0; j < grid.columns; ++j) metric.push_back(node_metric(grid, mesh, x, i, j));
  const Gradient gradient = gradient_of(grid, metric, V);
  Values result(grid.size());
  for (int i = 0; i < grid.rows; ++i)
    for (int j = 0; j < grid.columns; ++j) {
      const int n = grid.node(i, j);
      const auto [g, b] = metric[n];
      const double V_11 = second_difference(V[grid.node(i, mirrored(j - 1, grid.columns))], V[n],
                                            V[grid.node(i, mirrored(j + 1, grid.columns))], j == 0,
                                            j == grid.columns - 1, gradient.V_1[n], grid.dx) /
                          (grid.dx * grid.dx);
      const double V_22 = second_difference(V[grid.node(mirrored(i - 1, grid.rows), j)], V[n],
                                            V[grid.node(mirrored(i + 1, grid.rows), j)], i == 0,
                                            i == grid.rows - 1, gradient.V_2[n], grid.dx) /
                          (grid.dx * grid.dx);
      const double V_12 = mixed_second_derivative(grid, gradient, V, i, j);
      result[n] = g[0][0] * V_11 + 2 * g[0][1] * V_12 + g[1][1] * V_22 - b[0] * gradient.V_1[n] -
                  b[1] * gradient.V_2[n];
    }
  return result;
}

Values voltage_rate(const solver::ExcitationSettings& p, const Values& V, const Values& r,
                    const Values& diffusion, const Values& I_s) {
  Values rate(V.size());
  for (std::size_t n = 0; n < V.size(); ++n)
    rate[n] = (p.D * diffusion[n] - p.k * V[n] * (V[n] - p.a) * (V[n] - 1) - r[n] * V[n] + I_s[n]) / p.C_m;
  return rate;
}

ExcitationState euler_step(const solver::ExcitationSettings& p, const solver::TensionSettings& settings,
                           double dt, const ExcitationState& old, const Values& diffusion,
                           const Values& I_s) {
  const auto tension = solver::tension_parameters(settings);
  const Values dV_dt = voltage_rate(p, old.V, old.r, diffusion, I_s);
  ExcitationState next = old;
  for (std::size_t n = 0; n < old.V.size(); ++n) {
    const double V = old.V[n], r = old.r[n], Ta = old.Ta[n];
    const double eps_T = V < tension.threshold ? tension.eps_below : tension.eps_above;
    next.V[n] = V + dt * dV_dt[n];
    next.r[n] = r + dt * (p.eps + p.mu1 * r / (p.mu2 + V)) * (-r - p.k * V * (V - p.b - 1));
    next.Ta[n] = Ta + dt * eps_T * (tension.k_Ta * V - Ta);
  }
  return next;
}

ExcitationState split_step(const solver::ExcitationSettings& p, const solver::TensionSettings& settings,
                           double dt, const ExcitationState& old, const Values& diffusion) {
  const auto tension = solver::tension_parameters(settings);
  const auto f = [&](double V, double r) { return (-p.k * V * (V - p.a) * (V - 1) - r * V) / p.C_m; };
  ExcitationState next = old;
  for (std::size_t n = 0; n < old.V.size(); ++n) {
    const double r = old.r[n], Ta = old.Ta[n];
    const double V = old.V[n] + dt * p.D * diffusion[n] / p.C_m;
    const double f_V = (-p.k * (3 * V * V - 2 * (1 + p.a) * V + p.a) - r) / p.C_m;
    const double V_middle = V + dt / 2 * f(V, r) / (1 - dt / 2 * f_V);
    // r_t = A B with A = eps + mu1 r / (mu2 + V), B = -r - k V (V - b - 1);  r_tt = (A_r B + A B_r) r_t
    const double A = p.eps + p.mu1 * r / (p.mu2 + V_middle), A_r = p.mu1 / (p.mu2 + V_middle);
    const double B = -r - p.k * V_middle * (V_middle - p.b - 1);
    next.r[n] = r + dt * A * B + dt * dt / 2 * (A_r * B - A) * A * B;
    next.V[n] = 2 * V_middle - V - dt / 2 * (next.r[n] - r) * V_middle / p.C_m;
    const double eps_T = V_middle < tension.threshold ? tension.eps_below : tension.eps_above;
    const double Ta_t = eps_T * (tension.k_Ta * V_middle - Ta);
    next.Ta[n] = Ta + dt * Ta_t - dt * dt / 2 * eps_T * Ta_t;
  }
  return next;
}

std::vector<PhaseSingularity> phase_singularities(const Grid& grid, const Values& V, const Values& dV_dt) {
  std::vector<PhaseSingularity> found;
  for (int i = 0; i < grid.rows - 1; ++i)
    for (int j = 0; j < grid.columns - 1; ++j) {
      const std::array<int, 4> corners{grid.node(i, j), grid.node(i, j + 1), grid.node(i + 1, j),
                                       grid.node(i + 1, j + 1)};
      std::array<double, 4> p{}, q{};
      for (int c = 0; c < 4; ++c) {
        p[c] = V[corners[c]] - 0.5;
        q[c] = dV_dt[corners[c]];
      }
      double angle = 0;
      bool through_origin = false;
      constexpr std::array<int, 5> counter_clockwise{0, 1, 3, 2, 0};
      for (int e = 0; e < 4; ++e) {
        const int a = counter_clockwise[e], b = counter_clockwise[e + 1];
        const double cross = p[a] * q[b] - q[a] * p[b], dot = p[a] * p[b] + q[a] * q[b];
        if (cross == 0 && dot <= 0) through_origin = true;
        angle += std::atan2(cross, dot);
      }
      const auto winding = static_cast<int>(std::lround(angle / (2 * std::numbers::pi)));
      if (through_origin || winding == 0) continue;
      const auto [u, v] = common_root(p, q);
      found.push_back({(j + u) * grid.dx, (i + v) * grid.dx, winding});
    }
  return found;
}

}  // namespace myowave::reference
