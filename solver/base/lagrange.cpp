#include "solver/base/lagrange.hpp"

namespace myowave::solver {

std::vector<double> lagrange_weights(std::span<const double> points, double x) {
  std::vector<double> weights(points.size(), 1);
  for (std::size_t n = 0; n < points.size(); ++n)
    for (std::size_t m = 0; m < points.size(); ++m)
      if (m != n) weights[n] *= (x - points[m]) / (points[n] - points[m]);
  return weights;
}

}  // namespace myowave::solver
