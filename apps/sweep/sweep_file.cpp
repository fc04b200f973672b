#include "apps/sweep/sweep_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "apps/base/content_hash.hpp"
#include "apps/base/memory.hpp"
#include "apps/input/did_you_mean.hpp"
#include "apps/input/scene_tables.hpp"
#include "apps/input/schema.hpp"
#include "apps/results/observable_table.hpp"
#include "apps/sweep/axis_table.hpp"
#include "solver/base/error.hpp"
#include "solver/run/stages.hpp"

namespace myowave::apps {
namespace {

namespace fs = std::filesystem;
using solver::InputError;

// More lines tell a reader nothing.
constexpr std::size_t most_problems = 50;

// The scene that all runs vary.
struct BaseScene {
  toml::table tables;
  fs::path file;
};

class SweepReader {
 public:
  SweepReader(std::string_view text, const fs::path& file)
      : file_(file), folder_(file.parent_path()), problems_(file.string()) {
    plan_.name = file.stem().string();
    plan_.text = text;
    root_ = parse_toml(text, file, problems_);
  }

  SweepPlan read() {
    require_known_keys(root_, "", {"scene", "combine", "axis", "latin_hypercube", "stop", "pair", "keep"},
                       problems_);
    const auto base = read_base();
    read_stop();
    read_keep();
    read_axes();
    read_pair();
    problems_.throw_if_any();
    make_runs(*base);
    problems_.throw_if_any();
    return std::move(plan_);
  }

 private:
  // A table of the root, or nullptr; one of another type is a problem.
  const toml::table* table(std::string_view name, std::string_view required) {
    const toml::node* node = root_.get(name);
    if (node != nullptr && !node->is_table())
      problems_.add(node->source(), fmt::format("{} must be {}, not {}", name, required, shown(*node)));
    return node == nullptr ? nullptr : node->as_table();
  }

  std::optional<BaseScene> read_base() {
    const toml::node* node = root_.get("scene");
    if (node == nullptr) {
      problems_.add({}, "scene is missing: the path of a scene file, or the scene as tables [scene.section]");
      return std::nullopt;
    }
    if (const auto* tables = node->as_table()) return BaseScene{*tables, file_};
    const auto path = node->value_exact<std::string>();
    if (!path || path->empty()) {
      problems_.add(node->source(),
                    fmt::format("scene must be the path of a scene file in quotes, or the scene as tables "
                                "[scene.section], not {}",
                                shown(*node)));
      return std::nullopt;
    }
    const fs::path file = folder_ / *path;
    try {
      Problems problems(file.string());
      return BaseScene{parse_toml(toml_text(file, "scene"), file, problems), file};
    } catch (const InputError& error) {
      problems_.add(node->source(), error.what());
    }
    return std::nullopt;
  }

  void read_stop() {
    const auto* stop = table("stop", "a table");
    if (stop == nullptr) return;
    require_known_keys(*stop, "stop", {"on", "t_end"}, problems_);
    // The scene's own keys, whose reader says what is wrong with them.
    if (const auto* on = stop->get("on")) set("time.stop_on", *on);
    if (const auto* t_end = stop->get("t_end")) set("time.t_end", *t_end);
  }

  void set(const std::string& key, const toml::node& value) { stop_.emplace_back(key, &value); }

  void read_keep() {
    const auto groups = observable_groups();
    plan_.observables.assign(groups.begin(), groups.end());
    const auto* keep = table("keep", "a table");
    if (keep == nullptr) return;
    require_known_keys(*keep, "keep", {"observables", "folders"}, problems_);
    if (const auto* folders = keep->get("folders")) {
      if (!folders->is_boolean())
        problems_.add(folders->source(),
                      fmt::format("keep.folders must be true or false, not {}", shown(*folders)));
      plan_.folders = folders->value_or(false);
    }
    if (const auto* node = keep->get("observables")) read_observables(*node, groups);
  }

  void read_observables(const toml::node& node, const std::vector<std::string_view>& names) {
    const auto* chosen = node.as_array();
    if (chosen == nullptr) {
      problems_.add(node.source(), fmt::format("keep.observables must be a list of {}, not {}",
                                               fmt::join(names, ", "), shown(node)));
      return;
    }
    std::set<std::string, std::less<>> kept;
    for (const auto& row : observable_table())
      if (row.outcome) kept.emplace(row.group());
    for (const toml::node& element : *chosen) {
      const auto name = element.value_exact<std::string>();
      if (name && std::ranges::find(names, *name) != names.end()) {
        kept.insert(*name);
        continue;
      }
      const std::string help = name ? hint(did_you_mean(*name, names)) : "";
      problems_.add(
          element.source(),
          fmt::format("keep.observables has no {}{}", shown(element),
                      help.empty() ? fmt::format("; observables: {}", fmt::join(names, ", ")) : help));
    }
    std::erase_if(plan_.observables, [&](const std::string& name) { return !kept.contains(name); });
  }

  // ---- axes ---------------------------------------------------------------------------------

