#include "apps/input/scene_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <tuple>

#include "apps/input/initial_state.hpp"
#include "apps/input/presets.hpp"
#include "apps/input/resample.hpp"
#include "apps/input/scene_tables.hpp"
#include "apps/input/schema.hpp"
#include "solver/base/error.hpp"
#include "solver/mechanics/rest_state.hpp"

namespace myowave::apps {
namespace {

using solver::InputError;
using solver::Scene;

constexpr std::string_view preset_key = "accuracy.preset";

// What a value of this kind has to be, in words.
std::string requirement(const Key& key) {
  const std::string range = range_text(key.kind);
  std::string text;
  if (std::holds_alternative<Number>(key.kind)) {
    text = range.empty() ? "a finite number" : "a number " + range;
  } else if (std::holds_alternative<Integer>(key.kind)) {
    text = range.empty() ? "an integer" : "an integer " + range;
  } else if (std::holds_alternative<Path>(key.kind)) {
    text = "a path in quotes";
  } else if (std::holds_alternative<Size>(key.kind)) {
    text = fmt::format("an {}, each {}", type_text(key.kind), range);
  } else {
    text = type_text(key.kind) + (range.empty() ? "" : ", each " + range);
  }
  return key.unit.empty() ? text : fmt::format("{} ({})", text, key.unit);
}

bool is_from_preset(const toml::node& node) {
  const auto& origin = node.source().path;
  return origin && *origin == std::string(override_mark) + std::string(preset_key);
}

std::optional<double> number_in(const toml::node& node, const Range& range) {
  if (!node.is_number()) return std::nullopt;
  const double value = *node.value<double>();
  return std::isfinite(value) && range.contains(value) ? std::optional(value) : std::nullopt;
}

std::optional<std::int64_t> integer_in(const toml::node& node, const Range& range) {
  const auto* integer = node.as_integer();
  return integer != nullptr && range.contains(static_cast<double>(integer->get()))
             ? std::optional(integer->get())
             : std::nullopt;
}

constexpr Range int_range{.low = std::numeric_limits<int>::min(), .high = std::numeric_limits<int>::max()};

std::optional<std::array<int, 2>> int_pair(const toml::node* node, const Range& range = int_range) {
  const auto* array = node == nullptr ? nullptr : node->as_array();
  if (array == nullptr || array->size() != 2) return std::nullopt;
  const auto first = integer_in(*array->get(0), range), second = integer_in(*array->get(1), range);
  if (!first || !second) return std::nullopt;
  return std::array{static_cast<int>(*first), static_cast<int>(*second)};
}

// Reads tables against the schema into a Scene.
class SceneReader {
 public:
  SceneReader(const toml::table& root, const std::filesystem::path& file, Problems& problems)
      : root_(root), folder_(file.parent_path()), problems_(problems) {
    scene_.name = file.stem().string();
  }

  Scene read() {
    read_root();
    sheet_known_ = fine({"grid.n"});
    const double spacing = check_spacing();
    check_representable(spacing);
    check_time();
    check_tension("tension", scene_.tension);
    check_mechanics();
    check_scheme();
    check_initial();
    check_preconditions();
    check_stimuli();
    check_output();
    move_to_spacing(scene_, spacing);
    return std::move(scene_);
  }

 private:
  // ---- tables -------------------------------------------------------------------------------

  void read_root() {
    for (const auto& [name, node] : root_) {
      if (const Section* section = find_section(name.str());
          section == nullptr || section->name.find('.') != std::string_view::npos) {
        unknown_section(name);
      }
    }
    for (const Section& section : schema()) {
      if (section.name == "initial.precondition") continue;  // after [tension], whose values it starts from
      const toml::node* node = root_.get(section.name);
      if (node != nullptr) read_section(section, *node);
    }
    if (const toml::node* node = root_.at_path("initial.precondition").node()) {
      read_section(*find_section("initial.precondition"), *node);
    }
  }

  void unknown_section(const toml::key& name) {
    std::vector<std::string_view> names;
    for (const Section& section : schema()) {
      if (find_key(section, name.str()) != nullptr && section.inherits.empty()) {
        problems_.add(name.source(),
                      fmt::format("\"{0}\" stands outside of its section; did you mean \"{1}.{0}\"?",
                                  printable(name.str()), section.name));
        return;
      }
      if (section.name.find('.') == std::string_view::npos) names.push_back(section.name);
    }
    problems_.add(name.source(), fmt::format("unknown section \"{}\"{}", printable(name.str()),
                                             hint(did_you_mean(name.str(), names))));
  }

  void read_section(const Section& section, const toml::node& node) {
    const std::string name(section.name);
    given_[name] = &node;
    if (const auto* table = node.as_table()) {
      read_element(section, *table, name);
      return;
    }
    const auto* array = node.as_array();
    if (!section.repeated || array == nullptr) {
      bad(name, node, section.repeated ? "a table or an array of tables" : "a table");
      return;
    }
    for (std::size_t i = 0; i < array->size(); ++i) {
      const std::string path = fmt::format("{}.{}", name, i);
      given_[path] = array->get(i);
      if (const auto* table = array->get(i)->as_table()) {
        read_element(section, *table, path);
      } else {
        bad(path, *array->get(i), "a table");
      }
    }
  }

