#include "apps/base/library_versions.hpp"

#include <fmt/format.h>
#include <hdf5.h>
#include <png.h>
#include <toml++/toml.h>

namespace myowave::apps {

std::string dotted(int code, int major, int minor) {
  return fmt::format("{}.{}.{}", code / major, code % major / minor, code % minor);
}

nlohmann::ordered_json library_versions() {
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return {{"hdf5", fmt::format("{}.{}.{}", major, minor, release)},
          {"libpng", png_get_libpng_ver(nullptr)},
          {"fmt", dotted(FMT_VERSION, 10000, 100)},
          {"tomlplusplus", fmt::format("{}.{}.{}", TOML_LIB_MAJOR, TOML_LIB_MINOR, TOML_LIB_PATCH)},
          {"nlohmann_json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                                        NLOHMANN_JSON_VERSION_PATCH)}};
}

}  // namespace myowave::apps
