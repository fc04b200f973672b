#include "apps/manifest.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <hdf5.h>
#include <png.h>
#include <sys/utsname.h>
#include <toml++/toml.h>

#include <Kokkos_Core.hpp>
#include <ctime>
#include <fstream>
#include <string>
#include <thread>

#include "myowave_version.hpp"

namespace myowave::apps {
namespace {

using json = nlohmann::ordered_json;

// A version coded as a number, MAJOR major + MINOR minor + patch.
std::string dotted(int code, int major, int minor) {
  return fmt::format("{}.{}.{}", code / major, code % major / minor, code % minor);
}

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (!line.starts_with("model name")) continue;
    const auto colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string operating_system() {
  utsname name{};
  if (uname(&name) != 0) return "unknown";
  return fmt::format("{} {} {}", name.sysname, name.release, name.machine);
}

std::string compiler() {
#if defined(__clang__)
  return "Clang " __clang_version__;
#elif defined(__GNUC__)
  return "GCC " __VERSION__;
#else
  return "unknown";
#endif
}

json libraries() {
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return {{"kokkos", dotted(KOKKOS_VERSION, 10000, 100)},
          {"hdf5", fmt::format("{}.{}.{}", major, minor, release)},
          {"libpng", png_get_libpng_ver(nullptr)},
          {"fmt", dotted(FMT_VERSION, 10000, 100)},
          {"tomlplusplus", fmt::format("{}.{}.{}", TOML_LIB_MAJOR, TOML_LIB_MINOR, TOML_LIB_PATCH)},
          {"nlohmann_json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                                        NLOHMANN_JSON_VERSION_PATCH)}};
}

}  // namespace

json manifest_json(const nlohmann::json& effective_configuration) {
  using Space = Kokkos::DefaultExecutionSpace;
  return {{"configuration", effective_configuration},
          {"program",
           {{"name", "myowave"}, {"version", version}, {"git_hash", git_hash}, {"git_dirty", git_dirty}}},
          {"started", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))},
          {"backend", {{"name", Space::name()}, {"threads", Space().concurrency()}}},
          {"machine",
           {{"processor", processor()},
            {"cores", std::thread::hardware_concurrency()},
            {"system", operating_system()}}},
          {"compiler", compiler()},
          {"libraries", libraries()}};
}

}  // namespace myowave::apps
