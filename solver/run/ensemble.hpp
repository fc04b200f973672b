// Many runs at once.
//
// A member is a run like any other, on a thread of the program and an execution of its own. A small sheet
// stays in the cache of its core from one solve to the next, the threads solve the mechanics of as many
// members at once, no member waits for another, and the one that ends first makes room for the next. On a
// device each thread has a queue of its own, whose kernels go on beside those of the others, and the hosts'
// solves behind them. One launch for all members would make them wait at every step for the one that has a
// solve, a look or a stimulus; what it costs on a host stands in bench/README.md.
#pragma once

#include <cstddef>
#include <functional>

#include "solver/base/execution.hpp"

namespace myowave::solver {

// Threads that members can run on at once: the cores of the host execution space, or 1 where the backend has
// a single instance.
int most_workers();

// Calls work(index, execution) once for every index below `count`, on `workers` threads (at most
// most_workers(), or as many as asked for on a device). The next index goes to the thread that is free first.
// Host threads that are left over are shared out among the executions. Errors: the first exception of `work`,
// after all members under way have ended; no other is begun then.
void run_members(std::size_t count, int workers,
                 const std::function<void(std::size_t, const Execution&)>& work);

}  // namespace myowave::solver
