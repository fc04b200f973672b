#include "tests/support/random_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <stdexcept>
#include <string_view>
#include <variant>

#include "apps/input/schema.hpp"
#include "solver/mechanics/rest_state.hpp"

namespace myowave::test {
namespace {

// Three digits, so that a scene can be read.
double rounded(double value) { return std::strtod(fmt::format("{:.3g}", value).c_str(), nullptr); }

std::string text_of(double value) { return fmt::format("{}", value); }

const apps::Key& key_of(std::string_view section, std::string_view name) {
  return *apps::find_key(*apps::find_section(section), name);
}

std::string in_quotes(std::string_view text) { return fmt::format("'{}'", text); }

// Keys whose values hang together, or make runs that are longer, larger or less stable than a test can take:
// they have rules of their own below, or are left out (a start from a file or after minutes of settling).
// Every other key of the schema is drawn from its range.
const std::map<std::string_view, std::set<std::string_view>> ruled{
    {"grid", {"n", "dx"}},
    {"time", {"dt", "t_end"}},
    {"excitation", {"a", "b", "k", "eps", "mu1", "mu2", "C_m", "D"}},
    {"tension", {"law", "eps0", "eps_below", "eps_above", "k_Ta"}},
    {"mechanics",
     {"on", "cells_per_element", "c1", "c2", "load", "p", "interval", "tolerance", "contraction"}},
    {"feedback", {"metric"}},
    {"initial", {"type", "dx", "r0", "offset", "core_offset", "file", "window", "noise", "seed"}},
    {"initial.precondition", {"duration", "contraction"}},
    {"stimulus", {"start", "period", "duration", "amplitude", "count", "region"}},
    {"accuracy", {"preset", "dx", "scheme"}},
    {"output", {"every", "tips_every", "probes_every", "probes", "period_from", "from", "checkpoint_every"}}};

class RandomScene {
 public:
  explicit RandomScene(std::uint64_t seed) : draw_(seed) {}

  SceneText make() {
    excitation();
    grid_and_mechanics();
    time();
    tension();
    initial();
    for (int n = draw_.integer(-3, 2); n > 0; --n) precondition();
    for (int n = draw_.integer(-1, 3); n > 0; --n) stimulus();
    output();
    accuracy();
    other_keys();
    return std::move(scene_);
  }

 private:
  // One of the words that the schema has for the key.
  std::string word(std::string_view section, std::string_view key) {
    return in_quotes(draw_.one_of(std::get<apps::Choice>(key_of(section, key).kind).names));
  }

  // ---- any key, from its range alone --------------------------------------------------------------------

  void other_keys() {
    for (const apps::Section& section : apps::schema()) {
      const std::string name(section.name);
      // [mechanics] makes a sheet elastic: a rigid scene has none.
      if (!section.repeated && name != "mechanics" && scene_.find(name) == nullptr) scene_.add(name);
      for (auto& table : scene_.tables)
        if (table.section == name) add_other_keys(section, table);
    }
    std::erase_if(scene_.tables,
                  [](const auto& table) { return table.lines.empty() && table.section != "mechanics"; });
  }

  void add_other_keys(const apps::Section& section, SceneText::Table& table) {
    constexpr double probability = 0.4;
    const auto here = ruled.find(section.name);
    for (const apps::Key& key : section.keys) {
      const bool other_type = !key.only_type.empty() && key.only_type != type_;
      if (other_type || (here != ruled.end() && here->second.contains(key.name))) continue;
      if (draw_.chance(probability)) table.lines.push_back({std::string(key.name), any_value(key)});
    }
  }

  std::string any_value(const apps::Key& key) {
    return std::visit(
        apps::Overloaded{
            [&](const apps::Number& kind) { return text_of(any_number(key, kind.range)); },
            [&](const apps::Integer& kind) {
              return fmt::format("{:.0f}", std::round(any_number(key, kind.range)));
            },
            [&](const apps::Flag&) -> std::string { return draw_.chance(0.5) ? "true" : "false"; },
            [&](const apps::Choice& kind) { return in_quotes(draw_.one_of(kind.names)); },
            [&](const apps::Choices& kind) { return any_of(kind.names); },
            [&](const auto&) -> std::string {
              throw std::logic_error(
                  fmt::format("{}: a kind of key that needs a rule of its own here", key.name));
            },
        },
        key.kind);
  }

