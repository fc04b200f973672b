// Maps of the mechanics: what becomes of the equilibrium at loads, tensions, materials and meshes far
// from the paper's.
#pragma once

#include <string>

#include "solver/mechanics/equilibrium.hpp"
#include "solver/studies/map_table.hpp"

namespace myowave::solver {

// The tension of a solve over the sheet, between 0 and its largest value.
enum class TensionPattern {
  uniform,
  front,         // a step along an element line in the middle
  front_within,  // the same step half an element further
  oblique,       // a step through elements at every offset
  checkerboard,  // by element
  spiral,        // one arm of three turns, several elements wide
  sharp_spiral,  // the same with a step at its edges
};

// One solve. `from_rest`: after one without tension, so that all of it comes at once; else cold.
struct MechanicsCase {
  TensionPattern pattern = TensionPattern::spiral;
  double largest_Ta = 47.9;  // kPa
  int side = 25;             // elements
  bool from_rest = false;
  MechanicsSettings settings{};
};

enum class MechanicsOutcome {
  converged,
  shifted,         // K + mu L was factorised on the way
  ramped,          // in parts of the tension
  not_elliptic,    // any of these, but the equilibrium has lost ellipticity: it depends on the mesh
  no_equilibrium,  // NumericalFailure before the first iteration
  failed,          // NumericalFailure after iterations
  unnoticed,       // anything else: not finite, inverted, not in equilibrium, another exception
};

struct MechanicsResult {
  MechanicsOutcome outcome = MechanicsOutcome::unnoticed;
  SolveReport report;
  double margin = 0;    // of ellipticity, see solver/mechanics/ellipticity.hpp
  std::string failure;  // its message
};

// Solves, and solves again: an equilibrium stays where it is.
MechanicsResult solve_case(const MechanicsCase&);

MapTable make_mechanics_load(const MapProgress&);
MapTable make_mechanics_material(const MapProgress&);
MapTable make_mechanics_mesh(const MapProgress&);

}  // namespace myowave::solver
