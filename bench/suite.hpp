// Shared by all benchmarks: which sizes to run, how a row is timed, and what it reports.
#pragma once

#include <benchmark/benchmark.h>

#include <Kokkos_Core.hpp>
#include <chrono>
#include <initializer_list>
#include <string>
#include <vector>

#include "bench/traffic.hpp"

namespace myowave::bench {

using ExecutionSpace = Kokkos::DefaultExecutionSpace;
using MemorySpace = ExecutionSpace::memory_space;

struct Suite {
  bool dry_run = false;  // small sheets, each row once
  bool large = false;    // rows that take minutes
  // Peaks of this machine, measured at the start.
  double triad_bytes_per_s = 0;
  double float64_flops_per_s = 0;
  double float32_flops_per_s = 0;

  template <class Real>
  double peak_flops_per_s() const {
    return sizeof(Real) == sizeof(double) ? float64_flops_per_s : float32_flops_per_s;
  }
  // In a dry run only sizes up to `small`.
  std::vector<int> sizes(std::initializer_list<int> all, int small) const;
};

void register_stream(const Suite&);
void register_tissue(const Suite&);
void register_elastic(const Suite&);
void register_transfer(const Suite&);
void register_observe(const Suite&);
void register_solve(const Suite&);
void register_coupled(const Suite&);
void register_pruning(const Suite&);
void register_ensemble(const Suite&);
void register_checkpoint(const Suite&);

template <class Real>
constexpr const char* precision_name = sizeof(Real) == sizeof(double) ? "float64" : "float32";

// benchmark::RegisterBenchmark with the settings of all rows.
template <class Body>
benchmark::internal::Benchmark* add_row(const std::string& name, const Body& body) {
  return benchmark::RegisterBenchmark(name.c_str(), body)->UseRealTime()->Unit(benchmark::kMicrosecond);
}

// Times body(), one iteration, in batches. No work is in flight when the clock starts or stops. Launches of a
// batch follow one another without a fence, as in a run. Returns the seconds of all iterations.
template <class Body>
double measure(benchmark::State& state, int batch, const Body& body) {
  body();  // warms pages, caches and clock
  Kokkos::fence("myowave::bench::before");
  const auto start = std::chrono::steady_clock::now();
  while (state.KeepRunningBatch(batch)) {
    for (int n = 0; n < batch; ++n) body();
    Kokkos::fence("myowave::bench::after");
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Iterations a batch: short kernels run for about a millisecond between two readings of the clock.
constexpr int batch_of(double items) { return items < 5e5 ? static_cast<int>(1e6 / items) : 2; }

// Sets the counters of a row: cell_steps_per_s or another rate of items, bytes_per_s, flops_per_s,
// percent_of_triad (above 100 if the fields are in the cache) and percent_of_flop_peak.
void report(benchmark::State&, const Suite&, double seconds, const char* rate, double items,
            const Traffic& item, double peak_flops_per_s);

// Marks the row and the whole run as failed.
void fail(benchmark::State&, const std::string& what);
bool any_failed();

}  // namespace myowave::bench