  // An end of the range, a value of the size of the default, or where both ends are near any between them.
  double any_number(const apps::Key& key, const apps::Range& range) {
    constexpr double near = 1e3;
    const double end = draw_.chance(0.5) ? range.low : range.high;
    if (std::abs(end) < near && range.contains(end) && draw_.chance(0.2)) return end;
    if (range.high - range.low < near) {
      const double value = rounded(draw_.number(range.low, range.high));
      return range.contains(value) ? value : range.high;
    }
    const double usual = std::strtod(apps::default_text(key).c_str(), nullptr);
    const double size = usual == 0 ? draw_.log_number(1e-6, 20) : usual * draw_.log_number(0.1, 10);
    const double value = rounded(draw_.chance(0.2) ? -size : size);
    return range.contains(value) ? value : range.contains(-value) ? -value : usual;
  }

  std::string any_of(std::vector<std::string_view> names) {
    std::string list;
    for (int n = draw_.integer(0, static_cast<int>(names.size())); n > 0; --n) {
      const std::string_view name = draw_.one_of(names);
      list += fmt::format("{}, ", in_quotes(name));
      std::erase(names, name);
    }
    return "[" + list + "]";
  }

  // ---- keys whose values hang together ------------------------------------------------------------------

  // With some probability a value other than the default.
  double maybe(const std::string& section, const std::string& key, double usual, double low, double high,
               double probability = 0.4) {
    if (!draw_.chance(probability)) return usual;
    const double value = std::clamp(rounded(draw_.number(low, high)), low, high);
    scene_.set(section, key, text_of(value));
    return value;
  }

  bool flag(const std::string& section, const std::string& key, double probability) {
    const bool value = draw_.chance(probability);
    scene_.set(section, key, value ? "true" : "false");
    return value;
  }

  void excitation() {
    a_ = maybe("excitation", "a", 0.1, 0, 1);
    k_ = draw_.chance(0.1) ? 0 : maybe("excitation", "k", 8, 0, 30);
    if (k_ == 0) scene_.set("excitation", "k", "0");
    maybe("excitation", "b", 0.1, -0.2, 1);
    maybe("excitation", "eps", 0.01, 0, 0.1);
    maybe("excitation", "mu1", 0.12, 0, 0.3);
    mu2_ = maybe("excitation", "mu2", 0.3, 0.05, 2);
    C_m_ = maybe("excitation", "C_m", 1, 0.3, 3);
    D_ = maybe("excitation", "D", 1, 0, 3);
  }

  void grid_and_mechanics() {
    deforms_ = draw_.chance(0.5);
    const int cells = deforms_ ? draw_.one_of(std::vector{1, 2, 3, 5, 10}) : 1;
    const int largest = deforms_ ? std::min(60 / cells, 12) : 59;
    rows_ = draw_.integer(1, largest) * cells + 1;
    columns_ = draw_.chance(0.4) ? rows_ : draw_.integer(1, largest) * cells + 1;
    const bool square = rows_ == columns_ && draw_.chance(0.5);
    scene_.set("grid", "n", square ? fmt::format("{}", rows_) : fmt::format("[{}, {}]", rows_, columns_));
    dx_ = 0.6;
    if (draw_.chance(0.5)) scene_.set("grid", "dx", text_of(dx_ = rounded(draw_.log_number(0.1, 3))));
    if (deforms_) mechanics(cells);
    if (draw_.chance(deforms_ ? 0.7 : 0.1))
      scene_.set("feedback", "metric", metric_ = word("feedback", "metric"));
  }

