#include "apps/input/schema.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <numeric>
#include <type_traits>

#include "apps/input/presets.hpp"
#include "solver/base/error.hpp"

namespace myowave::apps {

Target::Target(solver::Scene& whole) : scene(whole), excitation(whole.excitation), tension(whole.tension) {}

Target::Target(solver::Scene& whole, solver::Stimulus& one) : Target(whole) { stimulus = &one; }

Target::Target(solver::Scene& whole, solver::Precondition& one)
    : scene(whole), excitation(one.excitation), tension(one.tension), precondition(&one) {}

bool Range::contains(double value) const { return (low_open ? value > low : value >= low) && value <= high; }

bool Range::bounded() const { return std::isfinite(low) || std::isfinite(high); }

std::string Range::text() const {
  if (!bounded()) return "finite";
  if (!std::isfinite(high)) return fmt::format("{} {}", low_open ? ">" : ">=", low);
  if (!std::isfinite(low)) return fmt::format("<= {}", high);
  return low_open ? fmt::format("> {} and <= {}", low, high) : fmt::format("{} to {}", low, high);
}

namespace {

constexpr Range any{};
constexpr Range positive{.low = 0, .low_open = true};
constexpr Range not_negative{.low = 0};
constexpr double largest_int = std::numeric_limits<int>::max();

// `at` names the place of the value, for reading and for writing.
template <class At>
Number number(At at, Range range) {
  return {at, [at](Target& target, double value) { at(target) = value; }, range};
}

template <class At>
Integer integer(At at, Range range) {
  using Stored = std::remove_cvref_t<std::invoke_result_t<At, const Target&>>;
  return {[at](const Target& target) { return static_cast<std::int64_t>(at(target)); },
          [at](Target& target, std::int64_t value) { at(target) = static_cast<Stored>(value); }, range};
}

template <class At>
Flag flag(At at) {
  return {at, [at](Target& target, bool value) { at(target) = value; }};
}

// `names` in the order of the enumerators.
template <class At>
Choice choice(std::vector<std::string_view> names, At at) {
  using Enum = std::remove_cvref_t<std::invoke_result_t<At, const Target&>>;
  return {std::move(names), [at](const Target& target) { return static_cast<std::size_t>(at(target)); },
          [at](Target& target, std::size_t value) { at(target) = static_cast<Enum>(value); }};
}

Choice tension_law() {
  Choice law;
  for (const solver::NamedTensionLaw& one : solver::tension_laws) law.names.push_back(one.name);
  law.get = [](const Target& target) { return static_cast<std::size_t>(target.tension.law); };
  law.set = [](Target& target, std::size_t index) {
    target.tension.law = static_cast<solver::TensionLaw>(index);
    target.tension.eps_below.reset();
    target.tension.eps_above.reset();
  };
  return law;
}

Choice preset() {
  Choice choice{{},
                [](const Target& target) -> std::size_t {
                  const Preset* one = find_preset(target.scene.preset);
                  return one == nullptr ? 0 : one - presets().data();
                },
                [](Target& target, std::size_t index) { target.scene.preset = presets()[index].name; }};
  for (const Preset& one : presets()) choice.names.push_back(one.name);
  return choice;
}

std::vector<Note> preset_notes() {
  std::vector<Note> notes;
  for (const Preset& one : presets())
    if (!one.values.empty()) notes.push_back({std::string(one.name), values_text(one)});
  return notes;
}

Choices stop_on() {
  return {{"breakup", "death"},
          [](const Target& target) {
            const solver::StopOn& on = target.scene.time.stop_on;
            return std::vector<bool>{on.breakup, on.death};
          },
          [](Target& target, const std::vector<bool>& on) {
            target.scene.time.stop_on = {on[0], on[1]};
          }};
}

Number tension_eps0() {
  const auto multiply_both = [](Target& target, double eps0) {
    const auto rates = solver::tension_parameters(target.tension);
    target.tension.eps_below = rates.eps_below * eps0;
    target.tension.eps_above = rates.eps_above * eps0;
  };
  return {nullptr, multiply_both, positive};
}

// In place of the law's, which is in force where the key is not given.
Number tension_rate(double cell::ActiveTensionParameters<double>::*rate,
                    std::optional<double> solver::TensionSettings::*own) {
  return {[rate](const Target& target) { return solver::tension_parameters(target.tension).*rate; },
          [own](Target& target, double value) { target.tension.*own = value; }, not_negative};
}

Number output_every() {
  const auto set_all = [](Target& target, double every) {
    target.scene.output.every = target.scene.output.tips_every = target.scene.output.probes_every = every;
  };
  return {[](const Target& target) { return target.scene.output.every; }, set_all, positive};
}

template <class At>
Pair pair(std::string_view parts, At at, Range range) {
  return {parts, at, [at](Target& target, std::array<int, 2> value) { at(target) = value; }, range};
}

Pair window() {
  return {"[row0, column0]",
          [](const Target& target) {
            return target.scene.initial.window.value_or(std::array{0, 0});
          },
          [](Target& target, std::array<int, 2> value) { target.scene.initial.window = value; },
          {.low = 0, .high = largest_int}};
}

// A Target's references are to what the caller may change, so one accessor reads and writes.
#define MYOWAVE_AT(place) \
  [](const Target& target) -> auto& { return target.place; }

// Within a section, keys take effect in this order: tension.law before eps0 before eps_below and
// eps_above, output.every before the two that follow it.
std::vector<Section> make_schema() {
  // More nodes along a side than any machine holds; the bytes of such a sheet fit 64 bits.
  constexpr double most_nodes = 1e7;
  static const std::string preset_doc =
      "Accuracy by one word: it sets the values below. What the scene names itself stays; a preset given by "
      "--set changes it. " +
      presets_text() + ". Errors and costs: `myowave help accuracy`.";
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

#undef MYOWAVE_AT

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};

nlohmann::json region_json(const solver::Stimulus& stimulus) {
  switch (stimulus.shape) {
    case solver::Stimulus::Shape::disc:
      return {{"center", stimulus.center}, {"radius", stimulus.radius}};
    case solver::Stimulus::Shape::block:
      return {{"columns", stimulus.columns}, {"rows", stimulus.rows}};
    case solver::Stimulus::Shape::all:
      break;
  }
  return "all";
}

// The value in force, null for a key that only acts on others.
nlohmann::json value_of(const Key& key, const Target& target) {
  return std::visit(Overloaded{
                        [&](const Choice& kind) -> nlohmann::json { return kind.names[kind.get(target)]; },
                        [&](const Choices& kind) -> nlohmann::json {
                          nlohmann::json chosen = nlohmann::json::array();
                          const auto flags = kind.get(target);
                          for (std::size_t n = 0; n < flags.size(); ++n)
                            if (flags[n]) chosen.push_back(kind.names[n]);
                          return chosen;
                        },
                        [&](const Size&) -> nlohmann::json {
                          return {target.scene.grid.rows, target.scene.grid.columns};
                        },
                        [&](const Probes&) -> nlohmann::json { return target.scene.output.probes; },
                        [&](const Region&) -> nlohmann::json { return region_json(*target.stimulus); },
                        [&](const auto& kind) -> nlohmann::json {
                          return kind.get ? nlohmann::json(kind.get(target)) : nlohmann::json();
                        },
                    },
                    key.kind);
}

nlohmann::json values_of(const Section& section, const Target& target) {
  nlohmann::json values = nlohmann::json::object();
  const auto type = value_of(*find_key(*find_section("initial"), "type"), target).get<std::string>();
  for (std::string_view other : section.inherits) values.update(values_of(*find_section(other), target));
  for (const Key& key : section.keys) {
    if (!key.only_type.empty() && key.only_type != type) continue;
    if (key.name == "window" && !target.scene.initial.window) continue;
    nlohmann::json value = value_of(key, target);
    if (!value.is_null()) values[std::string(key.name)] = std::move(value);
  }
  return values;
}

// Text wrapped at `width`, every line after the first indented.
std::string wrapped(std::string_view text, std::size_t indent, std::size_t width) {
  std::string result;
  std::size_t column = indent;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(word.size() + 1, text.size()));
    if (column > indent && column + word.size() + 1 > width) {
      result += '\n' + std::string(indent, ' ');
      column = indent;
    }
    if (column > indent) {
      result += ' ';
      ++column;
    }
    result += word;
    column += word.size();
  }
  return result;
}

