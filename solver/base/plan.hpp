// The plan of a run: which parts of the model run, as which variant, why the others do not, and the memory of
// each.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace myowave::solver {

struct PlannedPart {
  std::string part{};  // "active tension"
  bool active = false;
  std::string what{};              // the equation, kernel variant or file; empty if it is not active
  std::string why{};               // it is there, or why it is not
  std::uint64_t device_bytes = 0;  // in Kokkos Views where the excitation runs, during the whole run
  std::uint64_t host_bytes = 0;    // in Views of the host beside them, which may be the same memory
  std::uint64_t other_bytes = 0;   // on the host: tables, the factor (estimated), copies of the state

  std::uint64_t bytes() const { return device_bytes + host_bytes + other_bytes; }
};

// Bytes of a run's Views in one of Kokkos' memory spaces.
struct SpaceBytes {
  std::string space{};  // Kokkos' name of it: "Host", "Cuda"
  std::uint64_t bytes = 0;
};

struct Plan {
  std::vector<PlannedPart> parts;
  double state_bytes_per_node = 0;        // V, r and Ta, old and new
  double coefficient_bytes_per_node = 0;  // of the diffusion term, and what refreshes them

  std::uint64_t bytes() const;         // in all
  std::uint64_t device_bytes() const;  // of Views where the excitation runs
  // "part: what" of every active part.
  std::vector<std::string> in_words() const;
};

}  // namespace myowave::solver
