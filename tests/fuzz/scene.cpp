// Scene files: any text is a scene or an InputError.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "apps/input/scene_file.hpp"
#include "solver/base/error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    myowave::apps::parse_scene({reinterpret_cast<const char*>(data), size}, "scene.toml");
  } catch (const myowave::solver::InputError&) {
  }
  return 0;
}
