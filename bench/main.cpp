// The benchmark suite. Its own options, besides those of Google Benchmark:
//   --dry-run   small sheets, every row once: checks that it runs and that its results are right
//   --large     also the rows that take minutes
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <Kokkos_Core.hpp>
#include <algorithm>
#include <cctype>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "apps/base/revision.hpp"
#include "bench/plain/machine.hpp"
#include "bench/suite.hpp"
#include "solver/base/denormals.hpp"

namespace {

using namespace myowave;

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) return line.substr(line.find(": ") + 2);
  return "unknown";
}

// What Kokkos prints on several lines, as "NAME: value; NAME: value".
std::string kokkos_configuration() {
  std::ostringstream text;
  Kokkos::print_configuration(text);
  std::istringstream lines(text.str());
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    const auto first = line.find_first_not_of(" \t");
    if (first == std::string::npos) continue;
    // Google Benchmark writes the value to JSON without escaping it.
    std::replace_if(
        line.begin(), line.end(), [](unsigned char c) { return std::iscntrl(c) || c == '"' || c == '\\'; },
        ' ');
    result += (result.empty() ? "" : "; ") + line.substr(first);
  }
  return result;
}

bool take(std::vector<char*>& arguments, std::string_view option) {
  return std::erase_if(arguments, [&](const char* a) { return option == a; }) > 0;
}

void measure_machine(bench::Suite& suite) {
  // The three arrays are far larger than a cache. The best of some repeats is nearest to what the machine can
  // do.
  const std::size_t entries = suite.dry_run ? 1 << 20 : 1 << 25;
  const int repeats = suite.dry_run ? 2 : 10;
  suite.triad_bytes_per_s = plain::triad_bytes_per_s(entries, repeats);
  suite.float64_flops_per_s = plain::peak_flops_per_s<double>(repeats);
  suite.float32_flops_per_s = plain::peak_flops_per_s<float>(repeats);
}

void add_context(const bench::Suite& suite) {
  const auto add = [](const char* name, const std::string& value) {
    benchmark::AddCustomContext(name, value);
  };
  add("myowave", apps::version());
  add("git_hash", apps::git_revision());
  add("git_dirty", apps::has_local_changes() ? "true" : "false");
  add("compiler", MYOWAVE_COMPILER);
  add("compiler_flags", MYOWAVE_FLAGS);
  add("kokkos",
      fmt::format("{}.{}.{}", KOKKOS_VERSION / 10000, KOKKOS_VERSION / 100 % 100, KOKKOS_VERSION % 100));
  add("kokkos_configuration", kokkos_configuration());
  add("backend", Kokkos::DefaultExecutionSpace::name());
  add("threads", std::to_string(Kokkos::DefaultHostExecutionSpace().concurrency()));
  add("cpu", processor());
  add("triad_bytes_per_s", fmt::format("{:.4g}", suite.triad_bytes_per_s));
  add("float64_flops_per_s", fmt::format("{:.4g}", suite.float64_flops_per_s));
  add("float32_flops_per_s", fmt::format("{:.4g}", suite.float32_flops_per_s));
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<char*> arguments(argv, argv + argc);
  bench::Suite suite;
  suite.dry_run = take(arguments, "--dry-run");
  suite.large = take(arguments, "--large");
  std::string instant = "--benchmark_min_time=0.001";
  if (suite.dry_run) arguments.push_back(instant.data());
  const bool only_lists = std::ranges::any_of(
      arguments, [](std::string_view a) { return a.starts_with("--benchmark_list_tests"); });

  const Kokkos::ScopeGuard kokkos(argc, argv);
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
  const solver::FlushDenormals flush;
  if (!only_lists) measure_machine(suite);
  add_context(suite);

  bench::register_stream(suite);
  bench::register_tissue(suite);
  bench::register_elastic(suite);
  bench::register_transfer(suite);
  bench::register_observe(suite);
  bench::register_solve(suite);
  bench::register_coupled(suite);
  bench::register_pruning(suite);
  bench::register_ensemble(suite);
  bench::register_checkpoint(suite);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return bench::any_failed() ? 1 : 0;
}
