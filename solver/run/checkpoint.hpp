// Files from which a run resumes. The last two remain. Each is written under another name, flushed to the
// disk and renamed, so that a run that is killed at any instant leaves at least the previous one.
//
// A file: a header (magic, format version, sizes, serial number, step and time, its checksum), the identity
// of the run, the mark of its outputs, the state, and a checksum of all three. Checksums are XXH3. Numbers
// are those of the machine; another byte order is refused.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "solver/base/archive.hpp"

namespace myowave::solver {

struct FoundCheckpoint {
  std::filesystem::path file;
  std::uint64_t serial = 0;    // increases by 1 a checkpoint
  std::int64_t step = 0;       // of the stage that the run is in
  double t = 0;                // t.u., likewise
  std::string identity, mark;  // see CheckpointKeeper, OutputSink::mark
  std::vector<std::byte> bytes;
  std::size_t state_begin = 0;  // in `bytes`
  std::span<const std::byte> state() const { return std::span(bytes).subspan(state_begin); }
};

// The newest valid checkpoint in a folder; empty if there is none. `refused` gets a line for each invalid
// file: its path and what is wrong. Errors: std::runtime_error if a file exists but cannot be read.
std::optional<FoundCheckpoint> find_checkpoint(const std::filesystem::path& folder,
                                               std::vector<std::string>& refused);

class CheckpointKeeper {
 public:
  // identity: a text that identifies the run; every checkpoint contains it. `last`: the checkpoint that the
  // run resumes from; it remains until there are two newer ones. A run that starts anew removes all
  // checkpoints in the folder.
  CheckpointKeeper(std::filesystem::path folder, std::string identity, const FoundCheckpoint* last = nullptr);

  // Returns when the file is safe on the disk.
  // Errors: std::runtime_error "cannot write FILE: reason"; earlier checkpoints remain.
  void keep(const StateWriter&, std::int64_t step, double t, const std::string& mark);

  // For a run that has ended: there is nothing to resume.
  void remove_all() const;

  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
  std::string identity_;
  std::uint64_t serial_;
};

}  // namespace myowave::solver
