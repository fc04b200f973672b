#include "solver/studies/step_trial.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "kernels/observe/state_check.hpp"
#include "solver/coupling/select_form.hpp"
#include "solver/excitation/select_model.hpp"
#include "solver/excitation/stability.hpp"
#include "solver/excitation/state_check.hpp"
#include "solver/run/make_initial_state.hpp"
#include "solver/run/run.hpp"

namespace myowave::solver {
namespace {

using Space = Kokkos::DefaultExecutionSpace;

constexpr double seed = 1e-6;       // of V
constexpr double first_sample = 5;  // t.u.
constexpr double beyond = 10;       // |V|; sqrt(2 / (k dt)) and more has left every attractor

// No solution of the equations passes V = 1 from below. At half the bound no front has more grid-scale noise
// than 0.03 (the broken front on a sheet sheared by 1.5); past the bound it soon is 0.1 and more.
constexpr double largest_V = 1;
constexpr double largest_noise = 0.05;

template <class Real>
class SteppedSheet {
 public:
  using View = EnsembleField<Real, Space::memory_space>;

  explicit SteppedSheet(const StepTrial& trial)
      : grid_{trial.grid.rows, trial.grid.columns, trial.grid.dx},
        form_(select_form<Space, Real>(trial.form, grid_, elements(trial), trial.cells_per_element,
                                       trial.scheme)) {
    like_.metric = trial.form;
    like_.scheme = trial.scheme;
    bounds_.max_stiffness = undeformed_stiffness(like_);
    if (trial.form != MetricForm::none) like_.mechanics.emplace();
    const Nodes<Space::memory_space> nodes("myowave::solver::trial_nodes", trial.nodes.size() / 2);
    const auto host = Kokkos::create_mirror_view(nodes);
    std::ranges::copy(trial.nodes, host.data());
    Kokkos::deep_copy(nodes, host);
    std::visit(
        [&](const auto& form) {
          if constexpr (requires { form.transfer; })
            bounds_ = form.transfer.refresh(space_, nodes, form.diffusion.metric, 0);
        },
        form_);
  }

  const transfer::DeformationBounds& bounds() const { return bounds_; }

  StepReport run(const InitialState& initial, double dt, double duration) {
    state_ = {field("V", &initial.V), field("r", &initial.r), {}};
    spare_ = {field("V_next", nullptr), field("r_next", nullptr), {}};
    const CleanRange range = clean_range(like_, initial).with_margin(like_);
    StepReport report;
    const int steps_per_sample = std::max(1, static_cast<int>(std::lround(1 / dt)));
    const int samples = static_cast<int>(std::ceil(duration / (steps_per_sample * dt)));
    for (int sample = 1; sample <= samples && !report.blown_up; ++sample) {
      advance(dt, steps_per_sample);
      const auto seen = observe::inspect_state(space_, state_.V, state_.r, state_.Ta);
      report.told = report.told || is_invalid(range, dt);
      report.blown_up = seen.first_non_finite >= 0 || std::max(-seen.min_V, seen.max_V) > beyond;
      if (sample * steps_per_sample * dt < first_sample || report.blown_up) continue;
      report.noise = std::max(report.noise, seen.noise);
      report.min_V = std::min(report.min_V, seen.min_V);
      report.max_V = std::max(report.max_V, seen.max_V);
    }
    return report;
  }

 private:
  static elastic::ElementGrid elements(const StepTrial& trial) {
    const int cells = trial.cells_per_element;
    return {(trial.grid.rows - 1) / cells, (trial.grid.columns - 1) / cells, cells * trial.grid.dx};
  }

  View field(const char* name, const std::vector<double>* values) const {
    const View view(std::string("myowave::solver::trial_") + name, 1, grid_.rows, grid_.columns);
    if (values == nullptr) return view;
    const auto host = Kokkos::create_mirror_view(view);
    std::ranges::transform(*values, host.data(), [](double v) { return static_cast<Real>(v); });
    Kokkos::deep_copy(view, host);
    return view;
  }

  void advance(double dt, int steps) {
    std::visit(
        [&](const auto& form) {
          using Form = std::decay_t<decltype(form)>;
          const auto model = without_tension<typename Form::Scheme>(model_);
          if constexpr (decltype(Form::diffusion)::mirrored_edges) {
            tissue::tiled_steps(space_, form.diffusion, model, dt, steps, state_, spare_);
          } else {
            for (int n = 0; n < steps; ++n) {
              tissue::monodomain_step(space_, form.diffusion, model, dt, state_.V, state_.r, state_.Ta,
                                      spare_.V);
              std::swap(state_.V, spare_.V);
            }
          }
        },
        form_);
  }

  bool is_invalid(const CleanRange& range, double dt) const {
    const auto growing_noise = [&] {
      return std::visit(
          [&](const auto& form) {
            using Rate = tissue::MonodomainRate<std::decay_t<decltype(form.diffusion)>, Model<Real>>;
            const Rate rate{form.diffusion, model_, state_.V, state_.r, {}};
            return observe::growing_noise(space_, state_.V, rate, dt, largest_clean_noise);
          },
          form_);
    };
    return check_state(space_, WatchedState<View>{state_, 0}, range, growing_noise).has_value();
  }

  Space space_;
  tissue::Grid grid_;
  typename ModelForms<Space, Real>::Any form_;
  Scene like_;  // a scene with this diffusion
  Model<Real> model_ = make_model<Real>({}, {});
  transfer::DeformationBounds bounds_{.max_trace_inverse_C = 2, .max_stiffness = 2, .min_J = 1};
  tissue::ExcitationFields<View> state_, spare_;
};

InitialState seeded_front(const StepTrial& trial) {
  Scene scene;
  scene.grid = trial.grid;
  scene.initial.type = InitialSettings::Type::broken_front;
  scene.initial.width = trial.front_width;
  InitialState state = make_initial_state(scene);
  for (int i = 0; i < state.rows; ++i)
    for (int j = 0; j < state.columns; ++j)
      state.V[static_cast<std::size_t>(i) * state.columns + j] += (i + j) % 2 == 0 ? seed : -seed;
  return state;
}

template <class Action>
auto with_precision(const StepTrial& trial, const Action& action) {
  return trial.precision == Precision::float32 ? action(SteppedSheet<float>(trial))
                                               : action(SteppedSheet<double>(trial));
}

}  // namespace

StepOutcome StepReport::outcome() const {
  if (blown_up) return StepOutcome::blown_up;
  return noise > largest_noise || max_V > largest_V ? StepOutcome::wrong : StepOutcome::right;
}

StabilityBounds stability_bounds(const StepTrial& trial) {
  Scene scene;
  scene.grid = trial.grid;
  scene.scheme = trial.scheme;
  const auto bounds = with_precision(trial, [](const auto& sheet) { return sheet.bounds(); });
  const double excited = largest_stable_dt(scene, bounds.max_stiffness);
  const ExcitationSettings& e = scene.excitation;
  const double at_rest = trial.scheme == Scheme::euler
                             ? 2 / (2 / excited - e.k * (1 - e.a) + e.k * e.a)
                             : 2 / (4 * bounds.max_stiffness / (trial.grid.dx * trial.grid.dx));
  return {bounds.max_trace_inverse_C, excited, at_rest};
}

StepReport try_steps(const StepTrial& trial, double dt) {
  return with_precision(trial,
                        [&](auto sheet) { return sheet.run(seeded_front(trial), dt, trial.duration); });
}

}  // namespace myowave::solver
