#include "apps/base/progress_line.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace myowave::apps {
namespace {

double fraction(const solver::Progress& p) { return p.t_end > 0 ? std::clamp(p.t / p.t_end, 0.0, 1.0) : 1.0; }

std::size_t terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

std::string clock_text(double seconds) {
  const auto s = static_cast<long long>(std::ceil(seconds));
  if (s < 3600) return fmt::format("{}:{:02}", s / 60, s % 60);
  return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

std::string progress_text(const solver::Progress& p, double seconds, double ms_per_tu) {
  const double done = fraction(p);
  std::string text = fmt::format("{:3.0f} %  t {:.6g}/{:.6g} t.u. ({:.0f} ms)", std::floor(100 * done), p.t,
                                 p.t_end, p.t * ms_per_tu);
  if (done > 0 && done < 1) text += fmt::format("  ETA {}", clock_text(seconds * (1 - done) / done));
  text += fmt::format("  {:.0f} Mcell-steps/s", p.cell_steps_per_s / 1e6);
  if (p.newton_iterations > 0) text += fmt::format("  Newton {}", p.newton_iterations);
  return text + fmt::format("  tips {}", p.tips);
}

ProgressLine::ProgressLine(double ms_per_tu, bool quiet, std::string name)
    : ms_per_tu_(ms_per_tu), quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1), name_(std::move(name)) {}

std::string ProgressLine::title() const { return name_.empty() ? solver::stage_text(*stage_) : name_; }

void ProgressLine::show(const solver::Progress& p) {
  using namespace std::chrono_literals;
  if (quiet_) return;
  const auto now = Clock::now();
  const bool first = p.stage != stage_;
  if (first) {
    end();
    stage_ = p.stage;
    stage_start_ = last_shown_ = now;
    last_fraction_ = 0;
  }
  const double done = fraction(p);
  const bool complete = done >= 1 && last_fraction_ < 1;
  const auto waited = now - last_shown_;
  const double seconds = std::chrono::duration<double>(now - stage_start_).count();
  if (terminal_) {
    if (!first && !complete && waited < 100ms) return;
    show_on_terminal(p, seconds);
  } else {
    if (!complete && waited < 10s && (waited < 1s || done < last_fraction_ + 0.1)) return;
    fmt::print(stderr, "{}: {}\n", title(), progress_text(p, seconds, ms_per_tu_));
  }
  last_shown_ = now;
  last_fraction_ = done;
  if (complete) end();
}

void ProgressLine::show_on_terminal(const solver::Progress& p, double seconds) {
  constexpr std::size_t cells = 24;
  std::string bar;
  const auto filled = static_cast<std::size_t>(fraction(p) * cells);
  bar.append(filled, '#').append(cells - filled, '.');
  auto line = fmt::format("{} [{}] {}", title(), bar, progress_text(p, seconds, ms_per_tu_));
  const std::size_t width = terminal_width();
  // Without its bar where that makes it fit: a wrapped line cannot be rewritten.
  if (line.size() >= width) line = fmt::format("{} {}", title(), progress_text(p, seconds, ms_per_tu_));
  if (line.size() >= width) line.resize(width - 1);
  fmt::print(stderr, "\r\x1b[K{}", line);
  std::fflush(stderr);
  open_ = true;
}

void ProgressLine::end() {
  if (!open_) return;
  fmt::print(stderr, "\n");
  open_ = false;
}

}  // namespace myowave::apps
