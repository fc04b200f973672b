// Data stay where the excitation runs. A step allocates and copies nothing and does not fence. A solve of the
// mechanics moves the tension at the Gauss points to the host and the nodes back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Kokkos_Core.hpp>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "solver/coupling/electromechanics.hpp"
#include "solver/run/make_initial_state.hpp"
#include "solver/run/run.hpp"

namespace myowave {
namespace {

using Space = Kokkos::DefaultExecutionSpace;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

// A View and the number of its bytes copied between host and device.
struct Movement {
  std::string label;
  std::uint64_t bytes;
  bool operator==(const Movement&) const = default;
};
void PrintTo(const Movement& movement, std::ostream* out) {
  *out << movement.label << ", " << movement.bytes << " B";
}

static_assert(std::is_same_v<solver::Electromechanics<Space, double>::Host::memory_space, Kokkos::HostSpace>);

struct Recording {
  std::vector<std::string> allocations, fences, kernels;
  std::vector<std::string> fences_of_all;  // those for which a member of an ensemble waits for the others
  int copies = 0;
  std::vector<Movement> movements;
};
Recording* recording = nullptr;

// A mirror carries the label of its View and a suffix.
std::string label_of_view(const std::string& label) { return label.substr(0, label.find("_mirror")); }

void record_copy(Kokkos::Tools::SpaceHandle to, const char* to_label, const void* to_data,
                 Kokkos::Tools::SpaceHandle from, const char* from_label, const void* from_data,
                 std::uint64_t bytes) {
  ++recording->copies;
  const std::string source(from_label);
  const bool fills = source == "Scalar" || source == "(none)";
  // Where host and device share their memory, a View is its own mirror. The Views of the equilibrium
  // are the host's on every backend.
  const bool crosses = std::string(to.name) != from.name ||
                       (to_data == from_data && !source.starts_with("myowave::elastic::"));
  if (crosses && !fills && bytes > 0) recording->movements.push_back({label_of_view(to_label), bytes});
}

// Fences that wait for nothing: of the recording itself, before each callback, or, on a host, of the plain
// loop that copies V at the probes.
bool is_for_show(const std::string& label) {
  constexpr bool on_host = Kokkos::SpaceAccessibility<Kokkos::HostSpace, Space::memory_space>::accessible;
  return label.ends_with("Kokkos Profile Tool Fence") ||
         (on_host && label == "myowave::observe::record_probes");
}

// The Threads backend waits for each kernel itself, and reallocates its scratch memory for larger teams.
bool is_of_threads([[maybe_unused]] const std::string& label) {
#ifdef KOKKOS_ENABLE_THREADS
  return label.starts_with("Kokkos::ThreadsInternal::") ||
         label == "HostSpace::impl_deallocate before free" || label == "Kokkos::thread_scratch";
#else
  return false;
#endif
}

bool waits_for_all_instances(std::uint32_t device) {
  constexpr std::uint32_t all = 0;  // the number that no instance has
  return Kokkos::Tools::Experimental::identifier_from_devid(device).instance_id == all;
}

// Records what Kokkos does during an action.
template <class Action>
Recording record(const Action& action) {
  namespace tools = Kokkos::Tools::Experimental;
  Recording result;
  recording = &result;
  const auto add_kernel = [](const char* label, std::uint32_t, std::uint64_t*) {
    recording->kernels.emplace_back(label);
  };
  tools::set_begin_parallel_for_callback(add_kernel);
  tools::set_begin_parallel_reduce_callback(add_kernel);
  tools::set_begin_fence_callback([](const char* label, std::uint32_t device, std::uint64_t*) {
    if (is_for_show(label) || is_of_threads(label)) return;
    recording->fences.emplace_back(label);
    if (waits_for_all_instances(device)) recording->fences_of_all.emplace_back(label);
  });
  tools::set_allocate_data_callback(
      [](Kokkos::Tools::SpaceHandle, const char* label, const void*, std::uint64_t) {
        // The work space of reductions on a device belongs to Kokkos and grows to the largest reduction.
        if (!std::string(label).starts_with("Kokkos::Internal") && !is_of_threads(label))
          recording->allocations.emplace_back(label);
      });
  tools::set_begin_deep_copy_callback(record_copy);
  action();
  tools::set_begin_parallel_for_callback(nullptr);
  tools::set_begin_parallel_reduce_callback(nullptr);
  tools::set_begin_fence_callback(nullptr);
  tools::set_allocate_data_callback(nullptr);
  tools::set_begin_deep_copy_callback(nullptr);
  recording = nullptr;
  return result;
}

// Odd: a tile that is a whole sheet takes its passes in one launch only where they are equally deep.
constexpr int interval = 39;

// Four probes and, for the first t.u., a stimulus.
solver::Scene contracting_front(solver::MetricForm metric) {
  solver::Scene scene;
  scene.grid = {41, 51, 0.6};
  scene.metric = metric;
  scene.mechanics.emplace();
  scene.mechanics->interval = interval;
  scene.initial.type = solver::InitialSettings::Type::broken_front;
  scene.output.probes = {{10, 12}, {10, 37}, {30, 12}, {30, 37}};
  scene.stimuli.push_back({.amplitude = 0.5});
  return scene;
}
constexpr std::uint64_t elements = 4 * 5, nodes = 5 * 6;
const Movement tension_down{"myowave::solver::gauss_tension", elements * 4 * sizeof(double)};
const Movement nodes_up{"myowave::solver::nodes", nodes * 2 * sizeof(double)};

template <class Real>
class Sheet {
 public:
  explicit Sheet(const solver::Scene& scene)
      : scene_(scene),
        sheet_(solver::Execution{}, scene_, solver::make_initial_state(scene_), phases_, statistics_) {}

