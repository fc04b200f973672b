// Sweep files: any text is a sweep or an InputError.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "apps/sweep/sweep_file.hpp"
#include "solver/base/error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    myowave::apps::parse_sweep({reinterpret_cast<const char*>(data), size}, "sweep.toml");
  } catch (const myowave::solver::InputError&) {
  }
  return 0;
}
