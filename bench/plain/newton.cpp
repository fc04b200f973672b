#include "bench/plain/newton.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "solver/mechanics/equibiaxial.hpp"

namespace myowave::plain {
namespace {

using Clock = std::chrono::steady_clock;

// The globalisation of solver/mechanics/newton.hpp as it was when this yardstick was made.
constexpr double stress_unit = 10;  // kPa
constexpr int max_iterations = 60, max_halvings = 6;
constexpr double armijo = 1e-4, energy_noise = 1e-12, near_solution = 1e-3;
constexpr double first_shift = 4, shift_growth = 4, shift_decay = 8, least_shift = 1;  // kPa
constexpr double first_ramp_part = 1.0 / 4, least_ramp_part = 1.0 / 64;

elastic::Membrane membrane_of(const solver::MechanicsSettings& settings) {
  elastic::Membrane membrane{.passive = settings, .load = {}};
  if (settings.edges == solver::Edges::load)
    (settings.load == solver::Load::follower ? membrane.load.follower : membrane.load.dead) = settings.p;
  return membrane;
}

template <class Body>
auto timed(double& seconds, const Body& body) {
  struct Stop {
    double& seconds;
    Clock::time_point start = Clock::now();
    ~Stop() { seconds += std::chrono::duration<double>(Clock::now() - start).count(); }
  } const stop{seconds};
  return body();
}

void place_uniform(const elastic::ElementGrid& grid, double stretch, std::vector<double>& x) {
  for (int I = 0; I <= grid.rows; ++I)
    for (int J = 0; J <= grid.columns; ++J) {
      x[2 * grid.node(I, J)] = grid.h * (J + (stretch - 1) * (J - grid.columns / 2));
      x[2 * grid.node(I, J) + 1] = grid.h * (I + (stretch - 1) * (I - grid.rows / 2));
    }
}

elastic::ElementNodes element_at(const elastic::ElementGrid& grid, const std::vector<double>& x, int e) {
  return elastic::element_nodes(
      grid, [&](int n, int k) { return x[2 * n + k]; }, e);
}

void load_tension(std::span<const double> Ta, int e, double (&out)[elastic::gauss_points]) {
  std::copy_n(Ta.data() + elastic::gauss_points * e, elastic::gauss_points, out);
}

}  // namespace

bool Newton::Evaluation::admissible() const { return min_J > 0 && std::isfinite(energy); }

Newton::Newton(const elastic::ElementGrid& grid, const solver::MechanicsSettings& settings)
    : mesh_(solver::make_mesh(grid, settings.edges)),
      settings_(settings),
      membrane_(membrane_of(settings)),
      solver_(mesh_.row_begin, mesh_.column, solver::DirectSolver::Method::sparse),
      energy_unit_(elastic::passive_energy(membrane_.passive, 2, 1).w * grid.elements() * grid.h * grid.h),
      nodes_(2 * grid.nodes()),
      current_(nodes_.size()),
      tried_(nodes_.size()),
      last_Ta_(static_cast<std::size_t>(elastic::gauss_points) * grid.elements()),
      element_energy_(grid.elements()),
      element_J_(grid.elements()),
      element_(grid.elements()),
      nodal_residual_(nodes_.size()),
      residual_(mesh_.unknowns),
      direction_(mesh_.unknowns),
      tangent_(mesh_.column.size()),
      shifted_(mesh_.column.size()) {
  place_uniform(grid, 1, nodes_);
}

void Newton::solve(std::span<const double> Ta) {
  ++effort_.solves;
  const auto start_uniform = [&](std::span<const double> tension) {
    const double mean =
        std::accumulate(tension.begin(), tension.end(), 0.0) / static_cast<double>(tension.size());
    place_uniform(mesh_.grid, solver::equibiaxial_stretch(settings_, mean).value_or(1), current_);
  };
  if (solved_)
    current_ = nodes_;
  else
    start_uniform(Ta);
  if (!minimise(Ta)) {
    // Ramps the tension in parts, halved where Newton fails.
    double reached = 0, part = first_ramp_part;
    std::vector<double> start = nodes_, mixed(Ta.size());
    if (!solved_) {
      start_uniform(last_Ta_);
      start = current_;
    }
    while (reached < 1) {
      const double target = std::min(1.0, reached + part);
      for (std::size_t k = 0; k < Ta.size(); ++k) mixed[k] = (1 - target) * last_Ta_[k] + target * Ta[k];
      current_ = start;
      if (minimise(mixed)) {
        reached = target;
        start = current_;
      } else {
        part /= 2;
        if (part < least_ramp_part) throw std::runtime_error("the plain Newton solve found no equilibrium");
      }
    }
  }
  nodes_ = current_;
  std::copy(Ta.begin(), Ta.end(), last_Ta_.begin());
  solved_ = true;
}

bool Newton::minimise(std::span<const double> Ta) {
  Evaluation current = evaluate(Ta, current_);
  double shift = 0;
  for (int iteration = 0, rejected = 0;; ++iteration) {
    if (!current.admissible()) return false;
    assemble(Ta);
    double residual = 0;
    for (const double r : residual_) residual = std::abs(r) <= residual ? residual : std::abs(r);
    residual /= stress_unit * mesh_.grid.h;
    if (residual < settings_.tolerance) return true;
    if (iteration == max_iterations) return false;
    while (!step(Ta, residual, shift, current)) {
      shift = std::max(shift_growth * shift, first_shift);
      if (++rejected >= max_iterations) return false;
    }
    ++effort_.iterations;
    shift /= shift_decay;
    if (shift <= least_shift) shift = 0;
  }
}

bool Newton::step(std::span<const double> Ta, double residual, double shift, Evaluation& current) {
  ++effort_.factorizations;
  const auto factorization = timed(effort_.factorize_s, [&] {
    if (shift == 0) return solver_.factorize(tangent_);
    for (std::size_t s = 0; s < tangent_.size(); ++s)
      shifted_[s] = tangent_[s] + shift * mesh_.gradient_product[s];
    return solver_.factorize(shifted_);
  });
  if (factorization == solver::Factorization::failed) return false;
  if (factorization == solver::Factorization::indefinite && residual < near_solution) return false;
  timed(effort_.solve_s, [&] { solver_.solve(residual_, direction_); });
  const double slope = -std::inner_product(residual_.begin(), residual_.end(), direction_.begin(), 0.0);
  if (!(slope < 0)) return false;
  const double noise = energy_noise * (std::abs(current.energy) + energy_unit_);
  double length = 1;
  for (int halving = 0; halving <= max_halvings; ++halving, length /= 2) {
    for (std::size_t a = 0; a < current_.size(); ++a) {
      const int unknown = mesh_.unknown[a];
      tried_[a] = current_[a] - (unknown >= 0 ? length * direction_[unknown] : 0.0);
    }
    const Evaluation tried = evaluate(Ta, tried_);
    if (!tried.admissible() || tried.energy > current.energy + armijo * length * slope + noise) continue;
    std::swap(current_, tried_);
    current = tried;
    return true;
  }
  return false;
}

Newton::Evaluation Newton::evaluate(std::span<const double> Ta, const std::vector<double>& x) {
  return timed(effort_.energy_s, [&] {
    const auto& grid = mesh_.grid;
#pragma omp parallel for schedule(static)
    for (int e = 0; e < grid.elements(); ++e) {
      const auto element = element_at(grid, x, e);
      double tension[elastic::gauss_points];
      load_tension(Ta, e, tension);
      element_J_[e] = elastic::min_corner_J(element, grid.h);
      element_energy_[e] =
          element_J_[e] > 0 ? elastic::element_energy(membrane_, element, tension, grid.h) : NAN;
    }
    return Evaluation{std::accumulate(element_energy_.begin(), element_energy_.end(), 0.0),
                      *std::min_element(element_J_.begin(), element_J_.end())};
  });
}

void Newton::assemble(std::span<const double> Ta) {
  timed(effort_.assemble_s, [&] {
    const auto& grid = mesh_.grid;
#pragma omp parallel for schedule(static)
    for (int e = 0; e < grid.elements(); ++e) {
      double tension[elastic::gauss_points];
      load_tension(Ta, e, tension);
      element_[e] = elastic::linearize_element(membrane_, element_at(grid, current_, e), tension, grid.h);
    }
    std::fill(nodal_residual_.begin(), nodal_residual_.end(), 0);
    for (int e = 0; e < grid.elements(); ++e)
      for (int a = 0; a < elastic::element_dofs; ++a)
        nodal_residual_[2 * grid.corner(e, a / 2) + a % 2] += element_[e].R[a];
    for (std::size_t a = 0; a < nodal_residual_.size(); ++a)
      if (mesh_.unknown[a] >= 0) residual_[mesh_.unknown[a]] = nodal_residual_[a];
#pragma omp parallel for schedule(static)
    for (std::size_t s = 0; s < tangent_.size(); ++s) {
      double sum = 0;
      for (int k = mesh_.slot_begin[s]; k < mesh_.slot_begin[s + 1]; ++k)
        sum += element_[mesh_.slot_source[k] / elastic::tangent_entries]
                   .K[mesh_.slot_source[k] % elastic::tangent_entries];
      tangent_[s] = sum;
    }
  });
}

}  // namespace myowave::plain
