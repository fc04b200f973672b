#include "solver/studies/stability_maps.hpp"

#include "solver/studies/mechanics_maps.hpp"
#include "solver/studies/parameter_maps.hpp"
#include "solver/studies/step_maps.hpp"

namespace myowave::solver {

const std::vector<StabilityMap>& stability_maps() {
  static const std::vector<StabilityMap> maps{
      {"dt_rigid", "dt against the node spacing of a rigid sheet", make_dt_rigid},
      {"dt_stretch", "dt against a stretch in both directions", make_dt_stretch},
      {"dt_uniaxial", "dt against a stretch in one direction", make_dt_uniaxial},
      {"dt_shear", "dt against a simple shear", make_dt_shear},
      {"dt_bilinear", "dt against a bilinear deformation of the whole sheet", make_dt_bilinear},
      {"dt_crumpled", "dt against jumps of the deformation between elements", make_dt_crumpled},
      {"mechanics_load", "Equilibria against tension and edge load", make_mechanics_load},
      {"mechanics_material", "Equilibria against the stiffness of the sheet", make_mechanics_material},
      {"mechanics_mesh", "Equilibria under fronts sharper than an element", make_mechanics_mesh},
      {"parameters", "Runs with parameters at their ends", make_parameters},
      {"long_runs", "What a million steps leave", make_long_runs},
  };
  return maps;
}

}  // namespace myowave::solver
