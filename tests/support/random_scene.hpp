// Scenes drawn at random inside the ranges of the schema, as the text of a scene file. A seed gives the same
// text on every platform.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/sheets.hpp"

namespace myowave::test {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : uniform_(seed) {}

  double number(double low, double high) { return uniform_(low, high); }
  double log_number(double low, double high);
  int integer(int low, int high);  // both included
  bool chance(double probability) { return uniform_() < probability; }
  template <class T>
  const T& one_of(const std::vector<T>& all) {
    return all[static_cast<std::size_t>(integer(0, static_cast<int>(all.size()) - 1))];
  }

 private:
  Uniform uniform_;
};

// A scene file: its tables in their order, each with keys and values as they stand there, one a line.
struct SceneText {
  struct Line {
    std::string key, value;
  };
  struct Table {
    std::string section;  // as the schema names it: "grid", "initial.precondition"
    std::vector<Line> lines;
  };
  std::vector<Table> tables;

  Table* find(const std::string& section);
  Table& add(const std::string& section);
  // Puts a value in place of the one there is; a table or key that is missing is added.
  void set(const std::string& section, const std::string& key, const std::string& value);
  // Number, from 1, of the line of a key in text(); 0 where it is missing.
  int line_of(const std::string& section, const std::string& key) const;
  std::string text() const;
};

// A scene that is valid: a sheet of 2 to 61 nodes a side and at most 300 steps, dt inside the bound of the
// undeformed sheet. initial.type is `rest` or `broken_front`.
SceneText random_scene(std::uint64_t seed);

// The same with one to three of its numbers at an end of their range, or far out where there is no end. What
// becomes of it is open; that it has an orderly end is not.
SceneText random_extreme_scene(std::uint64_t seed);

// Seeds first ... last, in both: `count` from 1 on, or those of the environment variable
// MYOWAVE_SEEDS = "first-last" or "seed".
std::pair<std::uint64_t, std::uint64_t> seeds(std::uint64_t count);

}  // namespace myowave::test