  void read_element(const Section& section, const toml::table& table, const std::string& path) {
    if (section.name == "stimulus") {
      solver::Stimulus stimulus;
      read_keys(section, table, path, Target(scene_, stimulus));
      // A period asks for more than one pulse.
      if (!table.contains("count") && stimulus.period > 0) stimulus.count = -1;
      scene_.stimuli.push_back(stimulus);
      stimulus_paths_.push_back(path);
    } else if (section.name == "initial.precondition") {
      solver::Precondition precondition;
      read_keys(section, table, path, Target(scene_, precondition));
      scene_.initial.preconditions.push_back(precondition);
      precondition_paths_.push_back(path);
    } else if (section.name == "mechanics") {
      scene_.mechanics.emplace();
      read_keys(section, table, path, Target(scene_));
      if (table["on"].value<bool>() == false) scene_.mechanics.reset();
    } else {
      read_keys(section, table, path, Target(scene_));
    }
  }

  void read_keys(const Section& section, const toml::table& table, const std::string& path, Target target) {
    for (const auto& [name, node] : table) {
      if (find_key(section, name.str()) == nullptr &&
          find_section(path + "." + std::string(name.str())) == nullptr) {
        unknown_key(section, name, path);
      }
    }
    for (std::string_view other : section.inherits) {
      const Section& whole = *find_section(other);
      const toml::table* scene_table = root_[other].as_table();
      for (const Key& key : whole.keys) {
        // What the table does not name is as in the scene.
        if (const toml::node* node = table.get(key.name)) {
          read_value(key, *node, fmt::format("{}.{}", path, key.name), target);
        } else if (const toml::node* own = scene_table == nullptr ? nullptr : scene_table->get(key.name)) {
          read_value(key, *own, fmt::format("{}.{}", other, key.name), target);
        }
      }
    }
    for (const Key& key : section.keys) {
      if (const toml::node* node = table.get(key.name)) {
        read_value(key, *node, fmt::format("{}.{}", path, key.name), target);
      } else if (key.required) {
        problems_.add(table.source(), fmt::format("{}.{} is missing: {}", path, key.name, requirement(key)));
      }
    }
  }

  void unknown_key(const Section& section, const toml::key& name, const std::string& path) {
    std::vector<std::string_view> names;
    for (const Key& key : section.keys) names.push_back(key.name);
    for (std::string_view other : section.inherits) {
      for (const Key& key : find_section(other)->keys) names.push_back(key.name);
    }
    if (section.name == "initial") names.push_back("precondition");
    std::string help = hint(did_you_mean(name.str(), names));
    if (help.empty()) {
      for (const Section& other : schema()) {
        if (other.inherits.empty() && find_key(other, name.str()) != nullptr) {
          help = fmt::format("; it is a key of [{}]", other.name);
          break;
        }
      }
    }
    if (help.empty()) help = fmt::format("; keys: {}", fmt::join(names, ", "));
    problems_.add(name.source(),
                  fmt::format("unknown key \"{}\" in [{}]{}", printable(name.str()), path, help));
  }

  // ---- values -------------------------------------------------------------------------------

  void bad(const std::string& path, const toml::node& node, const std::string& required,
           const std::string& help = "") {
    wrong_.insert(path);
    problems_.add(node.source(), fmt::format("{} must be {}, not {}{}", path, required, shown(node), help));
  }

  void read_value(const Key& key, const toml::node& node, const std::string& path, Target& target) {
    given_[path] = &node;
    const auto read = [&](const auto& kind) { return set(kind, node, path, target); };
    if (std::visit(read, key.kind) || wrong_.contains(path)) return;
    std::string help;
    const auto* text = node.as_string();
    if (const auto* choice = std::get_if<Choice>(&key.kind); choice != nullptr && text != nullptr) {
      help = hint(did_you_mean(text->get(), choice->names));
    }
    bad(path, node, requirement(key), help);
  }

  // Each returns false where the value is not what its kind asks for.
  bool set(const Number& kind, const toml::node& node, const std::string&, Target& target) {
    const auto value = number_in(node, kind.range);
    if (value) kind.set(target, *value);
    return value.has_value();
  }

  bool set(const Integer& kind, const toml::node& node, const std::string&, Target& target) {
    const auto value = integer_in(node, kind.range);
    if (value) kind.set(target, *value);
    return value.has_value();
  }

  bool set(const Flag& kind, const toml::node& node, const std::string&, Target& target) {
    const auto value = node.value_exact<bool>();
    if (value && kind.set) kind.set(target, *value);
    return value.has_value();
  }

  bool set(const Choice& kind, const toml::node& node, const std::string&, Target& target) {
    const auto value = node.value_exact<std::string_view>();
    const auto found = value ? std::ranges::find(kind.names, *value) : kind.names.end();
    if (found == kind.names.end()) return false;
    kind.set(target, found - kind.names.begin());
    return true;
  }

  bool set(const Choices& kind, const toml::node& node, const std::string& path, Target& target) {
    const auto* array = node.as_array();
    if (array == nullptr) return false;
    std::vector<bool> chosen(kind.names.size());
    for (const toml::node& element : *array) {
      const auto name = element.value_exact<std::string_view>();
      const auto found = name ? std::ranges::find(kind.names, *name) : kind.names.end();
      const bool known = found != kind.names.end();
      if (known && !chosen[found - kind.names.begin()]) {
        chosen[found - kind.names.begin()] = true;
        continue;
      }
      bad(path, element, fmt::format("a {}, each at most once", type_text(kind)),
          name && !known ? hint(did_you_mean(*name, kind.names)) : "");
      return false;
    }
    kind.set(target, chosen);
    return true;
  }

