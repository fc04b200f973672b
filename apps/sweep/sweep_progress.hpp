// Progress of parallel runs on stderr: one line that is rewritten on a terminal, plain lines elsewhere.
#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>
#include <vector>

namespace myowave::apps {

struct Counts {
  std::size_t done = 0, failed = 0;  // failed ones are done too
};

// "12 of 80 runs, 1 failed, 2 running  ETA 3:12". `fraction`: of all that is to do.
std::string sweep_progress_text(const Counts&, std::size_t runs, std::size_t running, double fraction,
                                double seconds);

// Thread-safe.
class SweepProgress {
 public:
  SweepProgress(std::size_t runs, bool quiet);
  ~SweepProgress();
  SweepProgress(const SweepProgress&) = delete;
  SweepProgress& operator=(const SweepProgress&) = delete;

  // Progress of run `index`, 0 to 1.
  void advance(std::size_t index, double fraction);
  void done(std::size_t index, const Counts&);

 private:
  using Clock = std::chrono::steady_clock;
  void show(bool last);

  std::mutex mutex_;
  bool quiet_, terminal_;
  bool open_ = false;
  Counts counts_;
  std::vector<double> fractions_;
  Clock::time_point start_, last_shown_;
};

}  // namespace myowave::apps
