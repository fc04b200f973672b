// The scene schema: each key of a scene file once, with its type, unit, range, meaning and the place
// in solver::Scene that it is written to. Validation, `myowave describe`, the reference in
// apps/input/REFERENCE.md, the effective configuration and `--set` all come from this table.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "solver/scene/scene.hpp"

namespace myowave::apps {

// What the keys of one table are written to. Only a stimulus table has `stimulus`, only a
// precondition has `precondition`; `excitation` and `tension` are the scene's or the precondition's.
struct Target {
  solver::Scene& scene;
  solver::ExcitationSettings& excitation;
  solver::TensionSettings& tension;
  solver::Stimulus* stimulus = nullptr;
  solver::Precondition* precondition = nullptr;

  explicit Target(solver::Scene&);
  Target(solver::Scene&, solver::Stimulus&);
  Target(solver::Scene&, solver::Precondition&);
};

struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;

  bool contains(double value) const;
  bool bounded() const;
  std::string text() const;  // "> 0", ">= 2", "0 to 1"; "finite" where there is no bound
};

// The types of a value. `get` is empty where the value only acts on others (eps0).
struct Number {
  std::function<double(const Target&)> get;
  std::function<void(Target&, double)> set;
  Range range;
};
struct Integer {
  std::function<std::int64_t(const Target&)> get;
  std::function<void(Target&, std::int64_t)> set;
  Range range;
};
struct Flag {
  std::function<bool(const Target&)> get;
  std::function<void(Target&, bool)> set;
};
struct Choice {
  std::vector<std::string_view> names;
  std::function<std::size_t(const Target&)> get;
  std::function<void(Target&, std::size_t)> set;
};
// A list of some of the names, each at most once; a flag a name.
struct Choices {
  std::vector<std::string_view> names;
  std::function<std::vector<bool>(const Target&)> get;
  std::function<void(Target&, const std::vector<bool>&)> set;
};
struct Path {
  std::function<std::string(const Target&)> get;
  std::function<void(Target&, const std::string&)> set;
};
// Two integers, for example [columns, rows].
struct Pair {
  std::string_view parts;
  std::function<std::array<int, 2>(const Target&)> get;
  std::function<void(Target&, std::array<int, 2>)> set;
  Range range;
};
// An integer or [rows, columns].
struct Size {
  Range range;
};
// [[row, column], ...]
struct Probes {};
// "all", {center = [column, row], radius = R} or {columns = [a, b], rows = [a, b]}
struct Region {};

using Kind = std::variant<Number, Integer, Flag, Choice, Choices, Path, Pair, Size, Probes, Region>;

// For std::visit over the kinds.
template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};

struct Key {
  std::string_view name;
  std::string_view unit;  // empty: dimensionless
  Kind kind;
  std::string_view doc;
  std::string_view default_text{};  // where it is not one value of a default Scene
  bool required = false;
  std::string_view only_type{};  // the initial type that this key belongs to
};

// What a word of a section stands for.
struct Note {
  std::string name, text;
};

struct Section {
  std::string_view name;
  std::string_view doc;
  std::vector<Key> keys;
  bool repeated = false;                     // an array of tables
  std::vector<std::string_view> inherits{};  // sections whose keys stand here by their bare names
  std::vector<Note> notes{};
};

const std::vector<Section>& schema();
const Section* find_section(std::string_view name);
const Key* find_key(const Section&, std::string_view name);

std::string type_text(const Kind&);        // "number", "\"delayed\" | \"printed\"", ...
std::string range_text(const Kind&);       // empty where the type says it all
std::string requirement_text(const Key&);  // what a value has to be, with its unit
std::string default_text(const Key&);

// The scene reference of one section ("" for all) for a terminal, and of all as Markdown tables.
// Errors: InputError for a section that does not exist.
std::string describe(std::string_view section);
std::string describe_markdown();

// The value in force, null for a key that only acts on others.
nlohmann::json value_of(const Key&, const Target&);

// Every value in force, defaults included, in the shape of a scene file.
nlohmann::json effective_configuration(const solver::Scene&);

}  // namespace myowave::apps
