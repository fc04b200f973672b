// What it gains to leave out the parts of a sheet that rest, and what it costs where nothing does:
//   quiescent / plane|point|strip|turbulence / float64|float32 / whole_sheet|tolerance:T
// One iteration runs a rigid sheet from the same state for as long as the wave takes to its far end, a few
// steps a call as between two looks of a run.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bench/sheet.hpp"
#include "bench/suite.hpp"
#include "kernels/tissue/tiled_step.hpp"

namespace myowave::bench {
namespace {

enum class Waves { plane, point, turbulence };

struct Course {
  const char* name;
  Waves waves;
  int rows, columns;
  double duration;  // t.u.
};

constexpr int steps_between_looks = 10;

template <class Real>
using State = tissue::ExcitationFields<EnsembleField<Real, MemorySpace>>;

template <class Real>
State<Real> empty_state(const Course& course) {
  using View = EnsembleField<Real, MemorySpace>;
  return {View("myowave::bench::V", 1, course.rows, course.columns),
          View("myowave::bench::r", 1, course.rows, course.columns),
          View("myowave::bench::Ta", 1, course.rows, course.columns)};
}

template <class Real>
State<Real> start(const Course& course) {
  constexpr double width = 5;  // node spacings
  const auto state = empty_state<Real>(course);
  if (course.waves == Waves::turbulence) {
    const solver::InitialState& turbulent = turbulent_state(course.rows);
    const auto place = [&](const auto& field, const std::vector<double>& values) {
      fill(field, [&](int i, int j) {
        return static_cast<Real>(values[static_cast<std::size_t>(i) * course.columns + j]);
      });
    };
    place(state.V, turbulent.V), place(state.r, turbulent.r), place(state.Ta, turbulent.Ta);
  } else if (course.waves == Waves::point) {
    fill(state.V, [&](int i, int j) {
      return std::hypot(i - course.rows / 2, j - course.columns / 2) <= width ? Real(1) : Real(0);
    });
  } else {
    fill(state.V, [](int, int j) { return j <= width ? Real(1) : Real(0); });
  }
  return state;
}

// Without a tolerance all nodes are taken in all steps.
template <class Real>
void run(const Course& course, std::optional<double> tolerance, State<Real>& state, State<Real>& spare) {
  const tissue::Grid grid{course.rows, course.columns, dx};
  const tissue::IdentityDiffusion<Real, MemorySpace> diffusion(grid);
  tissue::ActiveBox<Real> active(grid, tolerance.value_or(0), solver::TensionSettings{}.k_Ta);
  const auto calls = std::lround(course.duration / dt / steps_between_looks);
  for (long call = 0; call < calls; ++call)
    tissue::tiled_steps(ExecutionSpace(), diffusion, solver::make_model<Real>({}, {}), dt,
                        steps_between_looks, state, spare, 0, {}, tolerance ? &active : nullptr);
}

template <class Real>
void time_course(benchmark::State& state, const Course& course, std::optional<double> tolerance) {
  State<Real> fields, spare;
  for (auto _ : state) {
    state.PauseTiming();
    fields = start<Real>(course), spare = empty_state<Real>(course);
    Kokkos::fence("myowave::bench::before");
    state.ResumeTiming();
    run<Real>(course, tolerance, fields, spare);
    Kokkos::fence("myowave::bench::after");
  }
  state.counters["cell_steps_per_s"] = benchmark::Counter(
      course.duration / dt * course.rows * course.columns * static_cast<double>(state.iterations()),
      benchmark::Counter::kIsRate);
  if (!tolerance) return;

  State<Real> expected = start<Real>(course), expected_spare = empty_state<Real>(course);
  run<Real>(course, std::nullopt, expected, expected_spare);
  const auto found = to_host(fields.V), right = to_host(expected.V);
  double error = 0;
  for (std::size_t k = 0; k < right.size(); ++k)
    error = std::max(error, std::abs(static_cast<double>(found[k]) - static_cast<double>(right[k])));
  state.counters["largest_V_error"] = error;
  const double rounding = 8 * static_cast<double>(std::numeric_limits<Real>::epsilon());
  if (!(error <= (*tolerance > 0 ? *tolerance + rounding : 0)))
    fail(state, fmt::format("V is off by {}", error));
}

template <class Real>
void register_courses(const std::vector<Course>& courses) {
  for (const Course& course : courses)
    for (const std::optional<double> tolerance :
         {std::optional<double>(), std::optional(0.0), std::optional(1e-12)})
      add_row(fmt::format("quiescent/{}/{}/{}", course.name, precision_name<Real>,
                          tolerance ? fmt::format("tolerance:{}", *tolerance) : "whole_sheet"),
              [=](benchmark::State& state) { time_course<Real>(state, course, tolerance); });
}

}  // namespace

void register_quiescent(const Suite& suite) {
  const int n = suite.dry_run ? 121 : 251, strip = suite.dry_run ? 241 : 1001;
  const double crossing = suite.dry_run ? 10 : 100;  // t.u.
  const std::vector<Course> courses{{"plane", Waves::plane, n, n, crossing},
                                    {"point", Waves::point, n, n, 0.6 * crossing},
                                    {"strip", Waves::plane, 101, strip, 4 * crossing},
                                    {"turbulence", Waves::turbulence, n, n, 0.2 * crossing}};
  register_courses<double>(courses);
  register_courses<float>(courses);
}

}  // namespace myowave::bench
