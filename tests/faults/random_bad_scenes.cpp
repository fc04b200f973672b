// Random scenes with an error by construction. Each is refused with the place of the error, through the
// library and through the executable. MYOWAVE_SEEDS = "17" or "1001-4000" runs other seeds than the default
// ones.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "apps/base/memory.hpp"
#include "apps/input/scene_file.hpp"
#include "apps/input/schema.hpp"
#include "solver/base/error.hpp"
#include "solver/run/make_plan.hpp"
#include "solver/run/run.hpp"
#include "tests/support/command.hpp"
#include "tests/support/random_scene.hpp"
#include "tests/support/temporary_folder.hpp"

namespace myowave::test {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;

const std::string file_name = "bad.toml";

struct BadScene {
  std::string text;
  std::vector<std::string> overrides;
  std::string place;  // start of a line of the message: "bad.toml:3:"; empty: any place in the file
};

std::string at_line(int line) { return fmt::format("{}:{}:", file_name, line); }
std::string number(double value) { return fmt::format("{}", value); }

// ---- wrong values, from the schema ----------------------------------------------------------------------

using Values = std::vector<std::string>;

// No value of any kind of key.
const Values never{"1979-05-27", "07:32:00", "9223372036854775808", "1e", "0b2", "'open", "{a = 1, a = 2}"};

void add_outside(const apps::Range& range, Values& values) {
  if (std::isfinite(range.low)) {
    for (const double below : {range.low - 1, range.low - 1e-9, -1e300}) values.push_back(number(below));
    if (range.low_open) values.push_back(number(range.low));
  }
  if (std::isfinite(range.high))
    for (const double above : {range.high * (1 + 1e-9), range.high + 1, 1e300})
      values.push_back(number(above));
}

struct WrongValues {
  Values operator()(const apps::Number& kind) const {
    Values values{"'0.5'", "true", "[0.5]", "{}", "nan", "inf", "-inf"};
    add_outside(kind.range, values);
    return values;
  }
  Values operator()(const apps::Integer& kind) const {
    Values values{"'5'", "false", "[5]", "{}", "5.0", "1e3", "nan", "inf"};
    for (const double value : {kind.range.low - 1, kind.range.high + 1})
      if (std::isfinite(value)) values.push_back(fmt::format("{}", static_cast<std::int64_t>(value)));
    return values;
  }
  Values operator()(const apps::Flag&) const { return {"1", "0.0", "'true'", "[true]", "{}", "nan"}; }
  Values operator()(const apps::Choice&) const { return {"1", "true", "''", "'x'", "['rest']", "{}", "nan"}; }
  Values operator()(const apps::Choices& kind) const {
    const std::string first = fmt::format("'{}'", kind.names.front());
    return {"1", "true", first, "[1]", "['x']", "[" + first + ", " + first + "]", "[[" + first + "]]", "{}"};
  }
  Values operator()(const apps::Path&) const { return {"1", "true", "''", "['a']", "{}"}; }
  Values operator()(const apps::Pair& kind) const {
    Values values{"3", "true", "'a'", "[]", "[1]", "[1, 2, 3]", "[0.5, 1]", "['a', 1]", "[1, 2147483648]",
                  "{}"};
    if (kind.range.low == 0) values.emplace_back("[0, -1]");
    return values;
  }
  Values operator()(const apps::Size&) const {
    return {"1", "0", "-5", "10000001", "5.0", "'5'", "true", "[5]", "[5, 5, 5]", "[1, 5]", "[[5, 5]]", "{}"};
  }
  Values operator()(const apps::Probes&) const {
    return {"3", "true", "'all'", "[3, 4]", "[[1]]", "[[1, 2, 3]]", "[[0.5, 1]]", "[[0, 0], 3]", "{}"};
  }
  Values operator()(const apps::Region&) const {
    return {"3",
            "'left'",
            "true",
            "[0, 1]",
            "{}",
            "{center = [1, 1]}",
            "{radius = 2}",
            "{center = [1], radius = 2}",
            "{center = [1, nan], radius = 2}",
            "{center = [1, 1], radius = -1}",
            "{center = [1, 1], radius = 2, rows = [0, 1]}",
            "{centre = [1, 1], radius = 2}",
            "{columns = 3}",
            "{columns = [0]}",
            "{rows = [0.5, 1]}"};
  }
};

struct Named {
  std::string section;
  const apps::Key* key;
};

Named any_key(Draw& draw) {
  std::vector<Named> keys;
  for (const apps::Section& section : apps::schema()) {
    for (const apps::Key& key : section.keys) keys.push_back({std::string(section.name), &key});
    for (const std::string_view other : section.inherits)
      for (const apps::Key& key : apps::find_section(other)->keys)
        keys.push_back({std::string(section.name), &key});
  }
  return draw.one_of(keys);
}

// A table of an array needs its required keys, so that the error under test is the only one.
void complete(SceneText& scene, const std::string& section) {
  if (scene.find(section) != nullptr) return;
  if (section == "stimulus") scene.set(section, "amplitude", "1");
  if (section == "initial.precondition") scene.set(section, "duration", "1");
}

BadScene wrong_value(Draw& draw, SceneText scene) {
  const Named one = any_key(draw);
  Values values = std::visit(WrongValues{}, one.key->kind);
  values.insert(values.end(), never.begin(), never.end());
  complete(scene, one.section);
  const std::string key(one.key->name);
  scene.set(one.section, key, draw.one_of(values));
  return {scene.text(), {}, at_line(scene.line_of(one.section, key))};
}

BadScene wrong_override(Draw& draw, SceneText scene) {
  Named one = any_key(draw);
  while (apps::find_section(one.section)->repeated) one = any_key(draw);
  const std::string path = fmt::format("{}.{}", one.section, one.key->name);
  const std::string value = draw.one_of(std::visit(WrongValues{}, one.key->kind));
  return {scene.text(), {path + "=" + value}, fmt::format("--set {}: {}", path, path)};
}

BadScene malformed_override(Draw& draw, SceneText scene) {
  const Values texts{"",          "=",         "grid.n",       "=5",        ".grid.n=5", "grid.n.=5",
                     "grid..n=5", "gr id.n=5", "grid.\"n\"=5", "grid[n]=5", "[grid]n=5", "grid.n\n=5"};
  const std::string text = draw.one_of(texts);
  return {scene.text(), {text}, "--set "};
}

// ---- wrong names and tables -----------------------------------------------------------------------------

std::string unknown_word(Draw& draw) {
  std::string word = "x";  // no key or section starts with it
  for (int n = draw.integer(1, 12); n > 0; --n) word += static_cast<char>('a' + draw.integer(0, 25));
  return word;
}

SceneText::Table& any_table(Draw& draw, SceneText& scene) {
  return scene.tables[static_cast<std::size_t>(draw.integer(0, static_cast<int>(scene.tables.size()) - 1))];
}

int lines_of(const std::string& text) { return static_cast<int>(std::ranges::count(text, '\n')); }

BadScene unknown_key(Draw& draw, SceneText scene) {
  const std::string section = any_table(draw, scene).section, word = unknown_word(draw);
  scene.set(section, word, "1");
  return {scene.text(), {}, at_line(scene.line_of(section, word))};
}

BadScene unknown_section(Draw& draw, SceneText scene) {
  const std::string text = scene.text(), word = unknown_word(draw);
  const Values headers{"[{}]\na = 1", "[[{}]]\na = 1", "[{}]", "[{0}.{0}]", "[grid.{}]\nn = 5"};
  return {
      text + fmt::format(fmt::runtime(draw.one_of(headers)), word) + "\n", {}, at_line(lines_of(text) + 1)};
}

BadScene section_of_another_kind(Draw& draw, SceneText scene) {
  std::vector<std::string> names;
  for (const apps::Section& section : apps::schema())
    if (section.name.find('.') == std::string_view::npos) names.emplace_back(section.name);
  const std::string name = draw.one_of(names);
  std::erase_if(scene.tables, [&](const auto& table) { return table.section.starts_with(name); });
  const Values values{"5", "'rest'", "true", "[1, 2]", "0.5", "1979-05-27"};
  return {fmt::format("{} = {}\n", name, draw.one_of(values)) + scene.text(), {}, at_line(1)};
}

BadScene duplicate(Draw& draw, SceneText scene) {
  const std::string section = any_table(draw, scene).section;
  if (!apps::find_section(section)->repeated && draw.chance(0.3)) {
    const std::string text = scene.text();
    return {text + fmt::format("[{}]\n", section), {}, at_line(lines_of(text) + 1)};
  }
  // At the end of the last table, where its line is known.
  auto& table = scene.tables.back();
  table.lines.push_back(draw.one_of(table.lines));
  return {scene.text(), {}, at_line(lines_of(scene.text()))};
}

BadScene missing_key(Draw& draw, SceneText scene) {
  const std::string text = scene.text();
  const std::string table =
      draw.chance(0.5) ? "[[stimulus]]\nstart = 1\n" : "[[initial.precondition]]\nmu1 = 0.1\n";
  return {text + table, {}, at_line(lines_of(text) + 1)};
}

// ---- no TOML --------------------------------------------------------------------------------------------

BadScene broken_line(Draw& draw, SceneText scene) {
  const Values lines{"dx =",
                     "dx = = 1",
                     "dx = [1, 2",
                     "dx = \"open",
                     "dx = 'open",
                     "dx = {a = 1",
                     "dx 5",
                     "= 3",
                     "dx = 1 2",
                     "dx = 01",
                     "dx = 1__0",
                     "dx = tru",
                     "dx = 0x",
                     "dx = 1e",
                     "dx = +",
                     "dx = .5",
                     "dx = 5.",
                     "dx = \"\\q\"",
                     "[grid",
                     "[]",
                     "[[grid]",
                     "[grid]]",
                     "[grid] n",
                     "\"\"\"open",
                     "dx = [1,,2]",
                     "dx = \"\"\"open",
                     "dx.= 1",
                     "dx..n = 1",
                     "dx = \"\\uD800\"",
                     "dx == 1"};
  const std::string text = scene.text(), line = draw.one_of(lines);
  // At a random line, or as the end of a file that was cut off.
  if (draw.chance(0.5)) return {text + line, {}, ""};
  std::size_t at = 0;
  for (int n = draw.integer(0, lines_of(text)); n > 0; --n) at = text.find('\n', at) + 1;
  return {text.substr(0, at) + line + "\n" + text.substr(at), {}, ""};
}

// Bytes that no TOML holds: control characters, and what is no UTF-8 (a lone continuation, an overlong form,
// a surrogate, a code point past the last one, a character cut short).
BadScene alien_bytes(Draw& draw, SceneText scene) {
  const Values aliens{std::string(1, '\0'),
                      "\x01",
                      "\x07",
                      "\x08",
                      "\x0b",
                      "\x0e",
                      "\x1b",
                      "\x1f",
                      "\x7f",
                      "\x80",
                      "\xbf",
                      "\xc0\x80",
                      "\xc3(",
                      "\xe2\x82\n",
                      "\xed\xa0\x80",
                      "\xf4\x90\x80\x80",
                      "\xf8\x88",
                      "\xfe",
                      "\xff"};
  std::string text = (draw.chance(0.3) ? "# a comment\n" : "") + scene.text();
  const std::size_t at = static_cast<std::size_t>(draw.integer(0, static_cast<int>(text.size())));
  text.insert(at, draw.one_of(aliens));
  return {text, {}, ""};
}

BadScene random_bytes(Draw& draw, SceneText) {
  std::string text;
  for (int n = draw.integer(1, 4000); n > 0; --n) text += static_cast<char>(draw.integer(0, 255));
  return {text + '\xff', {}, ""};
}

BadScene deep_nesting(Draw& draw, SceneText scene) {
  const std::string text = scene.text();
  const int depth = draw.integer(1, draw.chance(0.5) ? 300 : 60000);
  const auto repeated = [&](const char* part) {
    std::string all;
    for (int n = 0; n < depth; ++n) all += part;
    return all;
  };
  switch (draw.integer(0, 4)) {
    case 0:
      return {text + "[xa]\na = " + repeated("[") + repeated("]"), {}, ""};
    case 1:
      return {text + "[xa]\na = " + repeated("[") + "\n", {}, ""};
    case 2:
      return {text + "[xa]\na = " + repeated("{a=") + "1" + repeated("}"), {}, ""};
    case 3:
      return {text + "[xa" + repeated(".a") + "]\n", {}, ""};
    default:
      return {"xa" + repeated(".a") + " = 1\n" + text, {}, ""};
  }
}

// ---- values that do not go together -----------------------------------------------------------------------

BadScene contradiction(Draw& draw, SceneText scene) {
  scene.set("initial", "dx", "0");  // so that all keys are in nodes of one grid
  scene.set("accuracy", "dx", "0");
  const solver::Scene valid = apps::parse_scene(scene.text(), file_name);
  const double dt = valid.time.dt;
  const int columns = valid.grid.columns, rows = valid.grid.rows, n = draw.integer(0, 40);
  const auto stimulus = [&](const std::string& lines) {
    return BadScene{scene.text() + "[[stimulus]]\namplitude = 1\n" + lines, {}, ""};
  };
  const auto put = [&](const std::vector<std::array<std::string, 3>>& values) {
    for (const auto& [section, key, value] : values) scene.set(section, key, value);
    return BadScene{scene.text(), {}, ""};
  };
  const auto region = [&](const std::string& text) {
    return stimulus(fmt::format("duration = {}\nregion = {{{}}}\n", 10 * dt, text));
  };
  switch (draw.integer(0, 20)) {
    case 0:
      return put({{"mechanics", "on", "true"},
                  {"mechanics", "cells_per_element", number(n + 2)},
                  {"grid", "n", number((n + 2) * (n + 1) + 1 + draw.integer(1, n + 1))}});
    case 1:
      return put({{"initial", "type", "'broken_front'"},
                  {"initial", "offset", fmt::format("[{}, 0]", columns - (columns - 1) / 2 + n)}});
    case 2:
      return put(
          {{"initial", "type", "'broken_front'"}, {"initial", "offset", fmt::format("[0, {}]", -rows - n)}});
    case 3:
      return put({{"output", "probes", fmt::format("[[0, 0], [{}, 0]]", rows + n)}});
    case 4:
      return put({{"output", "probes", fmt::format("[[0, {}]]", -1 - n)}});
    case 5:
      return region(fmt::format("columns = [0, {}]", columns + n));
    case 6:
      return region(fmt::format("rows = [{}, 0]", 1 + n));
    case 7:
      return region(fmt::format("center = [{}, 0], radius = 2", columns - 0.5 + n));
    case 8:
      return region("center = [0.5, 0.5], radius = 0.7");
    case 9:
      return stimulus(fmt::format("duration = {}\nperiod = {}\n", (n + 3) * dt, (n + 2) * dt));
    case 10:
      return stimulus(fmt::format("duration = {}\ncount = {}\n", dt, n + 2));
    case 11:
      return stimulus(fmt::format("duration = {}\n", 0.99 * dt));
    case 12:
      return put({{"output", draw.chance(0.5) ? "tips_every" : "probes_every", number((n + 0.5) * dt)}});
    case 13:
      return put({{"mechanics", "on", "true"}, {"mechanics", "c1", "0"}, {"mechanics", "c2", "0"}});
    case 14:
      return put({{"tension", draw.chance(0.5) ? "eps_above" : "eps_below", number((n + 1.01) / dt)}});
    case 15:
      return put({{"initial", "type", "'rest'"}, {"initial", draw.chance(0.5) ? "r0" : "width", "2"}});
    case 16:
      return put({{"time", "t_end", number(dt * 1.1e15)}});
    case 17:
      return put(
          {{"mechanics", "on", "true"}, {"mechanics", "contraction", "true"}, {"tension", "law", "'none'"}});
    case 18:
      scene.set("mechanics", "on", "false");
      return {scene.text() + "[[initial.precondition]]\nduration = 1\ncontraction = true\n", {}, ""};
    case 19:
      return put({{"grid", "dx", fmt::format("1e{}", draw.chance(0.5) ? 155 + n : -155 - n)}});
    default:
      return put({{"initial", "type", "'file'"}, {"initial", "file", fmt::format("'no/such_{}.h5'", n)}});
  }
}

// ---- how they are refused ---------------------------------------------------------------------------------

struct Family {
  const char* name;
  BadScene (*make)(Draw&, SceneText);
  int draws;  // of each seed
};

const Family families[] = {
    {"wrong value", wrong_value, 6},
    {"wrong value of --set", wrong_override, 4},
    {"malformed --set", malformed_override, 1},
    {"unknown key", unknown_key, 1},
    {"unknown section", unknown_section, 1},
    {"section of another kind", section_of_another_kind, 1},
    {"given twice", duplicate, 1},
    {"missing key", missing_key, 1},
    {"broken line", broken_line, 3},
    {"alien bytes", alien_bytes, 3},
    {"random bytes", random_bytes, 1},
    {"deep nesting", deep_nesting, 1},
    {"contradiction", contradiction, 4},
};

BadScene bad_scene(const Family& family, std::uint64_t seed, int draw_number) {
  Draw draw(seed * 1000 + static_cast<std::uint64_t>(draw_number) + 1);
  return family.make(draw, random_scene(seed));
}

std::string start_of(const std::string& text) {
  return text.size() < 3000 ? text : text.substr(0, 3000) + " ...";
}

// A line of the message starts with the place.
void expect_refusal(const std::string& message, const std::string& place) {
  if (place.empty()) {
    EXPECT_THAT(message, ContainsRegex(file_name + ":[0-9]+:[0-9]+: ."));
  } else {
    EXPECT_THAT("\n" + message, HasSubstr("\n" + place));
  }
  EXPECT_LT(message.size(), 20000U) << "the message is too long to read";
}

TEST(RandomBadScenes, AreRefusedAtTheirPlace) {
  const auto [first, last] = seeds(30);
  int tried = 0, not_handled = 0;
  for (const Family& family : families) {
    for (std::uint64_t seed = first; seed <= last; ++seed)
      for (int n = 0; n < family.draws; ++n) {
        const BadScene bad = bad_scene(family, seed, n);
        SCOPED_TRACE(fmt::format("{}, MYOWAVE_SEEDS={}, draw {}: {}\n{}", family.name, seed, n,
                                 fmt::join(bad.overrides, " "), start_of(bad.text)));
        ++tried;
        try {
          apps::parse_scene(bad.text, file_name, bad.overrides);
          ADD_FAILURE() << "was accepted";
          ++not_handled;
        } catch (const solver::InputError& error) {
          expect_refusal(error.what(), bad.place);
        } catch (const std::exception& other) {
          ADD_FAILURE() << "another exception: " << other.what();
          ++not_handled;
        }
      }
  }
  fmt::print("read_scene: {} invalid scenes tried, {} not handled\n", tried, not_handled);
}

TEST(RandomBadScenes, AreStatus2OfTheExecutable) {
  const TemporaryFolder folder;
  const std::string scene = (folder / file_name).string(), out = (folder / "out").string();
  const auto [first, every] = seeds(3);
  const std::uint64_t last = std::min(every, first + 19);  // a process takes longer than a call
  int tried = 0, not_handled = 0;
  for (const Family& family : families)
    for (std::uint64_t seed = first; seed <= last; ++seed) {
      const BadScene bad = bad_scene(family, seed, 0);
      SCOPED_TRACE(fmt::format("{}, MYOWAVE_SEEDS={}: {}\n{}", family.name, seed,
                               fmt::join(bad.overrides, " "), start_of(bad.text)));
      std::ofstream(scene, std::ios::binary) << bad.text;
      std::vector<std::string> arguments{"run", scene, "--out", out};
      if (seed % 2 == 0) arguments = {"check", scene};
      for (const std::string& one : bad.overrides) arguments.insert(arguments.end(), {"--set", one});
      const Outcome outcome = run_myowave(arguments);
      ++tried;
      if (outcome.status != 2) ++not_handled;
      EXPECT_EQ(outcome.status, 2) << outcome.errors;
      EXPECT_THAT(outcome.errors, HasSubstr(bad.overrides.empty() ? file_name + ":" : "--set"));
      EXPECT_EQ(outcome.output, "");
      EXPECT_FALSE(std::filesystem::exists(out));
    }
  fmt::print("myowave: {} invalid scenes tried, {} not handled\n", tried, not_handled);
}

// Sheets of at least 2e6 x 2e6 nodes: 32 TB for V alone.
TEST(RandomBadScenes, OfAbsurdSizeAreRefusedBeforeAnyMemoryIsTaken) {
  const TemporaryFolder folder;
  const std::string file = (folder / file_name).string();
  const auto [first, last] = seeds(20);
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    Draw draw(seed);
    SceneText text;
    const int rows = draw.integer(2000000, 10000000);
    text.set("grid", "n", fmt::format("[{}, {}]", rows, draw.integer(2000000, 10000000)));
    if (draw.chance(0.5)) text.set("accuracy", "precision", "'float32'");
    if (draw.chance(0.5)) text.set("mechanics", "cells_per_element", "1");
    if (draw.chance(0.5)) text.set("initial", "type", "'broken_front'");
    SCOPED_TRACE(text.text());
    const solver::Scene scene = apps::parse_scene(text.text(), file_name);
    EXPECT_GT(static_cast<double>(solver::memory_bytes(scene)), 8.0 * scene.grid.rows * scene.grid.columns);
    EXPECT_THROW(apps::require_memory(scene), solver::InputError);
    if (seed - first >= 4) continue;
    std::ofstream(file) << text.text();
    const Outcome outcome = run_myowave({seed % 2 == 0 ? "check" : "run", file});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.errors, HasSubstr("of memory and"));
  }
  rusage used{};
  getrusage(RUSAGE_CHILDREN, &used);
  EXPECT_LT(used.ru_maxrss, 1 << 20) << "KiB of the largest process";
}

}  // namespace
}  // namespace myowave::test
