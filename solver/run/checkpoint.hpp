// Files from which a run goes on. The last two are kept, each written beside its place, flushed to the disk
// and renamed, so that a run that is killed at any instant leaves at least the one before.
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
  std::uint64_t serial = 0;    // counts up
  std::int64_t step = 0;       // of the stage that the run was in
  double t = 0;                // t.u., likewise
  std::string identity, mark;  // see CheckpointKeeper, OutputSink::mark
  std::vector<std::byte> bytes;
  std::size_t state_begin = 0;  // in `bytes`
  std::span<const std::byte> state() const { return std::span(bytes).subspan(state_begin); }
};

// The newest sound checkpoint in a folder; empty where there is none. `refused` gets a line for each file
// that is not sound: its path and what is wrong. Errors: std::runtime_error where the system refuses to read
// a file that is there.
std::optional<FoundCheckpoint> find_checkpoint(const std::filesystem::path& folder,
                                               std::vector<std::string>& refused);

class CheckpointKeeper {
 public:
  // identity: a text that tells which run it is; every checkpoint has it. `last`: the one that the run goes
  // on from, which stays until two newer ones are there. A run that begins anew removes those that are there.
  CheckpointKeeper(std::filesystem::path folder, std::string identity, const FoundCheckpoint* last = nullptr);

  // Returns when the file is safe on the disk.
  // Errors: std::runtime_error "cannot write FILE: reason"; those kept before stay.
  void keep(const StateWriter&, std::int64_t step, double t, const std::string& mark);

  // The run has ended: nothing is left to go on with.
  void remove_all() const;

  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
  std::string identity_;
  std::uint64_t serial_;
};

}  // namespace myowave::solver