  void mechanics(int cells) {
    scene_.set("mechanics", "cells_per_element", fmt::format("{}", cells));
    solver::MechanicsSettings settings;
    settings.c1 = maybe("mechanics", "c1", settings.c1, 0, 5, 0.3);
    settings.c2 = maybe("mechanics", "c2", settings.c2, 0.5, 12, 0.3);
    if (draw_.chance(0.2)) {
      // Others leave the sheet without a stable rest state.
      const double largest = std::min(25.0, 0.9 * solver::largest_dead_load(settings));
      scene_.set("mechanics", "load", "'dead'");
      scene_.set("mechanics", "p", text_of(rounded(draw_.number(0, largest))));
    } else {
      if (draw_.chance(0.2)) scene_.set("mechanics", "load", "'follower'");
      maybe("mechanics", "p", 10, -15, 25);
    }
    if (draw_.chance(0.7)) scene_.set("mechanics", "interval", fmt::format("{}", draw_.integer(1, 100)));
    if (draw_.chance(0.3))
      scene_.set("mechanics", "tolerance", text_of(rounded(draw_.log_number(1e-10, 1e-4))));
    contracts_ = flag("mechanics", "contraction", 0.7);
    if (draw_.chance(0.15)) deforms_ = flag("mechanics", "on", 0.5);
    if (!deforms_) contracts_ = false;
  }

  void time() {
    const double bound = std::min(0.9, 2 * C_m_ / (8 * D_ / (dx_ * dx_) + k_ * std::max(a_, 1 - a_)));
    // A sheet that contracts needs a smaller step than the undeformed one.
    dt_ = rounded(bound * draw_.number(0.05, deforms_ ? 0.4 : 0.98));
    steps_ = draw_.integer(0, 300);
    scene_.set("time", "dt", text_of(dt_));
    scene_.set("time", "t_end", text_of(draw_.chance(0.7) ? steps_ * dt_ : (steps_ + 0.3) * dt_));
  }

  // A rate times dt must be at most 1.
  void tension() {
    const double largest_rate = 0.99 / dt_;
    std::vector<std::string> laws{"delayed"};
    if (largest_rate > 10) laws.emplace_back("printed");
    if (!contracts_) laws.emplace_back("none");
    law_ = draw_.one_of(laws);
    if (law_ != "delayed" || draw_.chance(0.3)) scene_.set("tension", "law", fmt::format("'{}'", law_));
    if ((own_eps0_ = draw_.chance(0.2))) {
      const double law_rate = law_ == "printed" ? 10 : 1;
      scene_.set("tension", "eps0", text_of(rounded(draw_.log_number(0.01, largest_rate / law_rate))));
    }
    for (const char* key : {"eps_below", "eps_above"})
      if (draw_.chance(0.2))
        scene_.set("tension", key, text_of(rounded(draw_.log_number(0.01, largest_rate))));
    maybe("tension", "k_Ta", 47.9, 0, 60);
  }

  void initial() {
    type_ = draw_.chance(0.6) ? "broken_front" : "rest";
    if (type_ != "rest" || draw_.chance(0.3)) scene_.set("initial", "type", in_quotes(type_));
    if (type_ == "broken_front") {
      maybe("initial", "r0", 1.5, 0, 3);
      if (draw_.chance(0.5)) {
        const int column = draw_.integer(0, columns_ - 1) - (columns_ - 1) / 2;
        const int row = draw_.integer(0, rows_ - 1) - (rows_ - 1) / 2;
        scene_.set("initial", "offset", fmt::format("[{}, {}]", column, row));
      }
    }
    // no node of some thousand at V <= -mu2, which is refused
    if (maybe("initial", "noise", 0, 0, std::min(0.2, mu2_ / 6), 0.3) > 0)
      scene_.set("initial", "seed", fmt::format("{}", draw_.integer(0, 1 << 30)));
  }

  // Its rates, k and D are at most the scene's, for which dt is chosen.
  void precondition() {
    auto& table = scene_.add("initial.precondition");
    table.lines.push_back({"duration", text_of(draw_.number(0.6, 100) * dt_)});
    std::string law = law_;
    if (!own_eps0_ && draw_.chance(0.3)) {
      law = draw_.chance(0.7) ? "delayed" : "none";
      table.lines.push_back({"law", fmt::format("'{}'", law)});
    }
    if (deforms_ && law != "none" && draw_.chance(0.5)) table.lines.push_back({"contraction", "true"});
    if (draw_.chance(0.5)) table.lines.push_back({"mu1", text_of(rounded(draw_.number(0, 0.3)))});
    if (draw_.chance(0.3)) table.lines.push_back({"b", text_of(rounded(draw_.number(0, 0.3)))});
    if (draw_.chance(0.2)) table.lines.push_back({"k", text_of(k_ * draw_.number(0, 1))});
    if (draw_.chance(0.2)) table.lines.push_back({"D", text_of(D_ * draw_.number(0, 1))});
    if (draw_.chance(0.2)) table.lines.push_back({"k_Ta", text_of(rounded(draw_.number(0, 50)))});
  }

