// Frames that look like a run's without running one: a rotating spiral of V and a smooth deformation.
#pragma once

#include <cmath>
#include <vector>

#include "solver/base/run_output.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::test {

class SyntheticFrames {
 public:
  explicit SyntheticFrames(const solver::Scene& scene) : scene_(scene) {}

  // Valid until the next call.
  solver::Frame at(double t) {
    const int rows = scene_.grid.rows, columns = scene_.grid.columns;
    V_.clear();
    r_.clear();
    Ta_.clear();
    nodes_.clear();
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < columns; ++j) {
        const double x = j - 0.5 * (columns - 1), y = i - 0.5 * (rows - 1);
        const double phase = std::atan2(y, x) - 0.13 * std::hypot(x, y) + 0.23 * t;
        V_.push_back(0.5 + 0.5 * std::tanh(4 * std::cos(phase) - 1.5));
        r_.push_back(1 + std::sin(phase));
        Ta_.push_back(40 * V_.back());
      }
    }
    solver::Frame frame;
    frame.t = t;
    frame.rows = rows;
    frame.columns = columns;
    if (scene_.mechanics) {
      const int cells = scene_.mechanics->cells_per_element;
      frame.element_rows = (rows - 1) / cells;
      frame.element_columns = (columns - 1) / cells;
      for (int I = 0; I <= frame.element_rows; ++I) {
        for (int J = 0; J <= frame.element_columns; ++J) {
          const auto [x1, x2] = position(J * cells * scene_.grid.dx, I * cells * scene_.grid.dx, t);
          nodes_.push_back(x1);
          nodes_.push_back(x2);
        }
      }
      frame.nodes = nodes_;
    }
    frame.V = V_;
    frame.r = r_;
    frame.Ta = Ta_;
    return frame;
  }

  // Where the material point (X1, X2) is at time t.
  std::pair<double, double> position(double X1, double X2, double t) const {
    const double L1 = (scene_.grid.columns - 1) * scene_.grid.dx,
                 L2 = (scene_.grid.rows - 1) * scene_.grid.dx;
    const double u = X1 / L1 - 0.5, v = X2 / L2 - 0.5;
    return {L1 * (0.5 + 0.95 * u + 0.05 * std::sin(6 * v + 0.2 * t)),
            L2 * (0.5 + 0.85 * v + 0.06 * std::cos(5 * u - 0.2 * t) * u)};
  }

 private:
  solver::Scene scene_;
  std::vector<double> V_, r_, Ta_, nodes_;
};

}  // namespace myowave::test
