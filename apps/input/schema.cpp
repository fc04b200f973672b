// The table of keys: sections, keys, units, ranges, places in a Scene, meaning.
#include "apps/input/schema.hpp"

#include <algorithm>
#include <cmath>

#include "apps/input/key_kinds.hpp"
#include "apps/input/presets.hpp"

namespace myowave::apps {
namespace {

using namespace kinds;

// A Target's references are to what the caller may change, so one accessor reads and writes.
#define MYOWAVE_AT(place) \
  [](const Target& target) -> auto& { return target.place; }

std::vector<Section> tissue_sections() {
  // More nodes along a side than any machine holds; the bytes of such a sheet fit 64 bits.
  constexpr double most_nodes = 1e7;
  using Rates = cell::ActiveTensionParameters<double>;
  return {
      {"grid",
       "The sheet: a rectangle of nodes, row i at X2 = i dx, column j at X1 = j dx.",
       {{"n", "", Size{{.low = 2, .high = most_nodes}}, "Nodes along both sides, or [rows, columns].", "251"},
        {"dx", "length units", number(MYOWAVE_AT(scene.grid.dx), positive),
         "Node spacing. The paper's 0.6 makes waves 3.4 % slow; 0.3 with dt = 0.01 makes them 1.8 % slow."}}},
      {"time",
       "Step, length and display of time. 1 t.u. is 10 ms: a spiral turns in 26.9 t.u., 269 ms in the paper.",
       {{"dt", "t.u.", number(MYOWAVE_AT(scene.time.dt), positive),
         "Step of the excitation. A run refuses a step past the stability bound of its metric."},
        {"t_end", "t.u.", number(MYOWAVE_AT(scene.time.t_end), not_negative), "End of the run."},
        {"ms_per_tu", "ms", number(MYOWAVE_AT(scene.time.ms_per_tu), positive),
         "Milliseconds in one t.u., for display only."},
        {"stop_on", "", stop_on(),
         "The run ends before t_end at the first of these: `breakup`, once it has lasted for 2 t.u.; `death` "
         "of "
         "all activity, with no stimulus to come."}}},
      {"excitation",
       "Aliev-Panfilov kinetics and diffusion (Eqs 22a, b; Table 1).",
       {{"a", "", number(MYOWAVE_AT(excitation.a), {.low = 0, .high = 1}), "Excitation threshold."},
        {"b", "", number(MYOWAVE_AT(excitation.b), any),
         "Shape of the recovery equation. Table 1 omits it; 0.1 gives the paper's periods and turbulence."},
        {"k", "1/t.u.", number(MYOWAVE_AT(excitation.k), not_negative), "Rate of the fast current."},
        {"eps", "1/t.u.", number(MYOWAVE_AT(excitation.eps), not_negative), "Recovery rate at rest."},
        {"mu1", "1/t.u.", number(MYOWAVE_AT(excitation.mu1), not_negative),
         "Recovery rate in activity. 0.12: one spiral; 0.07: turbulence."},
        {"mu2", "", number(MYOWAVE_AT(excitation.mu2), positive), "V at which the recovery rate halves."},
        {"C_m", "", number(MYOWAVE_AT(excitation.C_m), positive), "Membrane capacitance."},
        {"D", "length^2/t.u.", number(MYOWAVE_AT(excitation.D), not_negative), "Diffusion coefficient."}}},
      {"tension",
       "Active tension (Eqs 22c, 23): Ta relaxes to k_Ta V at the rate eps_below or eps_above.",
       {{"law", "", tension_law(),
         "Rates below and above the threshold: `delayed` 1 and 0.1 (Fig 2a), `printed` 1 and 10 (Eq 23). "
         "`none`: "
         "Ta is not computed and stays 0."},
        {"eps0", "", tension_eps0(), "Factor on both rates of the law.", "1"},
        {"k_Ta", "kPa", number(MYOWAVE_AT(tension.k_Ta), not_negative),
         "Tension at V = 1. Above 60 the sheet can lose ellipticity."},
        {"eps_below", "1/t.u.", tension_rate(&Rates::eps_below, &solver::TensionSettings::eps_below),
         "Rate where V < threshold, in place of the law's.", "the law's"},
        {"eps_above", "1/t.u.", tension_rate(&Rates::eps_above, &solver::TensionSettings::eps_above),
         "Rate where V >= threshold, in place of the law's.", "the law's"},
        {"threshold", "", number(MYOWAVE_AT(tension.threshold), any), "V at which the rate changes."}}},
  };
}

std::vector<Section> mechanics_sections() {
  return {
      {"mechanics",
       "The elastic sheet. Without this section the sheet is rigid.",
       {{"on", "", Flag{[](const Target& target) { return target.scene.mechanics.has_value(); }, nullptr},
         "`false` makes the sheet rigid whatever else stands here.", "true where the section is given"},
        {"cells_per_element", "",
         integer(MYOWAVE_AT(scene.mechanics->cells_per_element), {.low = 1, .high = largest_int}),
         "Grid cells along the side of an element; divides rows - 1 and columns - 1."},
        {"c1", "kPa", number(MYOWAVE_AT(scene.mechanics->c1), not_negative), "Mooney-Rivlin constant of I1."},
        {"c2", "kPa", number(MYOWAVE_AT(scene.mechanics->c2), not_negative), "Mooney-Rivlin constant of I2."},
        {"load", "", choice({"follower", "dead"}, MYOWAVE_AT(scene.mechanics->load)),
         "Edge load per deformed length along the moving normal, or per undeformed length and fixed."},
        {"p", "kN/m", number(MYOWAVE_AT(scene.mechanics->p), any),
         "Edge load; positive stretches the sheet."},
        {"edges", "", choice({"load", "fixed"}, MYOWAVE_AT(scene.mechanics->edges)),
         "The edges carry the load, or are held in place."},
        {"interval", "steps", integer(MYOWAVE_AT(scene.mechanics->interval), {.low = 1, .high = largest_int}),
         "Steps from one solve of the mechanics to the next. With a metric that is held between them 80 is "
         "three to four times as far off as 20."},
        {"tolerance", "",
         number(MYOWAVE_AT(scene.mechanics->tolerance), {.low = 0, .high = 0.01, .low_open = true}),
         "Newton stops when the largest free residual is below this times 10 kPa times the element side."},
        {"contraction", "", flag(MYOWAVE_AT(scene.mechanics->contraction)),
         "`false`: the tension does not load the sheet."}}},
      {"feedback",
       "How the deformation acts on conduction. No effect in a rigid run.",
       {{"metric", "", choice({"none", "conservative", "expanded"}, MYOWAVE_AT(scene.metric)),
         "`conservative`: fluxes on the deformed sheet; `expanded`: Eq 24 as printed, to compare with the "
         "paper; "
         "`none`: conduction ignores the deformation."},
        {"time", "", choice({"held", "linear", "quadratic"}, MYOWAVE_AT(scene.metric_time)),
         "Whose deformation an interval feels: `held`: the last solve's; `linear`, `quadratic`: extrapolated "
         "from the last two or three to its middle. Interval 40 quadratic is three times closer than 10 "
         "held."}}},
  };
}

std::vector<Section> initial_sections() {
  return {
      {"initial",
       "The state at t = 0.",
       {{"type", "",
         choice({"rest", "broken_front", "settled_spiral", "file"}, MYOWAVE_AT(scene.initial.type)),
         "`rest`; `broken_front`: a front that ends in the middle and curls; `settled_spiral`: one spiral "
         "after "
         "1080 t.u., computed once and cached; `file`: V, r and, where there, Ta of an HDF5 file."},
        {"dx", "length units", number(MYOWAVE_AT(scene.initial.dx), not_negative),
         "Node spacing of the grid that the start is made on and interpolated from, in whose nodes the keys "
         "of "
         "this section are; it divides the sides of the sheet. 0: grid.dx."},
        {.name = "width",
         .unit = "nodes",
         .kind = number(MYOWAVE_AT(scene.initial.width), {.low = 1}),
         .doc = "Width of the front, V = 1.",
         .only_type = "broken_front"},
        {.name = "r0",
         .unit = "",
         .kind = number(MYOWAVE_AT(scene.initial.r0), not_negative),
         .doc = "r behind the front.",
         .only_type = "broken_front"},
        {.name = "offset",
         .unit = "nodes",
         .kind = pair("[columns, rows]", MYOWAVE_AT(scene.initial.offset),
                      {.low = -largest_int, .high = largest_int}),
         .doc = "End of the front, from the middle of the sheet.",
         .only_type = "broken_front"},
        {.name = "core_offset",
         .unit = "nodes",
         .kind = pair("[columns, rows]", MYOWAVE_AT(scene.initial.core_offset),
                      {.low = -largest_int, .high = largest_int}),
         .doc = "Core of the spiral, from the middle of the sheet.",
         .only_type = "settled_spiral"},
        {.name = "file",
         .unit = "",
         .kind = Path{[](const Target& target) { return target.scene.initial.file; },
                      [](Target& target, const std::string& value) { target.scene.initial.file = value; }},
         .doc = "HDF5 file; its last frame is read. Relative to the scene file, or to the working directory "
                "where given by --set.",
         .default_text = "required by type = \"file\"",
         .only_type = "file"},
        {.name = "window",
         .unit = "nodes",
         .kind = window(),
         .doc = "First node of the part of a larger sheet that is taken.",
         .default_text = "the whole sheet",
         .only_type = "file"},
        {"noise", "", number(MYOWAVE_AT(scene.initial.noise), not_negative),
         "Standard deviation of what is added to V at each node."},
        {"seed", "", integer(MYOWAVE_AT(scene.initial.seed), {.low = 0}), "Seed of the noise."}}},
  };
}

std::vector<Section> protocol_sections() {
  return {
      {.name = "initial.precondition",
       .doc =
           "Runs before the scene, in order, on the same sheet; then t := 0 and the scene's own values hold. "
           "One table or several. What a table does not name is as in the scene.",
       .keys = {{.name = "duration",
                 .unit = "t.u.",
                 .kind = number(MYOWAVE_AT(precondition->duration), positive),
                 .doc = "How long it runs.",
                 .default_text = "required",
                 .required = true},
                {"contraction", "", flag(MYOWAVE_AT(precondition->contraction)),
                 "`true`: the mechanics and its feedback are on too."}},
       .repeated = true,
       .inherits = {"excitation", "tension"}},
      {.name = "stimulus",
       .doc = "Currents I_s: pulse m lasts from start + m period up to, not including, that + duration.",
       .keys =
           {{"start", "t.u.", number(MYOWAVE_AT(stimulus->start), not_negative), "Begin of the first pulse."},
            {"period", "t.u.", number(MYOWAVE_AT(stimulus->period), not_negative),
             "From one pulse to the next; 0: one pulse."},
            {"duration", "t.u.", number(MYOWAVE_AT(stimulus->duration), positive), "Length of a pulse."},
            {.name = "amplitude",
             .unit = "1/t.u.",
             .kind = number(MYOWAVE_AT(stimulus->amplitude), any),
             .doc = "I_s during a pulse. Uniform pacing needs 0.3 for 1 t.u.; 0.5 is safe.",
             .default_text = "required",
             .required = true},
            {"count", "", integer(MYOWAVE_AT(stimulus->count), {.low = -1}),
             "Number of pulses; -1: without end.", "-1 with a period, else 1"},
            {"region", "", Region{},
             "Nodes that are stimulated: a disc (radius in node spacings, the edge included), a block (first "
             "and last node, both included; the one left out is the whole side) or all.",
             "\"all\""}},
       .repeated = true},
  };
}

std::vector<Section> accuracy_sections() {
  static const std::string preset_doc =
      "Accuracy by one word: it sets the values below. What the scene names itself stays; a preset given by "
      "--set changes it. " +
      presets_text() + ". Errors and costs: `myowave help accuracy`.";
  return {
      {"accuracy",
       "What the numbers are kept in, what happens where they go wrong, and what counts as zero.",
       {{"preset", "", preset(), preset_doc},
        {"dx", "length units", number(MYOWAVE_AT(scene.dx), not_negative),
         "The run takes the largest node spacing up to this that divides the elements, or the sides of a "
         "rigid "
         "sheet. What the scene counts in nodes is on the grid of grid.dx all the same. 0: grid.dx."},
        {"precision", "", choice({"float64", "float32"}, MYOWAVE_AT(scene.precision)),
         "Of V, r and Ta. The mechanics is always float64."},
        {"scheme", "", choice({"euler", "split"}, MYOWAVE_AT(scene.scheme)),
         "`euler`: the paper's explicit step with the five-point stencil; `split`: diffusion and reaction "
         "one "
         "after the other, of second order in time, with a nine-point stencil. At dt = dx^2 / (6 D) its "
         "error "
         "in the wave speed is at least 16 times smaller at a third of the steps. Not with feedback.metric = "
         "\"expanded\"."},
        {"on_unstable", "", choice({"stop", "substep"}, MYOWAVE_AT(scene.on_unstable)),
         "Where a step is past the bound of the deformed metric, or what it gives is noise, out of range or "
         "not "
         "finite: `stop`: the run ends there, with exit status 3; `substep`: it goes back and divides dt, "
         "and "
         "says how often. A dt past the bound of the undeformed sheet is refused in both."}},
       false,
       {},
       preset_notes()},
  };
}

std::vector<Section> output_sections() {
  return {
      {"output",
       "What is written, besides summary.json, manifest.json, tips.csv, trajectories.csv, sources.csv, "
       "area.csv, probes.csv and beats.csv.",
       {{"every", "t.u.", output_every(),
         "Fields, frames and areas: at t = 0, its multiples and t_end. A multiple of dt.",
         "1, or the multiple of dt nearest to it"},
        {"tips_every", "t.u.", number(MYOWAVE_AT(scene.output.tips_every), positive),
         "Tips. A multiple of dt.", "every"},
        {"probes_every", "t.u.", number(MYOWAVE_AT(scene.output.probes_every), positive),
         "Probes. A multiple of dt.", "every"},
        {"watch_every", "t.u.",
         number(MYOWAVE_AT(scene.output.watch_every), {.low = 0, .high = 1, .low_open = true}),
         "Break-up, death and the paths of tips are watched at the nearest multiple of dt, whatever is "
         "shown."},
        {"from", "t.u.", number(MYOWAVE_AT(scene.output.from), not_negative),
         "What `every` says is shown from here on, and at t_end."},
        {"frames", "", flag(MYOWAVE_AT(scene.output.frames)), "PNG pictures of V on the deformed sheet."},
        {"fields", "", flag(MYOWAVE_AT(scene.output.fields)),
         "fields.h5 with V, r, Ta and nodes, and its .xdmf."},
        {"element_areas", "", flag(MYOWAVE_AT(scene.output.element_areas)),
         "element_areas.csv, the area of each element. No effect in a rigid run."},
        {"maps", "", flag(MYOWAVE_AT(scene.output.maps)),
         "maps.h5 with activation, period, APD and conduction velocity of each node."},
        {"tension", "", flag(MYOWAVE_AT(scene.output.tension)),
         "`false`: Ta is computed only where it contracts the sheet. A contracting run that starts from "
         "fields.h5 needs it there.",
         "true with [mechanics] or fields = true"},
        {"probes", "", Probes{}, "Nodes whose V, r and Ta go to probes.csv, and whose beats to beats.csv.",
         "the four nodes a quarter of a side from the corners"},
        {"period_from", "t.u.", number(MYOWAVE_AT(scene.output.period_from), not_negative),
         "The means of the beats count from the upstrokes at or after this time."},
        {"checkpoint_every", "t.u.", number(MYOWAVE_AT(scene.output.checkpoint_every), not_negative),
         "Time between checkpoints, from which `myowave run --resume` goes on; 0: only one where the run is "
         "asked "
         "to stop."}}},
  };
}

// Within a section, keys take effect in this order: tension.law before eps0 before eps_below and
// eps_above, output.every before the two that follow it.
std::vector<Section> make_schema() {
  std::vector<Section> all;
  for (const auto& part : {tissue_sections(), mechanics_sections(), initial_sections(), protocol_sections(),
                           accuracy_sections(), output_sections()})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

#undef MYOWAVE_AT

}  // namespace

Target::Target(solver::Scene& whole) : scene(whole), excitation(whole.excitation), tension(whole.tension) {}

Target::Target(solver::Scene& whole, solver::Stimulus& one) : Target(whole) { stimulus = &one; }

Target::Target(solver::Scene& whole, solver::Precondition& one)
    : scene(whole), excitation(one.excitation), tension(one.tension), precondition(&one) {}

bool Range::contains(double value) const { return (low_open ? value > low : value >= low) && value <= high; }

bool Range::bounded() const { return std::isfinite(low) || std::isfinite(high); }

const std::vector<Section>& schema() {
  static const std::vector<Section> table = make_schema();
  return table;
}

const Section* find_section(std::string_view name) {
  const auto found = std::ranges::find(schema(), name, &Section::name);
  return found == schema().end() ? nullptr : &*found;
}

const Key* find_key(const Section& section, std::string_view name) {
  const auto found = std::ranges::find(section.keys, name, &Key::name);
  if (found != section.keys.end()) return &*found;
  for (std::string_view other : section.inherits) {
    if (const Key* key = find_key(*find_section(other), name)) return key;
  }
  return nullptr;
}

}  // namespace myowave::apps
