#include "solver/run/make_plan.hpp"

#include <fmt/format.h>

#include <Kokkos_Core.hpp>
#include <algorithm>
#include <cmath>
#include <utility>

#include "kernels/elastic/assemble.hpp"
#include "kernels/observe/activation.hpp"
#include "kernels/observe/phase_singularity.hpp"
#include "solver/coupling/electromechanics.hpp"
#include "solver/coupling/select_form.hpp"
#include "solver/excitation/select_model.hpp"

namespace myowave::solver {
namespace {

using Space = Kokkos::DefaultExecutionSpace;

// A View that the host reads has a copy there, unless the host can access it.
constexpr bool one_memory = Kokkos::SpaceAccessibility<Kokkos::HostSpace, Space::memory_space>::accessible;
constexpr std::uint64_t copies = one_memory ? 1 : 2;

std::uint64_t count(std::uint64_t rows, std::uint64_t columns) { return rows * columns; }

// The sizes that determine the memory.
struct Sizes {
  std::uint64_t nodes, real, padded_nodes;
  std::uint64_t elements = 0, element_nodes = 0, element_columns = 0, slots = 0, unknowns = 0;

  explicit Sizes(const Scene& scene)
      : nodes(count(scene.grid.rows, scene.grid.columns)),
        real(scene.precision == Precision::float32 ? sizeof(float) : sizeof(double)),
        padded_nodes(count(scene.grid.rows + 1, scene.grid.columns + 1)) {
    if (!scene.mechanics) return;
    const std::uint64_t cells = scene.mechanics->cells_per_element;
    const std::uint64_t rows = (scene.grid.rows - 1) / cells;
    element_columns = (scene.grid.columns - 1) / cells;
    elements = count(rows, element_columns);
    element_nodes = count(rows + 1, element_columns + 1);
    unknowns = 2 * element_nodes;
    // Lower triangle of the tangent: 3 entries a node and 4 a pair of nodes of one element.
    const std::uint64_t pairs =
        count(rows + 1, element_columns) + count(rows, element_columns + 1) + 2 * elements;
    slots = 3 * element_nodes + 4 * pairs;
  }
};

// Steps on tiles have old and new V, r and Ta; single steps update r and Ta in place.
bool steps_in_tiles(MetricForm form) {
  using Forms = ModelForms<Space, double>;
  return form == MetricForm::expanded
             ? decltype(Forms::Expanded::diffusion)::mirrored_edges
             : decltype(Forms::template Identity<tissue::ForwardEuler>::diffusion)::mirrored_edges &&
                   decltype(Forms::Conservative::diffusion)::mirrored_edges;
}

PlannedPart excitation(const Scene& scene, const Sizes& sizes) {
  const bool tiles = steps_in_tiles(metric_form(scene));
  return {.part = "excitation",
          .active = true,
          .what = fmt::format(
              "Aliev-Panfilov, V and r on {} x {} nodes, {}, {}, dt = {} t.u., {}", scene.grid.rows,
              scene.grid.columns, scene.precision == Precision::float32 ? "float32" : "float64",
              scene.scheme == Scheme::split ? "diffusion and reaction split, second order" : "explicit Euler",
              scene.time.dt, tiles ? "several steps a launch, tile by tile" : "one step a launch"),
          .why = "always",
          .device_bytes = sizes.nodes * (tiles ? 4 : 3) * sizes.real +
                          scene.stimuli.size() * sizeof(tissue::ActiveStimulus)};
}

PlannedPart active_tension(const Scene& scene, const Sizes& sizes) {
  PlannedPart part{.part = "active tension"};
  if (scene.tension.law == TensionLaw::none) {
    part.why = "tension.law = \"none\"";
  } else if (!has_tension(scene)) {
    part.why = "neither a contraction nor an output needs Ta (output.tension = false)";
  } else {
    part.active = true;
    part.what = fmt::format("{} law, in the step of V and r", row_of(scene.tension.law).name);
    part.why = contracts(scene) ? "it contracts the sheet" : "output.tension = true";
    part.device_bytes = sizes.nodes * (steps_in_tiles(metric_form(scene)) ? 2 : 1) * sizes.real;
  }
  return part;
}

PlannedPart diffusion(const Scene& scene, const Sizes& sizes) {
  PlannedPart part{.part = "diffusion", .active = true, .why = "always"};
  const bool split = scene.scheme == Scheme::split;
  const int weights = split ? 5 : 4;
  switch (metric_form(scene)) {
    case MetricForm::none:
      part.what = fmt::format("{}-point stencil of the undeformed sheet", split ? 9 : 5);
      break;
    case MetricForm::conservative:
      part.what = fmt::format("conservative form on the deformed metric, {} weights a node", weights);
      part.device_bytes = weights * sizes.padded_nodes * sizes.real;
      break;
    case MetricForm::expanded:
      part.what = "expanded form (Eq 24) on the deformed metric, 5 coefficients a node";
      part.device_bytes = 5 * sizes.nodes * sizes.real;
      break;
  }
  return part;
}

// The tables of the mesh, and the factor: a band as wide as two rows of nodes, at most 256, or with a
// fill-reducing ordering 31 n log2 n / 4 entries of 12 bytes (planar mesh, George 1973).
std::uint64_t mechanics_tables(const Sizes& sizes) {
  const auto n = static_cast<double>(sizes.unknowns);
  const double band = std::min(256.0, 2.0 * static_cast<double>(sizes.element_columns) + 5);
  const double factor = std::max(8 * n * band, 12 * 31.0 / 4 * n * std::log2(n + 2));
  const std::uint64_t by_slot = 3 * sizeof(int) + 3 * sizeof(double), by_unknown = 2 * sizeof(int) + 8;
  return sizes.slots * by_slot + sizes.unknowns * by_unknown + 36 * sizeof(int) * sizes.elements +
         sizeof(double) * sizes.elements + static_cast<std::uint64_t>(factor);
}

PlannedPart mechanics(const Scene& scene, const Sizes& sizes) {
  if (!scene.mechanics) return {.part = "mechanics", .why = "no [mechanics]: the sheet is rigid"};
  const MechanicsSettings& m = *scene.mechanics;
  const std::string load =
      m.edges == Edges::fixed
          ? "edges fixed"
          : fmt::format("edge load p = {} kN/m ({})", m.p, m.load == Load::follower ? "follower" : "dead");
  const std::string solves =
      m.contraction ? fmt::format("solved every {} steps where a tension has changed", m.interval)
                    : std::string("solved once, without contraction");
  const std::uint64_t vector = 2 * sizeof(double) * sizes.element_nodes;
  const std::uint64_t tension = 4 * sizeof(double) * sizes.elements;
  const std::uint64_t places = sizes.element_nodes + sizes.element_columns + 2;
  return {
      .part = "mechanics",
      .active = true,
      .what = fmt::format("incompressible Mooney-Rivlin membrane, {} x {} bilinear elements, float64, {}, {}",
                          (scene.grid.rows - 1) / m.cells_per_element,
                          (scene.grid.columns - 1) / m.cells_per_element, load, solves),
      .why = "[mechanics]; nodes and areas are output",
      // Nodes that conduction feels, and the tension of the excitation.
      .device_bytes = vector + tension,
      // Their copies; nodes of the last solve and of Newton's iteration, tension and energy; element
      // matrices and their sums.
      .host_bytes = (copies + 6) * vector + (copies + 1) * tension + 3 * sizeof(double) * sizes.elements +
                    elastic::linearization_entries * sizeof(double) * places +
                    elastic::NodalTangent::entries * sizeof(double) * sizes.element_nodes +
                    (sizeof(int) + sizeof(double)) * sizes.slots,
      .other_bytes = mechanics_tables(sizes)};
}

PlannedPart contraction(const Scene& scene) {
  if (contracts(scene)) {
    return {.part = "contraction",
            .active = true,
            .what = "Ta to the Gauss points, 32 bytes an element a solve",
            .why = "mechanics.contraction = true"};
  }
  return {.part = "contraction",
          .why = scene.mechanics ? "mechanics.contraction = false" : "the sheet is rigid"};
}

PlannedPart feedback(const Scene& scene, const Sizes& sizes) {
  PlannedPart part{.part = "feedback"};
  const MetricForm form = metric_form(scene);
  part.active = form != MetricForm::none;
  if (part.active) {
    const std::size_t solves = solves_of_metric(scene);
    part.what = fmt::format(
        "element nodes{} to the metric of the grid, where a node has moved",
        solves > 1 ? fmt::format(", extrapolated from {} solves to the middle of an interval,", solves) : "");
    part.why = solves > 1 ? "feedback.metric, feedback.time" : "feedback.metric";
    if (form == MetricForm::conservative) part.device_bytes = 3 * sizes.padded_nodes * sizes.real;
    // Those of the earlier solves, and where they lead.
    if (solves > 1) part.host_bytes += solves * 2 * sizeof(double) * sizes.element_nodes;
  } else {
    part.why = scene.mechanics ? "feedback.metric = \"none\": conduction ignores the deformation"
                               : "the sheet is rigid";
  }
  return part;
}

PlannedPart substeps(const Scene& scene, const Sizes& sizes) {
  if (scene.on_unstable == OnUnstable::stop)
    return {.part = "substeps",
            .why = "accuracy.on_unstable = \"stop\": a step that is unstable ends the run"};
  return {.part = "substeps",
          .active = true,
          .what = "unstable steps are repeated in substeps, from the state saved before them",
          .why = "accuracy.on_unstable = \"substep\"",
          .device_bytes = sizes.nodes * (has_tension(scene) ? 3 : 2) * sizes.real};
}

PlannedPart tips(const Scene& scene) {
  constexpr std::uint64_t list = first_tips * sizeof(observe::PhaseSingularity) + sizeof(int);
  return {.part = "tips",
          .active = true,
          .what = fmt::format("sampled every {} t.u. for break-up and death, output every {} t.u.",
                              scene.output.watch_every, scene.output.tips_every),
          .why = "always",
          .device_bytes = list,
          .host_bytes = (copies - 1) * list};
}

PlannedPart probes(const Scene& scene, const Sizes& sizes) {
  const std::uint64_t number = scene.output.probes.size();
  if (number == 0) return {.part = "probes", .why = "output.probes is empty"};
  const auto steps = static_cast<std::uint64_t>(std::max(1.0, scene.output.watch_every / scene.time.dt));
  const std::uint64_t records = number * (steps + 3) * sizes.real;
  return {.part = "probes",
          .active = true,
          .what = fmt::format("{} nodes, V at each step for the periods, {} every {} t.u.", number,
                              has_tension(scene) ? "V, r and Ta" : "V and r", scene.output.probes_every),
          .why = "output.probes",
          .device_bytes = records + number * sizeof(std::int64_t),
          .host_bytes = (copies - 1) * records,
          .other_bytes = number * steps * sizeof(double)};
}

PlannedPart maps(const Scene& scene, const Sizes& sizes) {
  if (!scene.output.maps) return {.part = "maps", .why = "output.maps = false"};
  return {.part = "maps",
          .active = true,
          .what = fmt::format("activation, period and APD of each node, V sampled every {} t.u.",
                              ActivationMaps::sample_every),
          .why = "output.maps = true",
          .device_bytes = sizes.nodes * (sizeof(float) + sizeof(observe::ActivationRecord)),
          // A copy, six numbers and a count of each node, when the run ends.
          .host_bytes = (copies - 1) * sizes.nodes * sizeof(observe::ActivationRecord),
          .other_bytes = sizes.nodes * (6 * sizeof(double) + sizeof(int))};
}

std::vector<PlannedPart> outputs(const Scene& scene, const Sizes& sizes) {
  const auto output = [](const char* part, bool active, std::string what, std::string why) {
    return PlannedPart{
        .part = part, .active = active, .what = active ? std::move(what) : "", .why = std::move(why)};
  };
  const std::string every =
      fmt::format("every {} t.u.{}", scene.output.every,
                  scene.output.from > 0 ? fmt::format(" from {} t.u. on", scene.output.from) : "");
  const char* each = scene.output.element_areas ? " and each of them" : "";
  return {
      output("areas", scene.mechanics.has_value(), fmt::format("of the elements{}, output {}", each, every),
             scene.mechanics ? "[mechanics]" : "the sheet is rigid"),
      output("fields", scene.output.fields,
             fmt::format("V, r{}{} {}", has_tension(scene) ? ", Ta" : "", scene.mechanics ? ", nodes" : "",
                         every),
             fmt::format("output.fields = {}", scene.output.fields)),
      output("frames", scene.output.frames, fmt::format("PNG pictures {}", every),
             fmt::format("output.frames = {}", scene.output.frames)),
      {.part = "state on the host",
       .active = true,
       .what = "V, r and Ta in float64, at the start, for output and at the end",
       .why = "always",
       .host_bytes = (copies - 1) * sizes.nodes * sizes.real,  // one of them at a time
       .other_bytes = 3 * sizeof(double) * sizes.nodes}};
}

PlannedPart precondition(const Precondition& p) {
  return {.part = "precondition",
          .active = true,
          .what = fmt::format("{} t.u. at mu1 = {}, b = {}, {} contraction, unobserved", p.duration,
                              p.excitation.mu1, p.excitation.b, p.contraction ? "with" : "without"),
          .why = "[[initial.precondition]]"};
}

}  // namespace

Plan make_plan(const Scene& scene) {
  const Sizes sizes(scene);
  const PlannedPart V_and_r = excitation(scene, sizes), Ta = active_tension(scene, sizes),
                    stencil = diffusion(scene, sizes), metric = feedback(scene, sizes);
  const auto nodes = static_cast<double>(sizes.nodes);
  Plan plan{{V_and_r, Ta, stencil, mechanics(scene, sizes), contraction(scene), metric,
             substeps(scene, sizes), tips(scene), probes(scene, sizes), maps(scene, sizes)},
            static_cast<double>(V_and_r.device_bytes + Ta.device_bytes) / nodes,
            static_cast<double>(stencil.device_bytes + metric.device_bytes) / nodes};
  for (auto& part : outputs(scene, sizes)) plan.parts.push_back(std::move(part));
  for (const auto& one : scene.initial.preconditions) plan.parts.push_back(precondition(one));
  return plan;
}

std::vector<SpaceBytes> views_of(const Plan& plan) {
  std::uint64_t host = 0;
  for (const auto& part : plan.parts) host += part.host_bytes;
  const std::string name = Space::memory_space::name();
  if (one_memory) return {{name, plan.device_bytes() + host}};
  return {{name, plan.device_bytes()}, {Kokkos::HostSpace::name(), host}};
}

bool has_device_memory() { return !one_memory; }

}  // namespace myowave::solver
