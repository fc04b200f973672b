// The states that runs of a sweep start from. Preconditions that several runs share are computed once
// and saved in the folder of the sweep.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "apps/sweep/sweep_file.hpp"
#include "solver/run/run.hpp"

namespace myowave::apps {

// Everything that the state after the preconditions of a scene depends on.
std::string state_definition(const solver::Scene&);

class SweepStates {
 public:
  // `folder`: of the saved states. Runs of the plan with equal states share one.
  SweepStates(std::filesystem::path folder, const SweepPlan&);

  // Whether the run starts from a shared state.
  bool is_shared(const SweepRun&) const;

  // One run of each shared state among the given ones.
  std::vector<const SweepRun*> one_of_each(const std::vector<const SweepRun*>&) const;

  // The state that solver::run_preconditioned() starts from. Fills in the same parts of `summary` as
  // run_preconditions(); the time only if the state had to be computed. Thread-safe.
  // Errors: those of solver::run; std::runtime_error with the file if the state cannot be saved.
  solver::InitialState shared(const SweepRun&, solver::OutputSink&, solver::RunSummary& summary,
                              const solver::RunControl&) const;

  // The state before the preconditions.
  static solver::InitialState initial(const SweepRun&, solver::OutputSink&);

 private:
  std::filesystem::path folder_;
  std::map<std::string, std::string> definition_of_;  // by the id of the run, of those that share
};

}  // namespace myowave::apps