  bool set(const Path& kind, const toml::node& node, const std::string&, Target& target) {
    const auto value = node.value_exact<std::string>();
    if (!value || value->empty()) return false;
    const std::filesystem::path given(*value);
    kind.set(target, (is_override(node.source()) ? given : folder_ / given).string());
    return true;
  }

  bool set(const Pair& kind, const toml::node& node, const std::string&, Target& target) {
    const auto value = int_pair(&node, kind.range);
    if (value) kind.set(target, *value);
    return value.has_value();
  }

  bool set(const Size& kind, const toml::node& node, const std::string&, Target& target) {
    std::optional<std::array<int, 2>> size = int_pair(&node, kind.range);
    if (const auto side = integer_in(node, kind.range))
      size = std::array{static_cast<int>(*side), static_cast<int>(*side)};
    if (size) std::tie(target.scene.grid.rows, target.scene.grid.columns) = std::tuple_cat(*size);
    return size.has_value();
  }

  bool set(const Probes&, const toml::node& node, const std::string&, Target& target) {
    const auto* array = node.as_array();
    if (array == nullptr) return false;
    target.scene.output.probes.clear();
    for (const toml::node& element : *array) {
      const auto probe = int_pair(&element);
      if (!probe) return false;
      target.scene.output.probes.push_back(*probe);
    }
    return true;
  }

  bool set(const Region&, const toml::node& node, const std::string& path, Target& target) {
    using Shape = solver::Stimulus::Shape;
    solver::Stimulus& stimulus = *target.stimulus;
    if (node.value_exact<std::string_view>() == "all") return true;
    const auto* table = node.as_table();
    if (table == nullptr || table->empty()) return false;
    const std::vector<std::string_view> names{"center", "radius", "columns", "rows"};
    bool known = true;
    for (const auto& [name, value] : *table) {
      if (std::ranges::find(names, name.str()) != names.end()) continue;
      known = false;
      wrong_.insert(path);
      problems_.add(name.source(), fmt::format("unknown key \"{}\" in {}{}", printable(name.str()), path,
                                               hint(did_you_mean(name.str(), names))));
    }
    if (!known) return false;
    const bool is_disc = table->contains("center") || table->contains("radius");
    const bool is_block = table->contains("columns") || table->contains("rows");
    if (is_disc == is_block) return false;
    if (is_disc) return set_disc(*table, path, stimulus);
    stimulus.shape = Shape::block;
    // Both, so that the errors of both are told.
    const bool columns = set_side(*table, "columns", path, scene_.grid.columns, stimulus.columns);
    const bool rows = set_side(*table, "rows", path, scene_.grid.rows, stimulus.rows);
    return columns && rows;
  }

  bool set_disc(const toml::table& table, const std::string& path, solver::Stimulus& stimulus) {
    stimulus.shape = solver::Stimulus::Shape::disc;
    const toml::node* center = table.get("center");
    const toml::node* radius = table.get("radius");
    if (center == nullptr || radius == nullptr) return false;
    const auto* array = center->as_array();
    const auto x = array != nullptr && array->size() == 2 ? number_in(*array->get(0), {}) : std::nullopt;
    const auto y = x ? number_in(*array->get(1), {}) : std::nullopt;
    if (!y) bad(path + ".center", *center, "[column, row], two numbers");
    const auto r = number_in(*radius, {.low = 0});
    if (!r) bad(path + ".radius", *radius, "a number >= 0 (node spacings)");
    if (!y || !r) {
      wrong_.insert(path);
      return false;
    }
    stimulus.center = {*x, *y};
    stimulus.radius = *r;
    return true;
  }

  // First and last node of one side of a block; the whole side where it is not named.
  bool set_side(const toml::table& table, std::string_view name, const std::string& path, int nodes,
                std::array<int, 2>& side) {
    const toml::node* node = table.get(name);
    side = {0, nodes - 1};
    if (node == nullptr) return true;
    const auto value = int_pair(node);
    if (!value) {
      bad(fmt::format("{}.{}", path, name), *node, "[first, last], two integers");
      wrong_.insert(path);
      return false;
    }
    side = *value;
    return true;
  }

  // ---- what several keys must agree on --------------------------------------------------------

  bool fine(std::initializer_list<std::string_view> paths) const {
    return std::ranges::none_of(paths,
                                [&](std::string_view path) { return wrong_.contains(std::string(path)); });
  }

  // Reports at the first of the paths that the scene gives, one of --set before one of the file.
  void conflict(std::initializer_list<std::string> paths, const std::string& message) {
    const toml::source_region* place = nullptr;
    for (const std::string& path : paths) {
      const auto found = given_.find(path);
      if (found == given_.end()) continue;
      const toml::source_region& here = source_of(*found->second);
      if (place == nullptr || (is_override(here) && !is_override(*place))) place = &here;
    }
    problems_.add(place == nullptr ? toml::source_region{} : *place, message);
  }