std::string header_text(const Section& section) {
  return section.repeated ? fmt::format("[[{}]]", section.name) : fmt::format("[{}]", section.name);
}

std::string inherited_text(const Section& section) {
  return fmt::format("Also every key of [{}] by its bare name; what is not named is as in the scene.",
                     fmt::join(section.inherits, "] and ["));
}

std::string describe_section(const Section& section) {
  std::string text = fmt::format("{}\n  {}\n", header_text(section), wrapped(section.doc, 2, 100));
  for (const Key& key : section.keys) {
    std::string facts = type_text(key.kind);
    if (const std::string range = range_text(key.kind); !range.empty()) facts += ", " + range;
    if (!key.unit.empty()) facts += fmt::format(", in {}", key.unit);
    const std::string value = default_text(key);
    facts += key.required ? ", required" : fmt::format(", default {}", value);
    if (!key.only_type.empty()) facts += fmt::format(", only with type = \"{}\"", key.only_type);
    text += fmt::format("  {:<19}{}\n{:21}{}\n", key.name, wrapped(facts, 21, 100), "",
                        wrapped(key.doc, 21, 100));
  }
  if (!section.inherits.empty()) text += fmt::format("  {}\n", inherited_text(section));
  for (const auto& [name, note] : section.notes)
    text += fmt::format("  {:<19}{}\n", name, wrapped(note, 21, 100));
  return text;
}

}  // namespace

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

