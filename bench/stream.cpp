// STREAM's triad as a row of the suite, measured in the same run as the kernels.
#include "bench/plain/machine.hpp"
#include "bench/suite.hpp"

namespace myowave::bench {

void register_stream(const Suite& suite) {
  add_row("stream/triad/float64", [suite](benchmark::State& state) {
    const std::size_t entries = suite.dry_run ? 1 << 18 : 1 << 24;
    const plain::Triad triad(entries);
    const double seconds = measure(state, 2, triad);
    report(state, suite, seconds, "entries_per_s", static_cast<double>(entries),
           {.reads = 16, .writes = 8, .allocates = 8, .flops = 2}, suite.float64_flops_per_s);
    if (!triad.is_right()) fail(state, "the triad's result is wrong");
  });
}

}  // namespace myowave::bench