  void read_axes() {
    const toml::node* node = root_.get("axis");
    const toml::array* axes = node == nullptr ? nullptr : node->as_array();
    const bool tables = axes != nullptr && !axes->empty() &&
                        std::ranges::all_of(*axes, [](const toml::node& axis) { return axis.is_table(); });
    if (!tables) {
      problems_.add(node == nullptr ? toml::source_region{} : node->source(),
                    "a sweep needs one or more tables [[axis]], each with a key and its values");
      return;
    }
    const auto sampling = read_latin_hypercube();
    std::set<std::string> keys;
    for (const auto& [key, value] : stop_) keys.insert(key);
    for (std::size_t n = 0; n < axes->size(); ++n) {
      const toml::table& one = *axes->get(n)->as_table();
      auto [axis, nodes] = read_axis(one, folder_, sampling, n + 1, problems_);
      if (!axis.key.empty() && !keys.insert(axis.key).second)
        problems_.add(one.get("key")->source(),
                      fmt::format("\"{}\" is set twice: by another axis or by [stop]", axis.key));
      plan_.axes.push_back(std::move(axis));
      nodes_.push_back(std::move(nodes));
    }
    const auto sampled = [](const SweepAxis& axis) { return axis.sampled; };
    if (sampling && problems_.size() == 0 && std::ranges::none_of(plan_.axes, sampled))
      problems_.add(root_.get("latin_hypercube")->source(),
                    "[latin_hypercube] samples no axis: give one min and max, and no num");
    if (problems_.size() == 0) combine();
  }

  std::optional<LatinHypercube> read_latin_hypercube() {
    const auto* given = table("latin_hypercube", "a table");
    if (given == nullptr) return std::nullopt;
    require_known_keys(*given, "latin_hypercube", {"samples", "seed"}, problems_);
    const auto integer = [&](std::string_view name, std::int64_t least, std::int64_t otherwise) {
      const toml::node* node = given->get(name);
      if (node == nullptr && otherwise >= 0) return otherwise;
      const auto value = node == nullptr ? std::nullopt : node->value_exact<std::int64_t>();
      if (value && *value >= least && (name == "seed" || *value <= std::int64_t(most_runs))) return *value;
      problems_.add(node == nullptr ? given->source() : node->source(),
                    fmt::format("latin_hypercube.{} must be an integer, at least {}{}", name, least,
                                name == "seed" ? "" : fmt::format(" and at most {}", most_runs)));
      return least;
    };
    return LatinHypercube{.samples = std::size_t(integer("samples", 2, -1)),
                          .seed = std::uint64_t(integer("seed", 0, 0))};
  }

  // Axes of a group go on together; groups are multiplied, the last is the fastest.
  void combine() {
    bool zip = false;
    if (const toml::node* node = root_.get("combine")) {
      const auto text = node->value_exact<std::string>();
      if (text != "product" && text != "zip") {
        problems_.add(node->source(),
                      fmt::format("combine must be \"product\" or \"zip\", not {}", shown(*node)));
        return;
      }
      zip = text == "zip";
    }
    std::optional<std::size_t> samples;
    for (std::size_t n = 0; n < plan_.axes.size(); ++n) {
      if (zip && n > 0) {
        groups_.front().push_back(n);
      } else if (plan_.axes[n].sampled && samples) {
        groups_[*samples].push_back(n);
      } else {
        if (plan_.axes[n].sampled) samples = groups_.size();
        groups_.push_back({n});
      }
    }
    if (zip) require_equal_lengths();
    std::size_t runs = 1;
    for (const auto& group : groups_) {
      runs *= plan_.axes[group.front()].values.size();
      if (runs <= most_runs) continue;
      problems_.add({}, fmt::format("the axes make more than {} runs, which is the most of a sweep; more "
                                    "sweeps can do more",
                                    most_runs));
      return;
    }
    count_ = runs;
  }

  void require_equal_lengths() {
    const std::size_t length = plan_.axes.front().values.size();
    for (const SweepAxis& axis : plan_.axes) {
      if (axis.values.size() == length) continue;
      problems_.add(region_of(axis.values.front().place),
                    fmt::format("combine = \"zip\": axis \"{}\" has {} values, \"{}\" has {}", axis.key,
                                axis.values.size(), plan_.axes.front().key, length));
    }
  }

  // ---- pairs --------------------------------------------------------------------------------

