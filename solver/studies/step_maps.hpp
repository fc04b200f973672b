// Maps of dt against the deformation of a sheet that is held deformed (solver/studies/step_trial.hpp): where
// explicit steps are right, finite but wrong, or blow up, over the bound of largest_stable_dt.
#pragma once

#include <string>
#include <vector>

#include "solver/studies/map_table.hpp"
#include "solver/studies/step_trial.hpp"

namespace myowave::solver {

// One line of a map: a sheet, and the number that says how it is deformed.
struct DeformedSheet {
  double value = 0;
  StepTrial trial;
};

// Tries dt on each sheet from 0.4 of its bound to 1.7 times it, and halves the steps between two that end
// differently down to 0.5 % of the bound.
MapTable map_of_steps(std::string name, const std::string& caption, MapColumn deformation,
                      const std::vector<DeformedSheet>&, const MapProgress&);

MapTable make_dt_rigid(const MapProgress&);     // against dx
MapTable make_dt_stretch(const MapProgress&);   // the same stretch both ways
MapTable make_dt_uniaxial(const MapProgress&);  // stretch along X1
MapTable make_dt_shear(const MapProgress&);     // x1 = X1 + shear X2
MapTable make_dt_bilinear(const MapProgress&);  // one element over the sheet with a shortened edge
MapTable make_dt_crumpled(const MapProgress&);  // every other node moved, so that F jumps between elements

}  // namespace myowave::solver