  void stimulus() {
    auto& table = scene_.add("stimulus");
    const double part_of_step = draw_.chance(0.3) ? 0.37 : 0;
    const double duration = (draw_.integer(1, 80) + part_of_step) * dt_;
    const double amplitude = draw_.chance(0.8) ? draw_.number(0, 3) : draw_.number(-1, 0);
    table.lines.push_back({"amplitude", text_of(rounded(amplitude))});
    if (draw_.chance(0.6)) table.lines.push_back({"start", text_of(draw_.number(0, 1.1) * steps_ * dt_)});
    if (draw_.chance(0.4)) {
      table.lines.push_back({"period", text_of(duration * draw_.number(1, 3))});
      if (draw_.chance(0.5)) table.lines.push_back({"count", fmt::format("{}", draw_.integer(-1, 5))});
    } else if (draw_.chance(0.2)) {
      table.lines.push_back({"count", draw_.chance(0.3) ? "0" : "1"});
    }
    table.lines.push_back({"duration", text_of(duration)});
    if (draw_.chance(0.8)) table.lines.push_back({"region", region()});
  }

  std::string region() {
    const auto side = [&](int nodes) {
      const int first = draw_.integer(0, nodes - 1);
      return fmt::format("[{}, {}]", first, draw_.integer(first, nodes - 1));
    };
    // Quarters of a node spacing, so that the mirrored centre is exact.
    const auto center = [&](int nodes) { return draw_.integer(0, 4 * (nodes - 1)) / 4.0; };
    switch (draw_.integer(0, 4)) {
      case 0:
        return "'all'";
      case 1:
        return fmt::format("{{columns = {}}}", side(columns_));
      case 2:
        return fmt::format("{{rows = {}}}", side(rows_));
      case 3: {
        const std::string columns = side(columns_);
        return fmt::format("{{columns = {}, rows = {}}}", columns, side(rows_));
      }
      default: {
        const double x = center(columns_), y = center(rows_), radius = draw_.number(0.75, 20);
        return fmt::format("{{center = [{}, {}], radius = {}}}", x, y, rounded(radius));
      }
    }
  }

  void output() {
    for (const char* key : {"every", "tips_every", "probes_every"})
      if (draw_.chance(0.5)) scene_.set("output", key, text_of(draw_.integer(1, 60) * dt_));
    if (draw_.chance(0.4)) {
      std::string list;
      for (int n = draw_.integer(0, 3); n > 0; --n) {
        const int row = draw_.integer(0, rows_ - 1);
        list += fmt::format("[{}, {}], ", row, draw_.integer(0, columns_ - 1));
      }
      scene_.set("output", "probes", "[" + list + "]");
    }
    maybe("output", "period_from", 100, 0, 10);
    maybe("output", "from", 0, 0, 1.1 * steps_ * dt_, 0.2);
    maybe("output", "checkpoint_every", 0, 0, 1.1 * steps_ * dt_, 0.2);
  }

  void accuracy() {
    const bool expanded = metric_ == "'expanded'";
    if (!expanded && draw_.chance(0.4)) scene_.set("accuracy", "scheme", word("accuracy", "scheme"));
    // dt is the scene's own, for its own spacing.
    if (!expanded && draw_.chance(0.2)) {
      scene_.set("accuracy", "preset", word("accuracy", "preset"));
      scene_.set("accuracy", "dx", "0");
    } else if (draw_.chance(0.2)) {
      scene_.set("accuracy", "dx", text_of(rounded(dx_ * draw_.number(1, 3))));
      // The mirrored centre of a disc would be off by a rounding.
      for (auto& table : scene_.tables)
        if (table.section == "stimulus")
          std::erase_if(table.lines, [](const auto& line) { return line.key == "region"; });
    }
    if (draw_.chance(0.2)) scene_.set("initial", "dx", text_of(dx_ / draw_.integer(1, 3)));
  }

