// Newton's method for a minimum of a potential Pi, globalised by Pi itself.
//
// A direction d solves (K + mu L) d = -R, L the matrix of the integral of grad u : grad v. A step
// length s = 1, 1/2, ... is accepted where the positions are admissible (J > 0 at every corner) and
//
//   Pi(x + s d) <= Pi(x) + 1e-4 s (R . d) + 1e-12 (|Pi(x)| + Pi_0),
//
// the last term being the rounding of Pi, which hides the decrease near the solution; Pi_0, the
// energy of the undeformed sheet, keeps it where Pi passes through zero. mu is 0 until d is no descent
// or no length is accepted; then max(4 mu, 4) kPa. After an accepted step mu/8, and 0 once mu <= 1.
// A line search on the residual diverges on spiral states, where K is often indefinite on the way.
// The direction of an indefinite K is a good one far from the solution (it saves a factorisation in
// five against shifting at once); near it, it would end in a saddle, and K is shifted.
//
// L acts like an isotropic tension mu in the tangent: what it slows down is strain, whatever the
// number of elements. With I in its place the motions of the sheet as a whole, whose share of K
// falls with the number of elements, are held back: 100 x 100 elements do not converge.
//
// Where the solver has the factor of an equilibrium and the forces on it have changed since, the first
// step is taken with that factor: it goes along the path of equilibria. The tangent under the new
// forces is mostly indefinite at the old positions, and the two or three steps that its directions
// take to come near the new equilibrium are saved.
//
// The factorisation has no pivoting. A definite K needs none; the direction of an indefinite one is checked
// (DirectSolver::solve_checked), and where it does not solve its system, K is shifted as after a zero pivot.
//
// Everything here is serial and in a fixed order: the number of threads changes no decision.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "solver/mechanics/linear/direct_solver.hpp"

namespace myowave::solver {

struct NewtonSettings {
  double tolerance = 1e-8;      // of max|R| / residual_unit
  double residual_unit = 1;     // kPa x length
  int max_iterations = 60;      // accepted steps; as many rejected ones
  int max_halvings = 6;         // of one step
  double armijo = 1e-4;         // fraction of the linear decrease that a step must reach
  double energy_noise = 1e-12;  // relative rounding of Pi
  double energy_unit = 0;       // Pi_0, kPa x area
  double near_solution = 1e-3;  // residual from which on an indefinite K is shifted
  double first_shift = 4;       // kPa
  double shift_growth = 4;
  double shift_decay = 8;
  double least_shift = 1;  // kPa; at or below, mu = 0
};

// Time by phase, s.
struct PhaseTimes {
  double assemble = 0, factorize = 0, triangular = 0, energy = 0;
  PhaseTimes& operator+=(const PhaseTimes& other) {
    assemble += other.assemble;
    factorize += other.factorize;
    triangular += other.triangular;
    energy += other.energy;
    return *this;
  }
};

struct NewtonReport {
  bool converged = false;
  std::int64_t iterations = 0;  // accepted steps
  std::int64_t factorizations = 0;
  std::int64_t shifts = 0;  // factorisations of K + mu L
  std::int64_t halvings = 0;
  double largest_shift = 0;  // kPa
  double last_shift = 0;     // kPa, of the last factor
  double residual = std::numeric_limits<double>::infinity();
  double energy = 0;
  double min_J = 0;
  PhaseTimes time;
};

// Energy and smallest corner J at some positions.
struct Evaluation {
  double energy = 0;
  double min_J = 0;
  bool admissible() const { return min_J > 0 && std::isfinite(energy); }
};

// Problem:
//   Evaluation evaluate()                  at the current positions
//   void linearize()                       at the current positions
//   std::span<const double> residual()     there
//   std::span<const double> tangent(mu)    there: the values of K + mu L for the DirectSolver
//   void set_direction(d)
//   Evaluation move(s)                     tries the positions x + s d
//   void accept()                          makes the tried positions the current ones
template <class Problem>
class Newton {
 public:
  Newton(Problem& problem, DirectSolver& solver, const NewtonSettings& settings)
      : problem_(problem), solver_(solver), settings_(settings) {}

