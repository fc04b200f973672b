// The ways a run can end before it is done. apps/cli/main.cpp turns them into exit status 2, 3 and 75.
#pragma once

#include <stdexcept>

namespace myowave::solver {

// The input asks for something that cannot be done: exit 2.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The numerics failed: the message gives time, place, state and what to do. Exit 3.
struct NumericalFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The run was asked to stop and can be resumed; not a failure. Exit 75, EX_TEMPFAIL of sysexits.h.
struct Interrupted : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace myowave::solver
