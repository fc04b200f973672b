// Progress on stderr: one line rewritten on a terminal, a plain line now and then elsewhere.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "solver/base/run_output.hpp"

namespace myowave::apps {

// "1:05", "2:00:00".
std::string clock_text(double seconds);

// " 42 %  t 168/400 t.u. (1680 ms)  ETA 0:12  312 Mcell-steps/s  Newton 1234  tips 1"
// `seconds`: spent in this stage. Newton iterations are left out where there are none.
std::string progress_text(const solver::Progress&, double seconds, double ms_per_tu);

class ProgressLine {
 public:
  // name: shown in place of the stage, if not empty.
  ProgressLine(double ms_per_tu, bool quiet, std::string name = {});
  ~ProgressLine() { end(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const solver::Progress&);
  // Leaves the terminal's cursor on a line of its own.
  void end();

 private:
  using Clock = std::chrono::steady_clock;
  void show_on_terminal(const solver::Progress&, double seconds);
  std::string title() const;

  double ms_per_tu_;
  bool quiet_, terminal_;
  bool open_ = false;  // the terminal's line is not ended
  std::string name_;
  std::optional<solver::RunStage> stage_;
  Clock::time_point stage_start_, last_shown_;
  double last_fraction_ = 0;
};

}  // namespace myowave::apps
