// A run that is stopped and resumed from its checkpoint is bitwise identical to one that was never stopped.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <functional>

#include "solver/base/error.hpp"
#include "solver/run/checkpoint.hpp"
#include "solver/run/make_initial_state.hpp"
#include "solver/run/run.hpp"
#include "tests/support/own_process.hpp"
#include "tests/support/random_run.hpp"
#include "tests/support/recording_sink.hpp"
#include "tests/support/temporary_folder.hpp"

namespace myowave {
namespace {

// All output of a run as one text, with exact numbers.
class Transcript : public solver::OutputSink {
 public:
  void fields(const solver::Frame& frame) override {
    add("fields {:a}", frame.t), add(frame.V), add(frame.r), add(frame.Ta), add(frame.nodes);
  }
  void probes(double t, std::span<const double> values) override { add("probes {:a}", t), add(values); }
  void tips(double t, std::span<const solver::Tip> tips) override {
    add("tips {:a}", t);
    for (const auto& tip : tips) add(" {:a} {:a} {} {}", tip.x, tip.y, tip.charge, tip.trajectory);
  }
  void beat(const solver::ProbeBeat& one) override {
    const auto& [upstroke, period, apd, apd90, di] = one.beat;
    add("beat {} {:a} {:a} {:a} {:a} {:a}", one.probe, upstroke, period, apd, apd90, di);
  }
  void trajectory(const solver::TipTrajectory& one) override {
    add("trajectory {} {} {:a} {:a} {} {}", one.number, one.charge, one.birth, one.death, int(one.born),
        int(one.ended));
    if (one.core) add(" {:a} {:a} {:a} {}", one.core->x, one.core->y, one.core->radius, one.core->rotations);
    if (one.drift) add(" {:a} {:a}", one.drift->speed, one.drift->direction);
  }
  void area(double t, double total, double min, double max) override {
    add("area {:a} {:a} {:a} {:a}", t, total, min, max);
  }
  void element_areas(double t, std::span<const double> ratios) override { add("areas {:a}", t), add(ratios); }
  void maps(const solver::ActivationMaps& maps) override {
    add("maps"), add(maps.activation), add(maps.period), add(maps.period_sd), add(maps.apd);
  }
  void warning(const std::string& text) override { add("warning {}", text); }
  bool wants_fields() const override { return true; }

  // Output up to a checkpoint is complete when the checkpoint is saved; later output is repeated.
  std::string mark() override { return std::to_string(text_.size()); }
  void go_on_from(const std::string& mark) { text_.resize(std::stoul(mark)); }

  void add_summary(const solver::RunSummary& s) {
    const auto& o = s.observables;
    add("summary {} {:a} {} {} {} {}", s.steps, s.t, s.substepped_steps, s.largest_substeps,
        s.warnings.size(), o.trajectories.n);
    const auto& m = s.mechanics;
    add(" {} {} {} {} {} {} {} {:a}", m.solves, m.left_out, m.newton_iterations, m.newton_max,
        m.factorizations, m.shifts, m.not_elliptic, m.min_J);
    for (const auto* value : {&o.period, &o.apd, &o.apd90, static_cast<const solver::MeanSd*>(&o.tips)})
      add(" {:a} {:a} {}", value->mean, value->sd, value->n);
    add(" {:a} {:a}", o.breakup_tu.value_or(-1), o.death_tu.value_or(-1));
    if (o.area) add(" {:a} {:a}", o.area->first, o.area->second);
    if (o.shortening) add(" {:a} {:a}", o.shortening->first, o.shortening->second);
  }
  void add_state(const solver::InitialState& s) { add("state"), add(s.V), add(s.r), add(s.Ta); }

  const std::string& text() const { return text_; }

 private:
  template <class... Values>
  void add(const char* format, const Values&... values) {
    text_ += fmt::vformat(format, fmt::make_format_args(values...)) + '\n';
  }
  void add(std::span<const double> values) {
    const auto at = text_.size();
    text_.resize(at + values.size_bytes());
    if (!values.empty()) std::memcpy(text_.data() + at, values.data(), values.size_bytes());
    text_ += '\n';
  }

  std::string text_;
};

// Asks the run to stop after so many samples of tips.
class StoppingTranscript : public Transcript {
 public:
  std::atomic<bool> stop = false;
  int stop_after = -1;  // < 0: never

