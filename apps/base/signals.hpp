// What asks a run to stop and to be gone on with later: SIGTERM and SIGUSR1 (batch systems, before they
// kill), SIGINT (the keyboard).
#pragma once

#include <atomic>

namespace myowave::apps {

// True once one of them has come.
const std::atomic<bool>& stop_requested();

// From now on they set stop_requested(). A second SIGINT ends the process at once.
void watch_signals();

}  // namespace myowave::apps
