#include "apps/results/manifest.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>

#include <Kokkos_Core.hpp>
#include <ctime>
#include <fstream>
#include <string>
#include <thread>

#include "apps/base/library_versions.hpp"
#include "apps/base/revision.hpp"

namespace myowave::apps {
namespace {

using json = nlohmann::ordered_json;

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
  json versions{{"kokkos", dotted(KOKKOS_VERSION, 10000, 100)}};
  versions.update(library_versions());
  return versions;
}

}  // namespace

json manifest_json(const nlohmann::json& effective_configuration) {
  using Space = Kokkos::DefaultExecutionSpace;
  return {{"configuration", effective_configuration},
          {"program",
           {{"name", "myowave"},
            {"version", version()},
            {"git_hash", git_revision()},
            {"git_dirty", has_local_changes()}}},
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
