#include "apps/sweep/sweep_members.hpp"

#include <fmt/format.h>

#include <atomic>
#include <mutex>

#include "apps/base/revision.hpp"
#include "apps/base/signals.hpp"
#include "apps/input/schema.hpp"
#include "apps/results/run_folder.hpp"
#include "solver/base/error.hpp"
#include "solver/run/checkpoint.hpp"
#include "solver/run/ensemble.hpp"

namespace myowave::apps {
namespace {

namespace fs = std::filesystem;

// Shows the progress of a member. Stops it if another member found that the machine fails.
class MemberSink final : public solver::OutputSink {
 public:
  MemberSink(SweepProgress* progress, std::size_t index, const std::atomic<bool>& given_up)
      : progress_(progress), index_(index), given_up_(given_up) {}

  void progress(const solver::Progress& now) override {
    if (given_up_) throw solver::Interrupted("another run of the sweep stopped it");
    // Settling a spiral for the cache is a run of its own without stop flag.
    if (now.stage.kind == solver::RunStage::Kind::settling && stop_requested())
      throw solver::Interrupted("stopped");
    if (progress_ != nullptr && now.stage.kind == solver::RunStage::Kind::scene && now.t_end > 0)
      progress_->advance(index_, now.t / now.t_end);
  }

 private:
  SweepProgress* progress_;
  std::size_t index_;
  const std::atomic<bool>& given_up_;
};

class Members {
 public:
  Members(const SweepPlan& plan, const std::vector<const SweepRun*>& runs, const SweepFolder& folder,
          bool quiet, RecordFile& records, Counts& counts)
      : plan_(plan),
        runs_(runs),
        folder_(folder),
        states_(folder.states(), plan),
        progress_(runs.size(), quiet),
        records_(records),
        counts_(counts) {}

  void run(int jobs) {
    const auto makers = states_.one_of_each(runs_);
    solver::run_members(makers.size(), jobs, [&](std::size_t n, const solver::Execution& execution) {
      giving_up([&] { make_state(*makers[n], execution); });
    });
    solver::run_members(runs_.size(), jobs, [&](std::size_t n, const solver::Execution& execution) {
      giving_up([&] { run_one(n, execution); });
    });
  }

 private:
  template <class Action>
  void giving_up(const Action& action) {
    if (stop_requested()) throw solver::Interrupted("stopped");
    try {
      action();
    } catch (...) {
      given_up_ = true;
      throw;
    }
  }

  solver::RunControl control(const solver::Execution& execution) const {
    solver::RunControl control;
    control.execution = execution;
    control.stop = &stop_requested();
    return control;
  }

  // The records of the runs that need the state report a failure.
  void make_state(const SweepRun& run, const solver::Execution& execution) {
    MemberSink sink(nullptr, 0, given_up_);
    solver::RunSummary unused;
    try {
      states_.shared(run, sink, unused, control(execution));
    } catch (const solver::NumericalFailure&) {
    } catch (const solver::InputError&) {
    }
  }

  void run_one(std::size_t index, const solver::Execution& execution) {
    const SweepRun& run = *runs_[index];
    solver::RunSummary summary;
    std::optional<std::string> failure;
    try {
      if (plan_.folders)
        run_into_folder(run, execution, summary);
      else
        run_with_checkpoints(run, index, execution, summary);
    } catch (const solver::NumericalFailure& error) {
      failure = error.what();
    } catch (const solver::InputError& error) {
      failure = error.what();
    }
    const std::lock_guard lock(mutex_);
    records_.append(record_json(run, summary, plan_.observables, failure));
    // After the record: a kill between the two leaves a surplus checkpoint, never a missing record.
    std::error_code ignored;
    fs::remove_all(folder_.checkpoints(run.id), ignored);
    ++counts_.done;
    counts_.failed += failure.has_value();
    progress_.done(index, counts_);
  }

  void run_with_checkpoints(const SweepRun& run, std::size_t index, const solver::Execution& execution,
                            solver::RunSummary& summary) {
    MemberSink sink(&progress_, index, given_up_);
    // Another revision may save and compute something else.
    const std::string identity = fmt::format("sweep member {} of revision {}", run.id, git_revision());
    std::vector<std::string> refused;
    auto found = solver::find_checkpoint(folder_.checkpoints(run.id), refused);
    for (const auto& line : refused) fmt::print(stderr, "myowave: warning: {}\n", line);
    if (found && found->identity != identity) found.reset();
    solver::CheckpointKeeper keeper(folder_.checkpoints(run.id), identity, found ? &*found : nullptr);
    solver::RunControl how = control(execution);
    how.checkpoints = &keeper;
    how.resume = found ? &*found : nullptr;
    try {
      go(run, sink, summary, how);
    } catch (const solver::StateMismatch& error) {
      fmt::print(stderr, "myowave: warning: {}: {}; the run starts again\n", found->file.string(),
                 error.what());
      summary = {};
      how.resume = nullptr;
      go(run, sink, summary, how);
    }
  }

  // Not from a checkpoint: the files of the folder would have to be resumed too.
  void run_into_folder(const SweepRun& run, const solver::Execution& execution, solver::RunSummary& summary) {
    const std::lock_guard one_folder(folder_mutex_);  // HDF5 is not thread-safe
    RunFolder sink(folder_.run_folder(run.id), run.scene, true, true);
    sink.write_manifest(effective_configuration(run.scene));
    try {
      go(run, sink, summary, control(execution));
    } catch (const solver::NumericalFailure& failure) {
      sink.write_summary(summary, failure.what());
      throw;
    }
    sink.write_summary(summary, std::nullopt);
  }

  // Bitwise identical to solver::run() on the scene.
  void go(const SweepRun& run, solver::OutputSink& sink, solver::RunSummary& summary,
          const solver::RunControl& how) {
    // A checkpoint has the state and the warnings of the preconditions.
    if (!states_.is_shared(run)) {
      auto state = how.resume ? solver::InitialState() : SweepStates::initial(run, sink);
      solver::run(run.scene, std::move(state), sink, summary, how);
    } else {
      auto state =
          how.resume ? solver::InitialState() : states_.shared(run, sink, summary, control(how.execution));
      solver::run_preconditioned(run.scene, std::move(state), sink, summary, how);
    }
  }

  const SweepPlan& plan_;
  const std::vector<const SweepRun*>& runs_;
  const SweepFolder& folder_;
  SweepStates states_;
  SweepProgress progress_;
  std::mutex mutex_, folder_mutex_;
  RecordFile& records_;
  Counts& counts_;
  std::atomic<bool> given_up_ = false;
};

}  // namespace

void do_members(const SweepPlan& plan, const std::vector<const SweepRun*>& runs, const SweepFolder& folder,
                int jobs, bool quiet, RecordFile& records, Counts& counts) {
  Members(plan, runs, folder, quiet, records, counts).run(jobs);
}

}  // namespace myowave::apps
