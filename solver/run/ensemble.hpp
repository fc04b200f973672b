// Many runs at once.
//
// A member is a run like any other, on a thread of the program with an execution of its own. A small sheet
// stays in the cache of its core between solves. Each thread solves the mechanics of one member. No member
// waits for another; when one ends, its thread takes the next. On a device each thread has a queue of its
// own, so that kernels and solves of several members overlap. With one launch for all members, all would wait
// at every step in which one member has a solve, a sample or a stimulus (solver/run/README.md).
#pragma once

#include <cstddef>
#include <functional>

#include "solver/base/execution.hpp"

namespace myowave::solver {

// Threads that members can run on at once: the cores of the host execution space, or 1 if the backend has a
// single instance.
int most_workers();

// Calls work(index, execution) once for every index below `count`, on `workers` threads (at most
// most_workers(), but any number on a device). The next index goes to the first free thread. Remaining host
// threads are distributed over the executions. Errors: the first exception of `work`, after all members in
// flight have ended; no further one is started.
void run_members(std::size_t count, int workers,
                 const std::function<void(std::size_t, const Execution&)>& work);

}  // namespace myowave::solver
