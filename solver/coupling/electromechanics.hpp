// The coupled state of one sheet and its advance: explicit steps of the excitation between solves of
// the mechanics.
#pragma once

#include <Kokkos_Core.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kernels/observe/activation.hpp"
#include "kernels/observe/phase_singularity.hpp"
#include "solver/base/archive.hpp"
#include "solver/base/area_sample.hpp"
#include "solver/base/execution.hpp"
#include "solver/base/run_output.hpp"
#include "solver/coupling/node_history.hpp"
#include "solver/coupling/select_form.hpp"
#include "solver/excitation/select_model.hpp"
#include "solver/excitation/stability.hpp"
#include "solver/excitation/stimulus_schedule.hpp"
#include "solver/mechanics/equilibrium.hpp"

namespace myowave::solver {

// Initial capacity of the list of tips: turbulence has tens, raw step data hundreds.
inline constexpr std::size_t first_tips = 256;

// A View and its copy on the host, allocated together, so that a sample allocates nothing. Both are the same
// memory if the host can access the View.
template <class View>
struct DeviceAndHost {
  View device;
  typename View::host_mirror_type host;

  DeviceAndHost() = default;
  template <class... Extents>
  explicit DeviceAndHost(const std::string& label, Extents... extents)
      : device(label, extents...), host(Kokkos::create_mirror_view(device)) {}
};

template <class ExecutionSpace, class Real>
class Electromechanics {
 public:
  using Host = HostOf<ExecutionSpace>;
  using Space = typename ExecutionSpace::memory_space;
  using View = EnsembleField<Real, Space>;

  // Solves the loaded rest state (Ta = 0), the reference of all areas, if there is mechanics.
  // Errors: NumericalFailure.
  Electromechanics(const ExecutionOn<ExecutionSpace>&, const Scene&, const InitialState&, PhaseSeconds&,
                   MechanicsStatistics&);

  Electromechanics(const Electromechanics&) = delete;
  Electromechanics& operator=(const Electromechanics&) = delete;

  // Steps between solves; 0 in a rigid sheet.
  int mechanics_interval() const;

  // Solves the equilibrium with the present tension, if that has changed, then refreshes the metric for the
  // interval from t on and area(). Errors: NumericalFailure, also if the new metric makes dt unstable and the
  // scene takes no substeps.
  void solve_mechanics(double t);

  // `count` explicit steps from step `first`, each divided into `substeps`; t = step dt. Appends V at the
  // probes before each step.
  void advance(std::int64_t first, std::int64_t count, int substeps = 1);

  // The bound of dt for the present metric.
  double stable_dt() const { return stable_dt_; }

  // Saves the present state for go_back(). Only if the scene takes substeps; else no memory is allocated for
  // it.
  void keep();
  void go_back();

  // Describes the first problem found in the state, with time, node and values: V, r or Ta is not finite, V
  // or r is out of range, or V alternates at the grid's scale and keeps doing so in the next step. Empty for
  // a valid state. dt: of the last steps; 0 before the first.
  std::optional<std::string> check_state(double t, double dt);

  // kPa, of the Gauss points at the last solve.
  double largest_tension() const;

  struct Activity {
    std::vector<Tip> tips;  // row-major order of their squares
    double largest_V = 0;
  };
  Activity find_tips(double t);

  // V at the probes of the scene, before each step of the last advance().
  std::span<const double> probe_history() const { return probe_history_; }
  // V, r, Ta of each probe now.
  std::vector<double> probe_values() const;

  // Adds the crossings of V since the last sample to the maps; the first sample starts them. Only if the
  // scene has maps.
  void sample_activation(double t);
  // Without the conduction velocity.
  ActivationMaps activation_maps() const;

  const AreaSample& area() const { return area_; }  // of the last solve
  // Of each element, relative to the loaded rest state.
  std::vector<double> element_area_ratios() const;
  bool deforms() const { return equilibrium_.has_value(); }

  InitialState download() const;
  std::vector<double> download_nodes() const;

  // Everything that later steps depend on, between two steps.
  void save(StateWriter&);
  // Of a sheet of the same scene, at time t. Errors: StateMismatch.
  void load(StateReader&, double t);
  bool more_stimuli(double t) const { return schedule_.more_to_come(t); }
  double stimulus_period() const { return schedule_.last_period(); }

 private:
  template <class Archive>
  void state(Archive& archive) {
    archive(state_.V, state_.r, state_.Ta, clean_, stable_dt_, area_, activation_sampled_);
    if (scene_.output.maps) archive(activation_.marks, activation_.records);
    if (equilibrium_) archive(gauss_tension_.host, node_history_, nodes_.host, element_areas_);
  }
  void allocate_fields(const InitialState&);
  void place_probes();
  void solve_rest_state();
  void download_tension();
  void add_to_statistics(const SolveReport&);
  // Places the nodes that the metric uses from t on; true if one has moved.
  bool place_nodes(double t);
  // `count` steps of this dt, the first at first * dt.
  void take_steps(std::int64_t first, std::int64_t count, double dt);
  // Several steps without a stimulus, or one with the given stimuli; n is the row of the probes' record.
  void tiled_steps(int n, int count, double dt);
  void single_step(int n, const std::vector<tissue::ActiveStimulus>&, double dt);
  void measure_area();
  void upload_stimuli(const std::vector<tissue::ActiveStimulus>&);
  void refresh_metric(double t);

  ExecutionSpace space_;
  Host host_;
  Scene scene_;
  PhaseSeconds* phases_;
  MechanicsStatistics* statistics_;
  tissue::Grid grid_;
  StimulusSchedule schedule_;
  Model<Real> model_;
  typename ModelForms<ExecutionSpace, Real>::Any form_;
  tissue::ExcitationFields<View> state_;
  tissue::ExcitationFields<View> spare_;  // destination of the next steps
  tissue::ExcitationFields<View> kept_;
  CleanRange clean_;
  double stable_dt_;

  // The host solves the mechanics: only the tension is copied to it, and only the nodes from it.
  std::optional<Equilibrium<Host>> equilibrium_;
  DeviceAndHost<GaussTension<Space>> gauss_tension_;
  NodeHistory node_history_;
  DeviceAndHost<Nodes<Space>> nodes_;  // those that the metric is computed from
  Kokkos::View<double*, Kokkos::HostSpace> element_areas_;
  std::vector<double> rest_areas_;
  AreaSample area_;

  using Record = Kokkos::View<Real**, Kokkos::LayoutRight, Space>;
  std::vector<double> probe_history_;
  Kokkos::View<std::int64_t*, Space> probe_nodes_;  // linear index of each probe
  std::uint64_t probe_rows_ = 0;                    // see observe::ProbeRecorder
  DeviceAndHost<Record> probe_record_;              // (step, probe)
  DeviceAndHost<Record> probe_values_;              // (V, r, Ta; probe)
  DeviceAndHost<Kokkos::View<int, Space>> tip_count_;
  DeviceAndHost<Kokkos::View<observe::PhaseSingularity*, Space>> tip_list_;
  observe::ActivationFields<Space> activation_;
  std::optional<double> activation_sampled_;              // t of the last sample
  Kokkos::View<tissue::ActiveStimulus*, Space> stimuli_;  // capacity for all
  std::vector<tissue::ActiveStimulus> uploaded_stimuli_;  // those that stimuli_ holds
};

}  // namespace myowave::solver
