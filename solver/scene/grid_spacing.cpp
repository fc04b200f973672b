#include "solver/scene/grid_spacing.hpp"

#include <cmath>

namespace myowave::solver {
namespace {

bool is_whole(double value) {
  constexpr double rounding = 1e-6;  // what decimal numbers leave of a whole number of spacings
  return std::abs(value - std::round(value)) < rounding;
}

}  // namespace

bool divides_sheet(const GridSettings& sheet, double dx) {
  const double ratio = sheet.dx / dx;
  return is_whole((sheet.rows - 1) * ratio) && is_whole((sheet.columns - 1) * ratio);
}

GridSettings with_spacing(const GridSettings& sheet, double dx) {
  const double ratio = sheet.dx / dx;
  return {.rows = static_cast<int>(std::lround((sheet.rows - 1) * ratio)) + 1,
          .columns = static_cast<int>(std::lround((sheet.columns - 1) * ratio)) + 1,
          .dx = dx};
}

GridSettings grid_of_start(const Scene& scene) {
  return scene.initial.dx > 0 ? with_spacing(scene.grid, scene.initial.dx) : scene.grid;
}

}  // namespace myowave::solver