  Recording solve() {
    return record([&] { sheet_.solve_mechanics(t()); });
  }
  Recording advance(int steps) {
    const auto result = record([&] { sheet_.advance(step_, steps); });
    step_ += steps;
    return result;
  }
  Recording find_tips() {
    return record([&] { sheet_.find_tips(t()); });
  }
  Recording sample_probes() {
    return record([&] { sheet_.probe_values(); });
  }

 private:
  double t() const { return static_cast<double>(step_) * scene_.time.dt; }
  solver::Scene scene_;
  solver::PhaseSeconds phases_;
  solver::MechanicsStatistics statistics_;
  solver::Electromechanics<Space, Real> sheet_;
  std::int64_t step_ = 0;
};

template <class Real>
class DataMovement : public ::testing::Test {};
using Precisions = ::testing::Types<double, float>;
TYPED_TEST_SUITE(DataMovement, Precisions);

TYPED_TEST(DataMovement, StepsAllocateCopyAndWaitForNothing) {
  for (const auto metric :
       {solver::MetricForm::none, solver::MetricForm::conservative, solver::MetricForm::expanded}) {
    Sheet<TypeParam> sheet(contracting_front(metric));
    sheet.solve();
    const auto expect_nothing = [&](int fewer_steps, int more_steps) {
      sheet.solve();
      const Recording few = sheet.advance(fewer_steps), many = sheet.advance(more_steps);
      EXPECT_GE(few.kernels.size(), 1U);
      EXPECT_GT(many.kernels.size(), few.kernels.size());
      EXPECT_THAT(few.allocations, IsEmpty());
      EXPECT_THAT(many.allocations, IsEmpty());
      EXPECT_EQ(many.fences, few.fences);
      EXPECT_EQ(many.copies, few.copies);
      constexpr std::uint64_t a_step = 4 * sizeof(TypeParam);
      EXPECT_THAT(few.movements,
                  ElementsAre(Movement{"myowave::solver::probe_record", fewer_steps * a_step}));
      EXPECT_THAT(many.movements,
                  ElementsAre(Movement{"myowave::solver::probe_record", more_steps * a_step}));
    };
    sheet.advance(interval);  // makes room for the probes
    expect_nothing(2, 8);     // while the stimulus is on
    sheet.advance(interval);  // allocates scratch rows for several steps a launch
    expect_nothing(interval / 4, interval);
    expect_nothing(interval / 4, interval);
  }
}

TYPED_TEST(DataMovement, ASolveMovesTheTensionDownAndTheNodesUp) {
  for (const auto metric : {solver::MetricForm::conservative, solver::MetricForm::expanded}) {
    Sheet<TypeParam> sheet(contracting_front(metric));
    sheet.solve();
    for (int n = 0; n < 4; ++n) {
      sheet.advance(interval);
      const Recording solve = sheet.solve();
      EXPECT_THAT(solve.movements, ElementsAre(tension_down, nodes_up));
      EXPECT_THAT(solve.allocations, IsEmpty());
    }
  }
}

TYPED_TEST(DataMovement, WithoutFeedbackNoNodesGoUp) {
  Sheet<TypeParam> sheet(contracting_front(solver::MetricForm::none));
  sheet.advance(interval);
  EXPECT_THAT(sheet.solve().movements, ElementsAre(tension_down));
}

TYPED_TEST(DataMovement, ASampleMovesTheTipsAloneAndAStimulusOnce) {
  Sheet<TypeParam> sheet(contracting_front(solver::MetricForm::conservative));
  sheet.solve();
  const auto moved = [](const Recording& sample, const std::string& label) {
    return std::ranges::count(sample.movements, "myowave::solver::" + label, &Movement::label);
  };
  for (int sample = 0; sample < 8; ++sample) {  // the stimulus ends with the fifth of 10 steps
    const Recording found = sheet.find_tips();
    EXPECT_EQ(moved(found, "tip_count"), 1);
    EXPECT_LE(found.movements.size(), 2U) << "the count and the tips";
    const bool starts = sample == 0;
    EXPECT_EQ(std::ranges::count(found.kernels, "myowave::observe::find_phase_singularities"), 1);
    EXPECT_THAT(found.allocations, IsEmpty());
    EXPECT_EQ(found.copies, (starts ? 1 : 0) + 1 + 1 + 1) << "stimuli; count to zero; count; tips";
    EXPECT_THAT(sheet.sample_probes().movements,
                ElementsAre(Movement{"myowave::solver::probe_values", 3 * 4 * sizeof(TypeParam)}));
    sheet.advance(10);
  }
}

TYPED_TEST(DataMovement, NothingWaitsForOtherInstances) {
  for (const auto metric : {solver::MetricForm::conservative, solver::MetricForm::expanded}) {
    Sheet<TypeParam> sheet(contracting_front(metric));
    for (int n = 0; n < 4; ++n) {
      EXPECT_THAT(sheet.solve().fences_of_all, IsEmpty());
      EXPECT_THAT(sheet.advance(interval).fences_of_all, IsEmpty());
      EXPECT_THAT(sheet.find_tips().fences_of_all, IsEmpty());
      EXPECT_THAT(sheet.sample_probes().fences_of_all, IsEmpty());
    }
  }
}

TEST(DataMovementRecorder, SeesWhatKokkosDoes) {
  const Recording seen = record([] {
    const Kokkos::View<double*, Space> view("view", 5);
    const auto mirror = Kokkos::create_mirror_view(view);
    Kokkos::deep_copy(mirror, view);
    Kokkos::fence("a fence");
  });
  EXPECT_THAT(seen.allocations, ::testing::Contains("view"));
  EXPECT_THAT(seen.fences, ::testing::Contains("a fence"));
  EXPECT_THAT(seen.fences_of_all, ::testing::Contains("a fence"));
  EXPECT_THAT(seen.movements, ElementsAre(Movement{"view", 5 * sizeof(double)}));
}

}  // namespace
}  // namespace myowave