std::string type_text(const Kind& kind) {
  return std::visit(
      Overloaded{
          [](const Number&) -> std::string { return "number"; },
          [](const Integer&) -> std::string { return "integer"; },
          [](const Flag&) -> std::string { return "true or false"; },
          [](const Choice& one) { return fmt::format("\"{}\"", fmt::join(one.names, "\" or \"")); },
          [](const Choices& one) { return fmt::format("list of \"{}\"", fmt::join(one.names, "\", \"")); },
          [](const Path&) -> std::string { return "path"; },
          [](const Pair& one) { return fmt::format("{}, two integers", one.parts); },
          [](const Size&) -> std::string { return "integer or [rows, columns]"; },
          [](const Probes&) -> std::string { return "list of [row, column]"; },
          [](const Region&) -> std::string {
            return "\"all\", {center = [column, row], radius = R} or {columns = [a, b], rows = [a, b]}";
          },
      },
      kind);
}

std::string range_text(const Kind& kind) {
  const Range* range = nullptr;
  std::visit(
      [&](const auto& one) {
        if constexpr (requires { one.range; }) range = &one.range;
      },
      kind);
  if (range == nullptr) return "";
  // A bound that is only the width of an int says nothing to a reader.
  Range shown = *range;
  if (shown.high >= largest_int) shown.high = any.high;
  if (shown.low <= -largest_int) shown.low = any.low;
  return shown.bounded() ? shown.text() : "";
}

std::string default_text(const Key& key) {
  if (!key.default_text.empty()) return std::string(key.default_text);
  solver::Scene scene;
  scene.mechanics.emplace();
  solver::Stimulus stimulus;
  solver::Precondition precondition;
  Target target(scene);
  target.stimulus = &stimulus;
  target.precondition = &precondition;
  const nlohmann::json value = value_of(key, target);
  return value.is_number_float() ? fmt::format("{}", value.get<double>()) : value.dump();
}

std::string describe(std::string_view name) {
  if (name.empty()) {
    std::string text;
    for (const Section& section : schema()) text += (text.empty() ? "" : "\n") + describe_section(section);
    return text;
  }
  if (const Section* section = find_section(name)) return describe_section(*section);
  std::vector<std::string_view> names;
  for (const Section& section : schema()) names.push_back(section.name);
  const std::string meant = did_you_mean(name, names);
  throw solver::InputError(fmt::format("there is no section [{}]{} Sections: {}", name,
                                       meant.empty() ? "." : fmt::format("; did you mean \"{}\"?", meant),
                                       fmt::join(names, ", ")));
}