  Draw draw_;
  SceneText scene_;
  std::string metric_, type_ = "rest";
  int rows_ = 0, columns_ = 0, steps_ = 0;
  bool deforms_ = false, contracts_ = false, own_eps0_ = false;
  double a_ = 0, k_ = 0, mu2_ = 0, C_m_ = 0, D_ = 0, dx_ = 0, dt_ = 0;
  std::string law_;
};

// Values at the ends of a range, or far out.
std::vector<double> extremes(const apps::Range& range) {
  std::vector<double> values;
  for (const double size : {1e-300, 1e-30, 1e-9, 1e-3, 1e3, 1e9, 1e30, 1e300})
    for (const double value : {size, -size})
      if (range.contains(value)) values.push_back(value);
  for (const double end : {range.low, range.high})
    if (std::isfinite(end) && range.contains(end)) values.push_back(end);
  return values;
}

}  // namespace

double Draw::log_number(double low, double high) { return std::exp(number(std::log(low), std::log(high))); }

int Draw::integer(int low, int high) {
  return std::min(high, low + static_cast<int>(std::floor(number(0, high - low + 1))));
}

SceneText::Table* SceneText::find(const std::string& section) {
  const auto found = std::ranges::find(tables, section, &Table::section);
  return found == tables.end() ? nullptr : &*found;
}

SceneText::Table& SceneText::add(const std::string& section) {
  tables.push_back({section, {}});
  return tables.back();
}

void SceneText::set(const std::string& section, const std::string& key, const std::string& value) {
  Table* const there = find(section);
  Table& table = there == nullptr ? add(section) : *there;
  const auto line = std::ranges::find(table.lines, key, &Line::key);
  if (line == table.lines.end())
    table.lines.push_back({key, value});
  else
    line->value = value;
}

int SceneText::line_of(const std::string& section, const std::string& key) const {
  int line = 0;
  for (const Table& table : tables) {
    ++line;
    for (const Line& one : table.lines) {
      ++line;
      if (table.section == section && one.key == key) return line;
    }
  }
  return 0;
}

std::string SceneText::text() const {
  std::string text;
  for (const Table& table : tables) {
    const bool repeated = apps::find_section(table.section)->repeated;
    text += repeated ? "[[" + table.section + "]]\n" : "[" + table.section + "]\n";
    for (const Line& line : table.lines) text += fmt::format("{} = {}\n", line.key, line.value);
  }
  return text;
}

SceneText random_scene(std::uint64_t seed) { return RandomScene(seed).make(); }

SceneText random_extreme_scene(std::uint64_t seed) {
  SceneText scene = random_scene(seed);
  // A sheet of any size on another grid may have more nodes than the memory holds.
  scene.set("initial", "dx", "0");
  scene.set("accuracy", "dx", "0");
  Draw draw(~seed);
  // The values of the others belong together, or make a run that never ends.
  const std::vector<std::string> sections{"grid",      "excitation", "excitation", "tension",
                                          "mechanics", "initial",    "stimulus"};
  for (int n = draw.integer(1, 3); n > 0; --n) {
    const std::string section = draw.one_of(sections);
    SceneText::Table* const table = scene.find(section);
    if (table == nullptr) continue;
    if (section == "stimulus") {
      table->lines.front().value = text_of(draw.one_of(extremes({})));
      continue;
    }
    std::vector<const apps::Key*> keys;
    for (const apps::Key& key : apps::find_section(section)->keys)
      if (std::holds_alternative<apps::Number>(key.kind) && key.only_type.empty() &&
          !(section == "initial" && key.name == "dx"))
        keys.push_back(&key);
    const apps::Key& key = *draw.one_of(keys);
    scene.set(section, std::string(key.name),
              text_of(draw.one_of(extremes(std::get<apps::Number>(key.kind).range))));
  }
  return scene;
}

std::pair<std::uint64_t, std::uint64_t> seeds(std::uint64_t count) {
  const char* const text = std::getenv("MYOWAVE_SEEDS");
  if (text == nullptr) return {1, count};
  char* rest = nullptr;
  const std::uint64_t first = std::strtoull(text, &rest, 10);
  return {first, *rest == '-' ? std::strtoull(rest + 1, nullptr, 10) : first};
}

}  // namespace myowave::test
