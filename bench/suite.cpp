#include "bench/suite.hpp"

#include <algorithm>
#include <iterator>

namespace myowave::bench {
namespace {

bool failed = false;

constexpr double bytes_of(const Traffic& item) {
  return Kokkos::SpaceAccessibility<Kokkos::HostSpace, MemorySpace>::accessible ? item.host_bytes()
                                                                                : item.device_bytes();
}

}  // namespace

std::vector<int> Suite::sizes(std::initializer_list<int> all, int small) const {
  std::vector<int> result;
  std::copy_if(all.begin(), all.end(), std::back_inserter(result),
               [&](int n) { return !dry_run || n <= small; });
  return result;
}

void report(benchmark::State& state, const Suite& suite, double seconds, const char* rate, double items,
            const Traffic& item, double peak_flops_per_s) {
  const double items_per_s = items * static_cast<double>(state.iterations()) / seconds;
  state.counters[rate] = items_per_s;
  state.counters["bytes_per_s"] = items_per_s * bytes_of(item);
  state.counters["percent_of_triad"] = 100 * items_per_s * bytes_of(item) / suite.triad_bytes_per_s;
  state.counters["flops_per_s"] = items_per_s * item.flops;
  state.counters["percent_of_flop_peak"] = 100 * items_per_s * item.flops / peak_flops_per_s;
}

void fail(benchmark::State& state, const std::string& what) {
  failed = true;
  state.SkipWithError(what.c_str());
}

bool any_failed() { return failed; }

}  // namespace myowave::bench
