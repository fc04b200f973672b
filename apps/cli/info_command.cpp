// `myowave info`.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <Kokkos_Core.hpp>
#include <sstream>
#include <string>

#include "apps/base/device.hpp"
#include "apps/base/revision.hpp"
#include "apps/cli/commands.hpp"

namespace myowave::apps {
namespace {

void print_info() {
  const Device device;
  fmt::print("myowave       {}\n", version());
  fmt::print("git           {}{}\n", git_revision(), has_local_changes() ? " with changes" : "");
  fmt::print("backend       {}, {} threads or streams at once\n", Kokkos::DefaultExecutionSpace::name(),
             Kokkos::DefaultExecutionSpace().concurrency());
  fmt::print("host backend  {}, {} threads\n", Kokkos::DefaultHostExecutionSpace::name(),
             Kokkos::DefaultHostExecutionSpace().concurrency());
  fmt::print("devices       {}\n",
             Kokkos::num_devices() > 0 ? std::to_string(Kokkos::num_devices()) : "none, runs on the host");
  fmt::print("Kokkos        {}.{}.{}\n\n", KOKKOS_VERSION / 10000, KOKKOS_VERSION / 100 % 100,
             KOKKOS_VERSION % 100);
  std::ostringstream configuration;
  Kokkos::print_configuration(configuration);
  fmt::print("{}", configuration.str());
}

}  // namespace

void add_info(CLI::App& app) {
  app.add_subcommand("info", "Print version, git hash, backends, devices and the Kokkos configuration")
      ->callback(print_info);
}

}  // namespace myowave::apps