  // Of a preset's value the place of the preset.
  const toml::source_region& source_of(const toml::node& node) const {
    return is_from_preset(node) ? root_.at_path(preset_key).node()->source() : node.source();
  }

  // A step adds dt times what it divides by dx^2: 0 or infinity there would be a run of nothing.
  void check_representable(double spacing) {
    const bool single = scene_.precision == solver::Precision::float32;
    const double smallest = single ? std::numeric_limits<float>::min() : std::numeric_limits<double>::min();
    const double largest = single ? std::numeric_limits<float>::max() : std::numeric_limits<double>::max();
    const auto check = [&](std::string_view path, double given, std::string_view what, double value) {
      if (!fine({path, "accuracy.precision"}) || (value >= smallest && value <= largest)) return;
      conflict({std::string(path), "accuracy.precision"},
               fmt::format("{} = {}: {} = {:.2g} is outside of {} ({:.2g} to {:.2g})", path, given, what,
                           value, single ? "float32" : "float64", smallest, largest));
    };
    check("time.dt", scene_.time.dt, "dt", scene_.time.dt);
    check("grid.dx", scene_.grid.dx, "1/dx^2", 1 / (scene_.grid.dx * scene_.grid.dx));
    if (spacing != scene_.grid.dx) check("accuracy.dx", scene_.dx, "1/dx^2", 1 / (spacing * spacing));
  }

  // The run's spacing; a preset's dt, which is for its own, follows it.
  double check_spacing() {
    if (!sheet_known_ || !fine({"grid.dx", "accuracy.dx", "mechanics.cells_per_element"}))
      return scene_.grid.dx;
    const double spacing = spacing_of_run(scene_);
    if (!check_node_count("accuracy.dx", scene_.dx, spacing)) return scene_.grid.dx;
    const auto dt = given_.find("time.dt");
    if (dt != given_.end() && is_from_preset(*dt->second)) scene_.time.dt = dt_of_preset(spacing);
    return spacing;
  }

  // Of a spacing that the key at the path gives: false, and told, where a side has more nodes than can be
  // counted.
  bool check_node_count(const std::string& path, double given, double spacing) {
    constexpr double most_nodes = 1e7;  // as grid.n
    const double side = std::max(scene_.grid.rows - 1, scene_.grid.columns - 1) * scene_.grid.dx;
    if (side / spacing < most_nodes) return true;
    conflict(
        {path},
        fmt::format("{} = {} puts {:.2g} nodes along a side of {:g} length units; at most {:g} are allowed: "
                    "set it to {:.2g} or more",
                    path, given, side / spacing, side, most_nodes, side / most_nodes));
    return false;
  }

  // A preset's dt is for its own spacing and D = C_m; up to a fifth more of D dt / dx^2 is as stable and
  // nearly as accurate, and so is up to a fifth more to be a whole part of the shortest interval of outputs.
  double dt_of_preset(double spacing) const {
    constexpr double a_fifth_more = 1.2, rounding = 1e-9;
    const Preset& preset = presets()[static_cast<std::size_t>(scene_.preset)];
    const PresetValue& dx = *find_value(preset, "accuracy.dx", scene_.mechanics.has_value());
    const double finer = std::strtod(std::string(dx.value).c_str(), nullptr) / spacing;
    const double parts = finer * finer * scene_.excitation.D / scene_.excitation.C_m / a_fifth_more;
    const double longest = scene_.time.dt / std::max(1.0, std::ceil(parts));
    const solver::OutputSettings& output = scene_.output;
    const double interval = std::min({output.every, output.tips_every, output.probes_every});
    const double steps = interval / longest, fewer = std::floor(steps);
    return interval / (a_fifth_more * fewer > steps - rounding ? fewer : std::ceil(steps));
  }

  void check_time() {
    if (fine({"time.dt", "time.t_end"})) check_step_count("time.t_end", scene_.time.t_end);
  }

  void check_step_count(const std::string& path, double duration) {
    constexpr double most_steps = 1e15;
    const double steps = duration / scene_.time.dt;
    if (!(steps <= most_steps)) {
      conflict({path, "time.dt"},
               fmt::format("{} = {} with time.dt = {} is {:.2g} steps; at most {:g} can be counted", path,
                           duration, scene_.time.dt, steps, most_steps));
    }
  }

  // An explicit step past 1/rate overshoots the tension it relaxes to.
  void check_tension(const std::string& section, const solver::TensionSettings& tension) {
    if (!fine({"time.dt", section + ".eps0", section + ".eps_below", section + ".eps_above"})) return;
    for (const auto& [name, rate] :
         {std::pair("eps_below", tension.eps_below), std::pair("eps_above", tension.eps_above)}) {
      if (rate * scene_.time.dt <= 1) continue;
      conflict({section + "." + name, section + ".eps0", "tension." + std::string(name), "tension.eps0",
                "time.dt"},
               fmt::format("{}.{} = {} is too fast for time.dt = {}: the rate times the step must be <= 1",
                           section, name, rate, scene_.time.dt));
    }
  }

