#include "solver/run/stages.hpp"

#include "solver/base/error.hpp"
#include "solver/excitation/stability.hpp"

namespace myowave::solver {
namespace {

Scene precondition_scene(const Scene& scene, const Precondition& precondition) {
  Scene stage = scene;
  stage.excitation = precondition.excitation;
  stage.tension = precondition.tension;
  stage.time.t_end = precondition.duration;
  stage.stimuli.clear();
  stage.output.probes.clear();
  stage.output.maps = false;
  if (!precondition.contraction)
    stage.mechanics.reset();
  else if (stage.mechanics)
    stage.mechanics->contraction = true;
  else
    throw InputError("initial.precondition: contraction = true needs a [mechanics] section");
  return stage;
}

}  // namespace

std::vector<Scene> stages_of(const Scene& scene) {
  std::vector<Scene> stages;
  for (const auto& precondition : scene.initial.preconditions)
    stages.push_back(precondition_scene(scene, precondition));
  stages.push_back(scene);
  // Ta is part of the state that a later stage starts from.
  for (std::size_t n = stages.size() - 1; n-- > 0;) stages[n].output.tension = has_tension(stages[n + 1]);
  return stages;
}

void require_stable_step(const Scene& scene) {
  require_stable(scene, "");
  for (const auto& precondition : scene.initial.preconditions)
    require_stable(precondition_scene(scene, precondition), " during a precondition");
}

}  // namespace myowave::solver