  // `start_has_factor`: the solver's last factor is of the tangent at an equilibrium where this starts.
  NewtonReport minimise(bool start_has_factor = false) {
    NewtonReport report;
    Evaluation current = timed(report.time.energy, [&] { return problem_.evaluate(); });
    double shift = 0;
    while (true) {
      report.energy = current.energy;
      report.min_J = current.min_J;
      if (!current.admissible()) return report;
      timed(report.time.assemble, [&] { problem_.linearize(); });
      report.residual = largest_residual() / settings_.residual_unit;
      report.converged = report.residual < settings_.tolerance;
      if (report.converged || report.iterations == settings_.max_iterations) return report;

      if (std::exchange(start_has_factor, false) && find_direction({}, report) && descend(current, report)) {
        ++report.iterations;
        continue;
      }
      while (!step(current, shift, report)) {
        shift = std::max(settings_.shift_growth * shift, settings_.first_shift);
        report.largest_shift = std::max(report.largest_shift, shift);
        if (report.factorizations - report.iterations >= settings_.max_iterations) return report;
      }
      ++report.iterations;
      shift /= settings_.shift_decay;
      if (shift <= settings_.least_shift) shift = 0;
    }
  }

 private:
  // A step with a new factor; true if one was accepted.
  bool step(Evaluation& current, double shift, NewtonReport& report) {
    ++report.factorizations;
    report.last_shift = shift;
    if (shift > 0) ++report.shifts;
    std::span<const double> tangent;
    const Factorization factorization = timed(report.time.factorize, [&] {
      tangent = problem_.tangent(shift);
      return solver_.factorize(tangent);
    });
    if (factorization == Factorization::failed) return false;
    if (factorization == Factorization::indefinite && report.residual < settings_.near_solution) return false;
    return find_direction(tangent, report) && descend(current, report);
  }

  // direction_ = -K^-1 R by the last factor. `tangent` is what it was made from; empty: it is of an earlier
  // tangent. false if the direction does not solve the system.
  bool find_direction(std::span<const double> tangent, NewtonReport& report) {
    const auto residual = problem_.residual();
    direction_.resize(residual.size());
    const bool solved = timed(report.time.triangular, [&] {
      if (!tangent.empty()) return solver_.solve_checked(tangent, residual, direction_);
      solver_.solve(residual, direction_);
      return true;
    });
    for (double& d : direction_) d = -d;
    return solved;
  }

  // The line search along direction_; true if a step was accepted.
  bool descend(Evaluation& current, NewtonReport& report) {
    const auto residual = problem_.residual();
    double slope = 0;
    for (std::size_t a = 0; a < residual.size(); ++a) slope += residual[a] * direction_[a];
    if (!(slope < 0)) return false;
    problem_.set_direction(direction_);
    const double noise = settings_.energy_noise * (std::abs(current.energy) + settings_.energy_unit);
    double length = 1;
    for (int halving = 0; halving <= settings_.max_halvings; ++halving, length /= 2) {
      const Evaluation tried = timed(report.time.energy, [&] { return problem_.move(length); });
      if (tried.admissible() && tried.energy <= current.energy + settings_.armijo * length * slope + noise) {
        problem_.accept();
        current = tried;
        report.halvings += halving;
        return true;
      }
    }
    report.halvings += settings_.max_halvings;
    return false;
  }

  template <class Phase>
  static auto timed(double& seconds, const Phase& phase) {
    using Clock = std::chrono::steady_clock;
    struct Stop {
      double& seconds;
      Clock::time_point start = Clock::now();
      ~Stop() { seconds += std::chrono::duration<double>(Clock::now() - start).count(); }
    } const stop{seconds};
    return phase();
  }

  // Not-a-number wins: it must not pass for a small residual.
  double largest_residual() const {
    double largest = 0;
    for (const double r : problem_.residual()) {
      if (!(std::abs(r) <= largest)) largest = std::abs(r);
      if (std::isnan(r)) return r;
    }
    return largest;
  }

  Problem& problem_;
  DirectSolver& solver_;
  NewtonSettings settings_;
  std::vector<double> direction_;
};

}  // namespace myowave::solver
