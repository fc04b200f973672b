// `myowave sweep`: many runs of a scene, each a record.
#pragma once

#include <optional>
#include <string>

#include "apps/sweep/sweep_records.hpp"
#include "apps/sweep/sweep_slurm.hpp"

namespace myowave::apps {

struct SweepRequest {
  std::string file;
  std::optional<std::string> out;  // absent: out/<sweep name> in the working directory
  std::string shard = "1/1";       // I/N
  int jobs = 0;                    // runs at once; 0: one a core
  bool dry_run = false;
  bool retry_failed = false;
  bool redo_other_revisions = false;
  bool quiet = false;
  std::optional<SlurmOptions> slurm;
};

// Runs those members of its shard that have no record yet.
// Errors: InputError; Interrupted; std::runtime_error where the machine fails: the records so far are intact.
void sweep(const SweepRequest&);

// Prints how many runs are done, failed and to do, and which processes run the shards.
// Errors: InputError if the folder is not that of a sweep.
void sweep_status(const std::string& folder);

enum class TableFormat { text, csv, json };
void sweep_table(const std::string& folder, TableFormat);

}  // namespace myowave::apps