  void read_pair() {
    const auto* pair = table("pair", "a table");
    if (pair == nullptr) return;
    require_known_keys(*pair, "pair", {"key", "reference"}, problems_);
    const toml::node* key = pair->get("key");
    const auto name = key == nullptr ? std::nullopt : key->value_exact<std::string>();
    std::vector<std::string_view> names;
    for (const SweepAxis& axis : plan_.axes) names.push_back(axis.key);
    const auto axis = std::ranges::find(plan_.axes, name.value_or(""), &SweepAxis::key);
    if (axis == plan_.axes.end() || !name) {
      problems_.add(key == nullptr ? pair->source() : key->source(),
                    fmt::format("pair.key must be the key of an axis ({}){}", fmt::join(names, ", "),
                                name ? fmt::format(", not \"{}\"", printable(*name)) : ""));
      return;
    }
    if (name->starts_with("initial") || name->starts_with("grid")) {
      problems_.add(key->source(), "pair.key: the runs of a pair start from the same state on the same grid");
    } else if (axis->values.size() != 2) {
      if (!axis->values.empty())
        problems_.add(key->source(), fmt::format("pair.key: axis \"{}\" has {} values; a pair needs 2", *name,
                                                 axis->values.size()));
    } else {
      plan_.pairs = SweepPairs{.axis = std::size_t(axis - plan_.axes.begin())};
      choose_reference(*pair, *axis, nodes_[plan_.pairs->axis]);
    }
  }

  // Without a word: what is off, or else the first.
  void choose_reference(const toml::table& pair, const SweepAxis& axis, const toml::array& nodes) {
    const std::string first = toml_value(nodes[0]), second = toml_value(nodes[1]);
    std::string reference = axis.values[1].shown == false ? second : first;
    if (const toml::node* given = pair.get("reference")) {
      reference = toml_value(*given);
      if (reference != first && reference != second)
        problems_.add(given->source(),
                      fmt::format("pair.reference must be {} or {}, not {}", first, second, shown(*given)));
    }
    if (reference == second) std::swap(plan_.pairs->reference, plan_.pairs->other);
  }

  // ---- runs ---------------------------------------------------------------------------------

  std::vector<std::size_t> place_of(std::size_t run) const {
    std::vector<std::size_t> at(plan_.axes.size());
    for (auto group = groups_.rbegin(); group != groups_.rend(); ++group) {
      const std::size_t values = plan_.axes[group->front()].values.size();
      for (const std::size_t axis : *group) at[axis] = run % values;
      run /= values;
    }
    return at;
  }

  void make_runs(const BaseScene& base) {
    plan_.runs.reserve(count_);
    for (std::size_t n = 0; n < count_ && problems_.size() < most_problems; ++n) {
      const std::vector<std::size_t> at = place_of(n);
      std::vector<TableOverride> overrides = stop_;
      for (std::size_t axis = 0; axis < at.size(); ++axis)
        overrides.push_back({plan_.axes[axis].key, nodes_[axis].get(at[axis])});
      Problems problems(base.file.string());
      SweepRun run{at, {}, read_tables(base.tables, base.file, overrides, problems)};
      run.scene.name = plan_.name;
      add_problems(problems, run);
      if (problems.size() == 0) finish(run, n);
    }
  }

  // What concerns several keys at once, or what no key is to blame for.
  void finish(SweepRun& run, std::size_t number) {
    try {
      solver::require_stable_step(run.scene);
      require_memory(run.scene);
      run.id = run_id(run.scene);
      plan_.runs.push_back(std::move(run));
    } catch (const InputError& error) {
      problems_.add({}, fmt::format("run {} ({}): {}", number + 1, words(run), error.what()));
    }
  }

  std::string words(const SweepRun& run) const {
    std::string text;
    for (std::size_t axis = 0; axis < run.at.size(); ++axis)
      text += fmt::format("{}{} = {}", axis == 0 ? "" : ", ", plan_.axes[axis].key,
                          plan_.axes[axis].values[run.at[axis]].shown.dump());
    return text;
  }

  // Those of a value are told where the value stands in the sweep file.
  void add_problems(const Problems& problems, const SweepRun& run) {
    problems_.add_rest(problems, [&](const std::string& key, const std::string& message) {
      for (const auto& [name, node] : stop_)
        if (name == key) problems_.add(node->source(), message);
      for (std::size_t axis = 0; axis < run.at.size(); ++axis)
        if (plan_.axes[axis].key == key)
          problems_.add(region_of(plan_.axes[axis].values[run.at[axis]].place),
                        fmt::format("value {} of axis \"{}\": {}", run.at[axis] + 1, key, message));
    });
  }

  fs::path file_, folder_;
  Problems problems_;
  toml::table root_;
  SweepPlan plan_;
  std::vector<TableOverride> stop_;                 // those of [stop]
  std::vector<toml::array> nodes_;                  // of each axis, what the scene gets
  std::vector<std::vector<std::size_t>> groups_{};  // axes that go on together
  std::size_t count_ = 0;
};

}  // namespace

std::string run_id(const solver::Scene& scene) {
  nlohmann::json configuration = effective_configuration(scene);
  for (const char* shown : {"frames", "fields", "element_areas", "from"})
    configuration["output"].erase(shown);
  configuration["time"].erase("ms_per_tu");
  if (scene.initial.type == solver::InitialSettings::Type::file)
    configuration["initial"]["file"] = content_hash_of_file(scene.initial.file);
  return content_hash(configuration.dump());
}

SweepPlan parse_sweep(std::string_view text, const fs::path& file) { return SweepReader(text, file).read(); }

SweepPlan read_sweep(const fs::path& file) { return parse_sweep(toml_text(file, "sweep"), file); }

}  // namespace myowave::apps