  void tips(double t, std::span<const solver::Tip> tips) override {
    Transcript::tips(t, tips);
    if (stop_after >= 0 && stop_after-- == 0) stop = true;
  }
};

solver::Scene spiral(bool contracts) {
  solver::Scene scene;
  scene.grid = {61, 61, 0.6};
  scene.time.t_end = 16;
  scene.excitation.mu1 = 0.1;
  if (contracts) {
    scene.mechanics.emplace();
    scene.mechanics->interval = 35;  // not a multiple of a sampling interval
  }
  scene.initial.type = solver::InitialSettings::Type::broken_front;
  scene.output.every = 4;
  scene.output.tips_every = 0.4;
  scene.output.probes = {{20, 20}, {40, 31}};
  scene.output.period_from = 0;
  return scene;
}

std::string undisturbed(const solver::Scene& scene) {
  Transcript told;
  solver::RunSummary summary;
  told.add_state(solver::run(scene, solver::make_initial_state(scene), told, summary));
  told.add_summary(summary);
  return told.text();
}

// Stops after each `samples` samples and resumes with a new keeper, as a new process would.
std::string in_parts(const solver::Scene& scene, int samples, int* parts = nullptr) {
  const test::TemporaryFolder folder;
  StoppingTranscript told;
  for (int part = 0;; ++part) {
    std::vector<std::string> refused;
    const auto found = solver::find_checkpoint(folder.path() / "checkpoints", refused);
    EXPECT_TRUE(refused.empty());
    EXPECT_EQ(found.has_value(), part > 0);
    if (found) told.go_on_from(found->mark);
    solver::CheckpointKeeper keeper(folder.path() / "checkpoints", "a run", found ? &*found : nullptr);
    told.stop = false;
    told.stop_after = samples;
    solver::RunSummary summary;
    const solver::RunControl control{
        .stop = &told.stop, .checkpoints = &keeper, .resume = found ? &*found : nullptr};
    try {
      auto initial = found ? solver::InitialState{} : solver::make_initial_state(scene);
      told.add_state(solver::run(scene, std::move(initial), told, summary, control));
      told.add_summary(summary);
      if (parts != nullptr) *parts = part + 1;
      return told.text();
    } catch (const solver::Interrupted&) {
    }
  }
}

struct Case {
  std::string name;
  std::function<void(solver::Scene&)> change;
  bool contracts = true;
};

class Resume : public testing::TestWithParam<Case> {};

TEST_P(Resume, IsBitwiseARunThatWasNeverStopped) {
  solver::Scene scene = spiral(GetParam().contracts);
  GetParam().change(scene);
  const std::string whole = undisturbed(scene);
  int parts = 0;
  EXPECT_TRUE(in_parts(scene, 0, &parts) == whole);
  EXPECT_GE(parts, 20);
  EXPECT_TRUE(in_parts(scene, 6) == whole);
}

INSTANTIATE_TEST_SUITE_P(
    Of, Resume,
    testing::Values(Case{"rigid", [](solver::Scene&) {}, false}, Case{"contracting", [](solver::Scene&) {}},
                    Case{"float32", [](solver::Scene& s) { s.precision = solver::Precision::float32; }},
                    Case{"expanded", [](solver::Scene& s) { s.metric = solver::MetricForm::expanded; }},
                    Case{"linear", [](solver::Scene& s) { s.metric_time = solver::MetricTime::linear; }},
                    Case{"quadratic",
                         [](solver::Scene& s) { s.metric_time = solver::MetricTime::quadratic; }},
                    Case{"fixed_edges", [](solver::Scene& s) { s.mechanics->edges = solver::Edges::fixed; }},
                    Case{"dead_load", [](solver::Scene& s) { s.mechanics->load = solver::Load::dead; }},
                    // 48 x 48 elements: factors by the multifrontal method.
                    Case{"many_elements",
                         [](solver::Scene& s) {
                           s.grid = {97, 97, 0.6};
                           s.mechanics->cells_per_element = 2;
                           s.time.t_end = 9;
                         }},
                    // From sheets far from equilibrium: shifted factors and ramps.
                    Case{"strong_tension", [](solver::Scene& s) { s.tension.k_Ta = 70; }},
                    Case{"float32_all",
                         [](solver::Scene& s) {
                           s.precision = solver::Precision::float32;
                           s.output.maps = true;
                         }},
                    Case{"without_tension", [](solver::Scene& s) { s.output.tension = false; }, false},
                    Case{"maps",
                         [](solver::Scene& s) {
                           s.output.maps = s.output.element_areas = true;
                           s.time.t_end = 20;
                         }},
                    Case{"stop_on_breakup",
                         [](solver::Scene& s) {
                           s.time.stop_on.breakup = s.time.stop_on.death = true;
                           s.time.t_end = 60;
                         }},
                    Case{"substeps",
                         [](solver::Scene& s) {
                           s.on_unstable = solver::OnUnstable::substep;
                           s.time.dt = 0.05;
                           s.tension.k_Ta = 55;
                           s.output.tips_every = 0.5;
                         }},
                    Case{"stimulus",
                         [](solver::Scene& s) {
                           s.stimuli.push_back({.start = 3.3,
                                                .period = 5,
                                                .duration = 1.1,
                                                .amplitude = 2,
                                                .count = -1,
                                                .shape = solver::Stimulus::Shape::block,
                                                .columns = {0, 3},
                                                .rows = {0, 60}});
                         }}),
    [](const auto& one) { return one.param.name; });

// A precondition saves checkpoints if checkpoint_every is set. It is not sampled.
TEST(ResumeOfAPrecondition, IsBitwiseARunThatWasNeverStopped) {
  solver::Scene scene = spiral(true);
  scene.initial.preconditions = {{.duration = 4, .contraction = false, .excitation = {}, .tension = {}},
                                 {.duration = 6, .contraction = true, .excitation = {}, .tension = {}}};
  const std::string whole = undisturbed(scene);
  scene.output.checkpoint_every = 1.3;

  // Stops when the run reports its stage.
  struct InStage : Transcript {
    std::atomic<bool> stop = false;
    solver::RunStage stage;
    void progress(const solver::Progress& p) override { stop = stop || p.stage == stage; }
  };
  for (const std::size_t number : {0, 1}) {
    const solver::RunStage stage{solver::RunStage::Kind::precondition, number, 2};
    SCOPED_TRACE(solver::stage_text(stage));
    const test::TemporaryFolder folder;
    InStage told;
    told.stage = stage;
    solver::CheckpointKeeper keeper(folder.path(), "a run");
    solver::RunSummary summary;
    EXPECT_THROW(solver::run(scene, solver::make_initial_state(scene), told, summary,
                             {.stop = &told.stop, .checkpoints = &keeper}),
                 solver::Interrupted);
    std::vector<std::string> refused;
    const auto found = solver::find_checkpoint(folder.path(), refused);
    ASSERT_TRUE(found);
    Transcript rest;
    solver::RunSummary of_rest;
    rest.add_state(solver::run(scene, {}, rest, of_rest, {.resume = &*found}));
    rest.add_summary(of_rest);
    EXPECT_TRUE(rest.text() == whole);
  }
}

// With checkpoint_every a run leaves its last two checkpoints and can be resumed from either.
TEST(Checkpoints, AreWrittenAtTheirIntervalAndTheLastTwoRemain) {
  solver::Scene scene = spiral(true);
  const std::string whole = undisturbed(scene);
  scene.output.checkpoint_every = 3;
  const test::TemporaryFolder folder;
  solver::CheckpointKeeper keeper(folder.path(), "a run");
  Transcript told;
  solver::RunSummary summary;
  told.add_state(
      solver::run(scene, solver::make_initial_state(scene), told, summary, {.checkpoints = &keeper}));
  told.add_summary(summary);
  EXPECT_TRUE(told.text() == whole);

  std::vector<std::string> refused;
  for (const double t : {15.0, 12.0}) {
    const auto found = solver::find_checkpoint(folder.path(), refused);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->t, t, 0.2);
    Transcript rest = told;
    rest.go_on_from(found->mark);
    solver::RunSummary of_rest;
    rest.add_state(solver::run(scene, {}, rest, of_rest, {.resume = &*found}));
    rest.add_summary(of_rest);
    EXPECT_TRUE(rest.text() == whole);
    std::filesystem::remove(found->file);
  }
  EXPECT_FALSE(solver::find_checkpoint(folder.path(), refused));
  EXPECT_TRUE(refused.empty());
}

TEST(Checkpoints, OfAnotherSceneAreRefused) {
  const test::TemporaryFolder folder;
  solver::Scene scene = spiral(true);
  scene.output.checkpoint_every = 3;
  solver::CheckpointKeeper keeper(folder.path(), "a run");
  Transcript told;
  solver::RunSummary summary;
  solver::run(scene, solver::make_initial_state(scene), told, summary, {.checkpoints = &keeper});
  std::vector<std::string> refused;
  const auto found = solver::find_checkpoint(folder.path(), refused);
  ASSERT_TRUE(found);
  for (const auto& change : std::initializer_list<std::function<void(solver::Scene&)>>{
           [](solver::Scene& s) { s.grid.rows = 71; }, [](solver::Scene& s) { s.mechanics.reset(); },
           [](solver::Scene& s) { s.precision = solver::Precision::float32; },
           [](solver::Scene& s) { s.output.maps = true; }}) {
    solver::Scene other = scene;
    change(other);
    EXPECT_THROW(solver::run(other, {}, told, summary, {.resume = &*found}), solver::StateMismatch);
  }
}

TEST(Checkpoints, OfAStageThatTheSceneDoesNotHaveAreRefused) {
  const test::TemporaryFolder folder;
  solver::Scene scene = spiral(false);
  const solver::Scene without = scene;
  scene.initial.preconditions = {{.duration = 1, .contraction = false, .excitation = {}, .tension = {}}};
  scene.output.checkpoint_every = 3;
  solver::CheckpointKeeper keeper(folder.path(), "a run");
  Transcript told;
  solver::RunSummary summary;
  solver::run(scene, solver::make_initial_state(scene), told, summary, {.checkpoints = &keeper});
  std::vector<std::string> refused;
  const auto found = solver::find_checkpoint(folder.path(), refused);
  ASSERT_TRUE(found);
  EXPECT_THROW(solver::run(without, {}, told, summary, {.resume = &*found}), solver::StateMismatch);
}

// Any scene, stopped at each sample or only at some.
TEST(RandomScenes, StoppedAndResumedAreBitwiseIdentical) {
  int gone_on = 0;
  test::for_random_scenes(100, test::random_scene, [&](const std::string& text) {
    const solver::Scene scene = test::parsed(text);
    const auto told = [](const auto& run) -> std::string {
      try {
        return run();
      } catch (const solver::NumericalFailure& failure) {
        return failure.what();
      }
    };
    const std::string whole = told([&] { return undisturbed(scene); });
    for (const int samples : {0, 4}) {
      int parts = 0;
      EXPECT_TRUE(told([&] { return in_parts(scene, samples, &parts); }) == whole) << samples;
      gone_on += parts > 1;
    }
  });
  if (!std::getenv("MYOWAVE_SEEDS")) {
    EXPECT_GE(gone_on, 60);
  }
}

// A run resumed with another number of threads is bitwise identical.
TEST(Checkpoints, ResumeWithAnotherNumberOfThreads) {
  if (Kokkos::DefaultExecutionSpace::name() != std::string("OpenMP"))
    GTEST_SKIP() << "the number of threads is not OpenMP's";
  solver::Scene scene = spiral(true);
  constexpr const char* folder_variable = "MYOWAVE_TEST_CHECKPOINTS";
  if (const std::string path = test::report_path(); !path.empty()) {
    std::vector<std::string> refused;
    const auto found = solver::find_checkpoint(std::getenv(folder_variable), refused);
    Transcript rest;
    solver::RunSummary summary;
    rest.add_state(solver::run(scene, {}, rest, summary, {.resume = &*found}));
    rest.add_summary(summary);
    std::ofstream(path) << std::hash<std::string>()(rest.text());
    return;
  }
  const test::TemporaryFolder folder;
  StoppingTranscript told;
  told.stop_after = 11;
  solver::CheckpointKeeper keeper(folder.path(), "a run");
  solver::RunSummary summary;
  EXPECT_THROW(solver::run(scene, solver::make_initial_state(scene), told, summary,
                           {.stop = &told.stop, .checkpoints = &keeper}),
               solver::Interrupted);
  const std::string where = fmt::format(" {}='{}'", folder_variable, folder.path().string());
  const std::string one = test::report_of_own_process("OMP_NUM_THREADS=1" + where);
  EXPECT_GT(one.size(), 5U);
  EXPECT_EQ(test::report_of_own_process("OMP_NUM_THREADS=3" + where), one);
}

}  // namespace
}  // namespace myowave
