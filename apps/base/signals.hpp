// Signals that ask a run to stop, so that it can be resumed later: SIGTERM and SIGUSR1 (sent by batch systems
// before they kill a job), SIGINT (the keyboard).
#pragma once

#include <atomic>

namespace myowave::apps {

// True after one of the signals arrived.
const std::atomic<bool>& stop_requested();

// Lets the signals set stop_requested(). A second SIGINT ends the process at once.
void watch_signals();

}  // namespace myowave::apps