  void check_mechanics() {
    if (!scene_.mechanics) return;
    const solver::MechanicsSettings& mechanics = *scene_.mechanics;
    if (sheet_known_ && fine({"mechanics.cells_per_element"})) {
      check_divides("columns", scene_.grid.columns, mechanics.cells_per_element);
      if (scene_.grid.rows != scene_.grid.columns)
        check_divides("rows", scene_.grid.rows, mechanics.cells_per_element);
    }
    if (fine({"tension.law", "mechanics.contraction"}) && scene_.tension.law == "none" &&
        mechanics.contraction)
      conflict(
          {"tension.law", "mechanics.contraction", "mechanics"},
          "tension.law = \"none\" leaves mechanics.contraction = true without a tension; set it to false, or "
          "the law to \"delayed\" or \"printed\"");
    if (fine({"mechanics.c1", "mechanics.c2"}) && mechanics.c1 == 0 && mechanics.c2 == 0) {
      conflict({"mechanics.c1", "mechanics.c2"},
               "mechanics.c1 and mechanics.c2 are both 0: a sheet without stiffness has no equilibrium");
    } else if (fine({"mechanics.c1", "mechanics.c2", "mechanics.p", "mechanics.load", "mechanics.edges"})) {
      const auto reason = solver::why_no_rest_state(mechanics);
      if (reason)
        conflict({"mechanics.p", "mechanics.load", "mechanics.c2", "mechanics.c1", "mechanics"}, *reason);
    }
  }

  void check_scheme() {
    if (scene_.scheme == solver::Scheme::split && scene_.mechanics &&
        scene_.metric == solver::MetricForm::expanded && fine({"accuracy.scheme", "feedback.metric"}))
      conflict(
          {"accuracy.scheme", "feedback.metric"},
          "accuracy.scheme = \"split\" has no feedback.metric = \"expanded\"; set the first to \"euler\" "
          "or the second to \"conservative\"");
  }

  void check_divides(std::string_view side, std::int64_t nodes, std::int64_t cells) {
    if ((nodes - 1) % cells == 0) return;
    const std::int64_t below = (nodes - 1) / cells * cells + 1;
    const std::string nearest =
        below > 1 ? fmt::format("the nearest sizes that are: {} and {}", below, below + cells)
                  : fmt::format("the smallest size that is: {}", below + cells);
    const std::string name =
        scene_.grid.rows == scene_.grid.columns ? "grid.n" : fmt::format("grid.n: {}", side);
    conflict(
        {"grid.n", "mechanics.cells_per_element", "mechanics"},
        fmt::format("{} = {}: {} - 1 = {} cells are not divisible by mechanics.cells_per_element = {}; {}",
                    name, nodes, nodes, nodes - 1, cells, nearest));
  }

  void check_initial() {
    const Section& section = *find_section("initial");
    const solver::InitialSettings& initial = scene_.initial;
    if (!fine({"initial.type"})) return;
    const auto& types = std::get<Choice>(find_key(section, "type")->kind).names;
    const std::string_view type = types[static_cast<std::size_t>(initial.type)];
    check_unused(section, type);
    if (initial.type == solver::InitialSettings::Type::file) check_file();
    if (!sheet_known_ || !fine({"grid.dx", "initial.dx"})) return;
    if (initial.dx > 0 && !check_node_count("initial.dx", initial.dx, initial.dx)) return;
    if (initial.dx > 0 && !divides_sheet(scene_.grid, initial.dx)) {
      conflict(
          {"initial.dx"},
          fmt::format("initial.dx = {}: the sides of the sheet ({:g} and {:g} length units) are no whole "
                      "numbers of it",
                      initial.dx, (scene_.grid.columns - 1) * scene_.grid.dx,
                      (scene_.grid.rows - 1) * scene_.grid.dx));
      return;
    }
    using Type = solver::InitialSettings::Type;
    if (initial.type == Type::broken_front)
      check_inside("initial.offset", "the end of the front", initial.offset);
    if (initial.type == Type::settled_spiral &&
        check_inside("initial.core_offset", "the core", initial.core_offset)) {
      check_settled_spiral();
    }
  }

  void check_settled_spiral() {
    try {
      require_settled_spiral(scene_);
    } catch (const InputError& error) {
      const bool own_dx = grid_of_start(scene_).dx != solver::GridSettings{}.dx;
      if (own_dx)
        conflict({"initial.dx", "grid.dx"}, error.what());
      else
        conflict({"initial.core_offset"}, error.what());
    }
  }

  // A key of another type would be ignored. Where --set chose the type, the file's keys for its own
  // type are no mistake.
  void check_unused(const Section& section, std::string_view type) {
    const auto type_given = given_.find("initial.type");
    const bool type_set = type_given != given_.end() && is_override(type_given->second->source());
    for (const Key& key : section.keys) {
      const auto found = given_.find(fmt::format("initial.{}", key.name));
      if (key.only_type.empty() || key.only_type == type || found == given_.end()) continue;
      if (type_set && !is_override(found->second->source())) continue;
      const std::string help = key.name == "offset" && type == "settled_spiral"      ? hint("core_offset")
                               : key.name == "core_offset" && type == "broken_front" ? hint("offset")
                                                                                     : "";
      problems_.add(found->second->source(),
                    fmt::format("initial.{} belongs to type = \"{}\" and has no effect with type = \"{}\"{}",
                                key.name, key.only_type, type, help));
    }
  }

