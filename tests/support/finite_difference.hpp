// Central difference of fourth order.
#pragma once

namespace myowave::test {

// f'(0) of f(step). With a step of 1e-3 of the scale of f, both errors are of order 1e-12.
template <class Function>
double derivative(const Function& f, double step = 1e-3) {
  return (8 * (f(step) - f(-step)) - (f(2 * step) - f(-2 * step))) / (12 * step);
}

}  // namespace myowave::test