std::string describe_markdown() {
  std::string text;
  for (const Section& section : schema()) {
    text += fmt::format("### `{}`\n\n{}\n\n", header_text(section), section.doc);
    text += "| key | type and range | unit | default | meaning |\n|---|---|---|---|---|\n";
    for (const Key& key : section.keys) {
      std::string type = type_text(key.kind);
      if (const std::string range = range_text(key.kind); !range.empty()) type += ", " + range;
      std::string doc(key.doc);
      if (!key.only_type.empty()) doc += fmt::format(" Only with `type = \"{}\"`.", key.only_type);
      text += fmt::format("| `{}` | {} | {} | {} | {} |\n", key.name, type, key.unit, default_text(key), doc);
    }
    if (!section.inherits.empty()) text += fmt::format("\n{}\n", inherited_text(section));
    if (!section.notes.empty()) text += '\n';
    for (const auto& [name, note] : section.notes) text += fmt::format("- `{}`: {}\n", name, note);
    text += '\n';
  }
  return text;
}

nlohmann::json effective_configuration(const solver::Scene& given) {
  solver::Scene scene = given;  // a Target may change what it refers to
  Target whole(scene);
  nlohmann::json configuration = nlohmann::json::object();
  for (const Section& section : schema()) {
    if (section.repeated) continue;
    const std::string name(section.name);
    if (name == "mechanics" && !scene.mechanics) {
      configuration[name] = {{"on", false}};
    } else {
      configuration[name] = values_of(section, whole);
    }
  }
  for (solver::Precondition& one : scene.initial.preconditions) {
    configuration["initial"]["precondition"].push_back(
        values_of(*find_section("initial.precondition"), Target(scene, one)));
  }
  for (solver::Stimulus& one : scene.stimuli) {
    configuration["stimulus"].push_back(values_of(*find_section("stimulus"), Target(scene, one)));
  }
  return configuration;
}

std::string hint(std::string_view meant) {
  return meant.empty() ? "" : fmt::format("; did you mean \"{}\"?", meant);
}

std::string did_you_mean(std::string_view word, const std::vector<std::string_view>& names) {
  const auto same = [](char left, char right) {
    return std::tolower(static_cast<unsigned char>(left)) == std::tolower(static_cast<unsigned char>(right));
  };
  // Damerau-Levenshtein (a swap of neighbours is one edit), letter case ignored.
  const auto distance = [&](std::string_view left, std::string_view right) {
    std::vector<std::size_t> before, last(right.size() + 1), now(right.size() + 1);
    std::iota(last.begin(), last.end(), std::size_t{0});
    for (std::size_t i = 1; i <= left.size(); ++i) {
      now[0] = i;
      for (std::size_t j = 1; j <= right.size(); ++j) {
        now[j] =
            std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + (same(left[i - 1], right[j - 1]) ? 0 : 1)});
        if (i > 1 && j > 1 && same(left[i - 1], right[j - 2]) && same(left[i - 2], right[j - 1])) {
          now[j] = std::min(now[j], before[j - 2] + 1);
        }
      }
      before = last;
      std::swap(last, now);
      now.resize(right.size() + 1);
    }
    return last[right.size()];
  };
  std::string best;
  std::size_t best_distance = std::numeric_limits<std::size_t>::max();
  constexpr std::size_t longest = 64;  // a longer word is no slip of a key
  if (word.size() > longest) return best;
  for (std::string_view name : names) {
    const std::size_t edits = distance(word, name);
    const std::size_t allowed = std::max<std::size_t>(1, std::min(word.size(), name.size()) / 3 + 1);
    // Every letter changed is another word, not a slip.
    if (edits <= allowed && edits < std::max(word.size(), name.size()) && edits < best_distance) {
      best = name;
      best_distance = edits;
    }
  }
  return best;
}

}  // namespace myowave::apps