  void check_file() {
    const std::string& file = scene_.initial.file;
    if (!fine({"initial.file"})) return;
    if (file.empty()) {
      conflict({"initial.type"}, "initial.file is missing: type = \"file\" needs the path of an HDF5 file");
      return;
    }
    std::error_code error;
    if (!std::filesystem::exists(file, error)) {
      conflict({"initial.file"}, fmt::format("initial.file: there is no file {}", file));
    } else if (std::filesystem::is_directory(file, error)) {
      conflict({"initial.file"}, fmt::format("initial.file: {} is a folder", file));
    }
  }

  // `offset` [columns, rows] from the middle of the sheet.
  bool check_inside(const std::string& path, std::string_view what, const std::array<int, 2>& offset) {
    if (!fine({path})) return false;
    const solver::GridSettings sheet = grid_of_start(scene_);
    const std::int64_t column = (sheet.columns - 1) / 2 + std::int64_t{offset[0]};
    const std::int64_t row = (sheet.rows - 1) / 2 + std::int64_t{offset[1]};
    if (column >= 0 && column < sheet.columns && row >= 0 && row < sheet.rows) return true;
    conflict({path}, fmt::format("{} = [{}, {}] puts {} at column {}, row {}, outside of the sheet ({})",
                                 path, offset[0], offset[1], what, column, row, sheet_text(sheet)));
    return false;
  }

  static std::string sheet_text(const solver::GridSettings& sheet) {
    return fmt::format("columns 0 to {}, rows 0 to {}", sheet.columns - 1, sheet.rows - 1);
  }

  void check_preconditions() {
    for (std::size_t i = 0; i < scene_.initial.preconditions.size(); ++i) {
      const solver::Precondition& one = scene_.initial.preconditions[i];
      const std::string& path = precondition_paths_[i];
      if (one.contraction && !scene_.mechanics && fine({"mechanics.on"})) {
        conflict({path + ".contraction"},
                 fmt::format("{}.contraction = true needs [mechanics]; this scene is rigid", path));
      }
      if (fine({"tension.law", path + ".law"}) && one.contraction && one.tension.law == "none")
        conflict({path + ".contraction", path + ".law", "tension.law"},
                 fmt::format("{}.contraction = true needs a tension.law other than \"none\"", path));
      if (fine({"time.dt", path + ".duration"})) check_step_count(path + ".duration", one.duration);
      const bool own_rates =
          std::ranges::any_of(std::array{".law", ".eps0", ".eps_below", ".eps_above"},
                              [&](const char* key) { return given_.contains(path + key); });
      if (own_rates) check_tension(path, one.tension);
    }
  }

  void check_stimuli() {
    for (std::size_t i = 0; i < scene_.stimuli.size(); ++i) {
      const solver::Stimulus& one = scene_.stimuli[i];
      const std::string& path = stimulus_paths_[i];
      if (fine({path + ".duration", path + ".period"}) && one.period > 0 && one.duration > one.period) {
        conflict({path + ".duration", path + ".period"},
                 fmt::format("{}.duration = {} is longer than its period = {}: pulses would overlap", path,
                             one.duration, one.period));
      }
      if (fine({path + ".count", path + ".period"}) && one.period == 0 && (one.count > 1 || one.count < 0)) {
        conflict({path + ".count"}, fmt::format("{}.count = {} needs a period > 0", path, one.count));
      }
      if (fine({path + ".duration", "time.dt"}) && one.duration < scene_.time.dt) {
        conflict({path + ".duration", "time.dt"},
                 fmt::format("{}.duration = {} is shorter than a step (time.dt = {})", path, one.duration,
                             scene_.time.dt));
      }
      if (sheet_known_ && fine({path + ".region"})) check_region(path + ".region", one);
    }
  }

  void check_region(const std::string& path, const solver::Stimulus& one) {
    using Shape = solver::Stimulus::Shape;
    const int columns = scene_.grid.columns, rows = scene_.grid.rows;
    if (one.shape == Shape::block) {
      const auto outside = [](const std::array<int, 2>& side, int nodes) {
        return side[0] < 0 || side[1] >= nodes;
      };
      if (one.columns[0] > one.columns[1] || one.rows[0] > one.rows[1]) {
        conflict({path},
                 fmt::format("{}: columns = [{}, {}], rows = [{}, {}]: the last node comes before the first",
                             path, one.columns[0], one.columns[1], one.rows[0], one.rows[1]));
      } else if (outside(one.columns, columns) || outside(one.rows, rows)) {
        conflict({path}, fmt::format("{}: columns = [{}, {}], rows = [{}, {}] leave the sheet ({})", path,
                                     one.columns[0], one.columns[1], one.rows[0], one.rows[1],
                                     sheet_text(scene_.grid)));
      }
    }
    if (one.shape == Shape::disc) {
      const auto& [x, y] = one.center;
      if (!(x >= 0 && x <= columns - 1 && y >= 0 && y <= rows - 1)) {
        conflict({path}, fmt::format("{}: center = [{}, {}] (column, row) is outside of the sheet ({})", path,
                                     x, y, sheet_text(scene_.grid)));
      } else if (std::hypot(x - std::round(x), y - std::round(y)) > one.radius) {
        conflict({path}, fmt::format("{}: no node lies within radius = {} of center = [{}, {}]", path,
                                     one.radius, x, y));
      }
    }
  }

