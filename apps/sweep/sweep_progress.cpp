#include "apps/sweep/sweep_progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "apps/base/progress_line.hpp"

namespace myowave::apps {

std::string sweep_progress_text(const Counts& counts, std::size_t runs, std::size_t running, double fraction,
                                double seconds) {
  std::string text = fmt::format("{} of {} runs", counts.done, runs);
  if (counts.failed > 0) text += fmt::format(", {} failed", counts.failed);
  if (running > 0) text += fmt::format(", {} running", running);
  if (fraction > 0 && fraction < 1)
    text += fmt::format("  ETA {}", clock_text(seconds * (1 - fraction) / fraction));
  return text;
}

SweepProgress::SweepProgress(std::size_t runs, bool quiet)
    : quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) == 1),
      fractions_(runs),
      start_(Clock::now()),
      last_shown_(start_) {}

SweepProgress::~SweepProgress() {
  if (open_) fmt::print(stderr, "\n");
}

void SweepProgress::advance(std::size_t index, double fraction) {
  const std::lock_guard lock(mutex_);
  fractions_[index] = std::clamp(fraction, 0.0, 0.999);  // 1: done
  show(false);
}

void SweepProgress::done(std::size_t index, const Counts& counts) {
  const std::lock_guard lock(mutex_);
  fractions_[index] = 1;
  counts_ = counts;
  show(counts.done == fractions_.size());
}

void SweepProgress::show(bool last) {
  using namespace std::chrono_literals;
  const auto now = Clock::now();
  if (quiet_ || (!last && now - last_shown_ < (terminal_ ? 200ms : 10s))) return;
  last_shown_ = now;
  const auto running = std::ranges::count_if(fractions_, [](double f) { return f > 0 && f < 1; });
  const double all = std::reduce(fractions_.begin(), fractions_.end()) / double(fractions_.size());
  const std::string text = sweep_progress_text(counts_, fractions_.size(), std::size_t(running), all,
                                               std::chrono::duration<double>(now - start_).count());
  fmt::print(stderr, "{}{}{}", terminal_ ? "\r\x1b[K" : "", text, terminal_ ? "" : "\n");
  std::fflush(stderr);
  open_ = terminal_;
}

}  // namespace myowave::apps
