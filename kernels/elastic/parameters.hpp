// Parameters of the passive material, without device functions: scenes hold the same struct, and what reads
// scenes compiles without Kokkos.
#pragma once

namespace myowave::elastic {

// Nash & Panfilov 2004, Table 1.
struct MooneyRivlin {
  double c1 = 2;  // kPa, >= 0
  double c2 = 6;  // kPa, >= 0
};

}  // namespace myowave::elastic
