// The states that runs of a sweep start from. Preconditions that several runs have in common are computed
// once and kept in the sweep's folder.
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
  // `folder` is where the states are kept. Runs of the plan whose states are the same share one.
  SweepStates(std::filesystem::path folder, const SweepPlan&);

  // Whether the run goes on from a state that it shares.
  bool is_shared(const SweepRun&) const;

  // One run of each shared state among the given ones.
  std::vector<const SweepRun*> one_of_each(const std::vector<const SweepRun*>&) const;

  // The state that solver::run_preconditioned() goes on from; of `summary` it fills in what
  // run_preconditions() would, without the time where the state was there. For all threads at once.
  // Errors: those of solver::run; std::runtime_error that names the file where the state cannot be kept.
  solver::InitialState shared(const SweepRun&, solver::OutputSink&, solver::RunSummary& summary,
                              const solver::RunControl&) const;

  // The state before the preconditions.
  static solver::InitialState initial(const SweepRun&, solver::OutputSink&);

 private:
  std::filesystem::path folder_;
  std::map<std::string, std::string> definition_of_;  // by the id of the run, of those that share
};

}  // namespace myowave::apps