  void check_output() {
    solver::OutputSettings& output = scene_.output;
    if (given_.contains("output.every")) {
      check_multiple("output.every", output.every);
    } else if (fine({"time.dt"})) {
      follow_step(output);
    }
    if (!given_.contains("output.tension")) output.tension = scene_.mechanics || output.fields;
    if (output.tips_every != output.every) check_multiple("output.tips_every", output.tips_every);
    if (output.probes_every != output.every) check_multiple("output.probes_every", output.probes_every);
    if (!sheet_known_) return;
    const int columns = scene_.grid.columns, rows = scene_.grid.rows;
    if (output.probes.empty()) {
      const int bottom = (rows - 1) / 4, left = (columns - 1) / 4;
      const int top = rows - 1 - bottom, right = columns - 1 - left;
      output.probes = {{bottom, left}, {bottom, right}, {top, left}, {top, right}};
    }
    for (const auto& [row, column] : output.probes) {
      if (row >= 0 && row < rows && column >= 0 && column < columns) continue;
      conflict({"output.probes"},
               fmt::format("output.probes: [{}, {}] (row, column) is outside of the sheet ({})", row, column,
                           sheet_text(scene_.grid)));
    }
  }

  // A default that no step meets would be nobody's mistake: the multiple of dt that is nearest to it.
  void follow_step(solver::OutputSettings& output) const {
    const double dt = scene_.time.dt;
    const double every = std::max(1.0, std::round(output.every / dt)) * dt;
    if (!given_.contains("output.tips_every")) output.tips_every = every;
    if (!given_.contains("output.probes_every")) output.probes_every = every;
    output.every = every;
  }

  void check_multiple(const std::string& path, double every) {
    if (!fine({path, "output.every", "time.dt"})) return;
    const double dt = scene_.time.dt;
    const double steps = every / dt;
    if (!(steps < 1e15)) {
      check_step_count(path, every);
      return;
    }
    // 1e-6 of a step covers decimal numbers that binary ones only come close to.
    if (std::round(steps) >= 1 && std::abs(steps - std::round(steps)) < 1e-6) return;
    const double below = std::floor(steps);
    const std::string nearest =
        below < 1 ? fmt::format("the smallest is {:g}", dt)
                  : fmt::format("the nearest are {:g} and {:g}", below * dt, (below + 1) * dt);
    conflict({path, "output.every", "time.dt"},
             fmt::format("{} = {} is not a multiple of time.dt = {}; {}", path, every, dt, nearest));
  }

  const toml::table& root_;
  std::filesystem::path folder_;
  Problems& problems_;
  Scene scene_;
  std::map<std::string, const toml::node*> given_;  // by path: "grid.n", "stimulus.0", ...
  std::set<std::string> wrong_;                     // paths already reported
  std::vector<std::string> stimulus_paths_, precondition_paths_;
  bool sheet_known_ = true;  // grid.n is no error, so that others can be compared with it
};

// ---- overrides ------------------------------------------------------------------------------

std::vector<std::string> split(const std::string& path) {
  std::vector<std::string> parts(1);
  for (const char letter : path) {
    if (letter == '.') {
      parts.emplace_back();
    } else {
      parts.back() += letter;
    }
  }
  return parts;
}

bool is_index(const std::string& text) {
  return !text.empty() && text.size() < 9 && text.find_first_not_of("0123456789") == std::string::npos;
}

// The table that holds nothing but this value, its nodes marked as from the override of `origin`.
toml::table override_table(const std::string& key, const std::string& value, const std::string& origin) {
  const std::string source = std::string(override_mark) + origin;
  if (value.find_first_of("\r\n") == std::string::npos) {
    try {
      return toml::parse(fmt::format("{} = {}", key, value), source);
    } catch (const toml::parse_error&) {
      // No TOML value: a string that needs no quotes.
    }
  }
  return toml::parse(fmt::format("{} = {}", key, toml_string(value)), source);
}

// Elements of an array of tables can be changed, not made one by one.
void require_no_index(const std::vector<std::string>& path, std::size_t from) {
  std::string section;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    section += (section.empty() ? "" : ".") + path[i];
    const Section* known = find_section(section);
    if (i >= from && known != nullptr && known->repeated && is_index(path[i + 1])) {
      throw InputError(fmt::format("there is no {} {}: the scene has 0", section, path[i + 1]));
    }
  }
}

// Puts the override's value where the path leads. Errors: InputError where it leads nowhere.
void merge(toml::table& root, toml::table&& given, const std::vector<std::string>& path) {
  toml::node* into = &root;
  toml::table* from = &given;
  std::string section;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const std::string& name = path[i];
    toml::node& value = *from->get(name);
    const bool last = i + 1 == path.size();
    const bool repeated = find_section(section) != nullptr && find_section(section)->repeated;
    if (auto* array = into->as_array()) {
      if (!is_index(name))
        throw InputError(fmt::format("{0} is an array: name an element, for example {0}.0", section));
      const std::size_t index = std::stoul(name);
      if (index >= array->size()) {
        throw InputError(fmt::format("there is no {} {}: the scene has {}", section, name, array->size()));
      }
      if (last) {
        array->replace(array->cbegin() + static_cast<std::ptrdiff_t>(index), std::move(value));
        return;
      }
      into = array->get(index);
    } else if (auto* table = into->as_table()) {
      toml::node* next = table->get(name);
      if (repeated && name == "0" && next == nullptr) {
        // One table that could be several: it is number 0 itself.
      } else if (repeated && is_index(name)) {
        throw InputError(fmt::format("there is no {} {}: the scene has 1", section, name));
      } else if (next == nullptr || last) {
        if (next == nullptr) require_no_index(path, i);
        // The parsed key, not its text: it knows where it comes from.
        table->insert_or_assign(from->find(name)->first, std::move(value));
        return;
      } else {
        into = next;
      }
    } else {
      throw InputError(fmt::format("{} is one value and has no \"{}\"", section, name));
    }
    if (last) throw InputError("a whole table cannot be replaced; name one of its keys");
    section += (section.empty() ? "" : ".") + name;
    if (repeated && is_index(name)) section.erase(section.rfind('.'));
    from = value.as_table();
  }
}

}  // namespace

