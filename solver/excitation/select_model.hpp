// The pointwise model of a scene as a compile-time kernel variant. solver/coupling/select_form.hpp selects
// the form of diffusion.
#pragma once

#include <type_traits>

#include "kernels/cell/active_tension.hpp"
#include "kernels/cell/aliev_panfilov.hpp"
#include "kernels/tissue/monodomain_step.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::solver {

template <class Real, class Scheme = tissue::ForwardEuler>
using Model = tissue::MonodomainModel<cell::AlievPanfilov<Real>, cell::ActiveTension<Real>, Scheme>;

// Without Ta.
template <class Real, class Scheme = tissue::ForwardEuler>
using ModelWithoutTension = tissue::MonodomainModel<cell::AlievPanfilov<Real>, cell::NoTension, Scheme>;

// The stencil that suits a scheme: their errors cancel.
template <class Scheme>
inline constexpr tissue::Stencil stencil_of =
    std::is_same_v<Scheme, tissue::SplitStep> ? tissue::Stencil::nine_point : tissue::Stencil::five_point;

template <class Real>
Model<Real> make_model(const ExcitationSettings& excitation, const TensionSettings& tension) {
  return {{excitation.cast<Real>()},
          {tension_parameters(tension).cast<Real>()},
          Real(excitation.D),
          Real(1 / excitation.C_m)};
}

// The same model with another scheme.
template <class Scheme, class Real>
Model<Real, Scheme> in_scheme(const Model<Real>& model) {
  return {model.cell, model.tension, model.D, model.inverse_C_m};
}
template <class Scheme, class Real>
ModelWithoutTension<Real, Scheme> without_tension(const Model<Real>& model) {
  return {model.cell, {}, model.D, model.inverse_C_m};
}

// Calls action(model) with the model for a scheme, with Ta or without.
template <class Scheme, class Real, class Action>
void with_model(const Scene& scene, const Model<Real>& model, const Action& action) {
  if (has_tension(scene))
    action(in_scheme<Scheme>(model));
  else
    action(without_tension<Scheme>(model));
}

}  // namespace myowave::solver