void apply_override(toml::table& root, const std::string& text, Problems& problems) {
  const auto trimmed = [](std::string part) {
    part.erase(0, part.find_first_not_of(" \t"));
    part.erase(part.find_last_not_of(" \t") + 1);
    return part;
  };
  const std::size_t equals = text.find('=');
  const std::string key = trimmed(text.substr(0, equals));
  const auto is_key_letter = [](unsigned char letter) {
    return std::isalnum(letter) != 0 || letter == '_' || letter == '-' || letter == '.';
  };
  if (equals == std::string::npos || key.empty() || !std::ranges::all_of(key, is_key_letter) ||
      key.front() == '.' || key.back() == '.' || key.find("..") != std::string::npos) {
    problems.add_override(printable(text), "must be section.key=value");
    return;
  }
  try {
    merge(root, override_table(key, trimmed(text.substr(equals + 1)), key), split(key));
  } catch (const toml::parse_error& error) {
    problems.add_override(key, std::string(error.description()));
  } catch (const InputError& error) {
    problems.add_override(key, error.what());
  }
}

namespace {

// What the chosen preset gives on this scene; a preset of an override goes before the file's values.
struct ChosenPreset {
  std::vector<PresetValue> values;
  bool over_the_file = false;

  explicit ChosenPreset(const toml::table& root) {
    const toml::node* const chosen = root.at_path(preset_key).node();
    const Preset* const preset =
        chosen == nullptr ? nullptr : find_preset(chosen->value_or(std::string_view()));
    if (preset == nullptr) return;
    over_the_file = is_override(chosen->source());
    const bool elastic = root.contains("mechanics") && root.at_path("mechanics.on").value_or(true);
    for (const PresetValue& one : preset->values) {
      // A section that is no table is told of when it is read.
      const toml::node* const section = root.get(one.key.substr(0, one.key.find('.')));
      if (one.holds(elastic) && (section == nullptr || section->is_table())) values.push_back(one);
    }
  }
};

// What the scene names itself stays, but a preset of an override changes the file's values.
void apply_preset(toml::table& root) {
  const ChosenPreset preset(root);
  for (const PresetValue& one : preset.values) {
    const std::string key(one.key);
    const toml::node* const named = root.at_path(key).node();
    if (named != nullptr && (!preset.over_the_file || is_override(named->source()))) continue;
    merge(root, override_table(key, std::string(one.value), std::string(preset_key)), split(key));
  }
}

// Leaves out what a preset of an override changes, so that the preset gives it where it stands in the file.
void leave_to_preset(toml::table& root) {
  const ChosenPreset preset(root);
  for (const PresetValue& one : preset.values) {
    const toml::node* const named = root.at_path(one.key).node();
    if (named == nullptr || !preset.over_the_file || is_override(named->source())) continue;
    const auto path = split(std::string(one.key));
    root.get_as<toml::table>(path.front())->erase(path.back());
  }
}

// From any folder the same.
void make_state_file_absolute(toml::table& root, const std::filesystem::path& folder) {
  auto* const initial = root.get_as<toml::table>("initial");
  auto* const file = initial == nullptr ? nullptr : initial->get_as<std::string>("file");
  if (file == nullptr) return;
  const std::filesystem::path given = file->get();
  *file = std::filesystem::absolute(is_override(file->source()) ? given : folder / given).string();
}

}  // namespace

Scene read_tables(toml::table root, const std::filesystem::path& file,
                  const std::vector<std::string>& overrides, Problems& problems) {
  for (const std::string& one : overrides) apply_override(root, one, problems);
  apply_preset(root);
  return SceneReader(root, file, problems).read();
}

Scene parse_scene(std::string_view text, const std::filesystem::path& file,
                  const std::vector<std::string>& overrides) {
  Problems problems(file.string());
  Scene scene = read_tables(parse_toml(text, file, problems), file, overrides, problems);
  problems.throw_if_any();
  return scene;
}

std::string overridden_text(std::string_view text, const std::filesystem::path& file,
                            const std::vector<std::string>& overrides) {
  Problems problems(file.string());
  toml::table root = parse_toml(text, file, problems);
  for (const std::string& one : overrides) apply_override(root, one, problems);
  problems.throw_if_any();
  leave_to_preset(root);
  make_state_file_absolute(root, file.parent_path());
  std::ostringstream written;
  written << root << '\n';
  return written.str();
}

Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return parse_scene(toml_text(file, "scene"), file, overrides);
}

}  // namespace myowave::apps
