// A map of stability: runs over a grid of inputs and what became of each. Filled here, written and
// drawn by apps/stability.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace myowave::solver {

// Empty: does not apply, or was not found.
using MapCell = std::variant<std::monostate, double, std::string>;

struct MapColumn {
  std::string name;
  std::string unit;  // empty: dimensionless, or a word
};

struct MapRow {
  std::vector<MapCell> cells;  // in the order of MapTable::columns
  std::size_t outcome = 0;     // index into MapTable::outcomes
  bool handled = true;         // false: nothing would have told that the result is not right
};

struct MapLine {
  std::string column, label;
};

// How a table is drawn: a panel for each combination of values of some columns, in it a cell for each
// row at (x, y) in the colour of its outcome, and what theory expects of y over x as lines. All are names
// of columns.
struct MapView {
  std::vector<std::string> panels;
  std::string x, y;
  std::vector<MapLine> lines;
  std::string y_in;  // y and the lines are drawn in multiples of this column; empty: as they are
  bool log_x = false, log_y = false;
};

struct MapTable {
  std::string name;     // of its files, "dt_stretch"
  std::string caption;  // what was run, in a sentence or two
  std::vector<MapColumn> columns;
  std::vector<std::string> outcomes;  // from the best to the worst
  std::vector<MapRow> rows;
  std::vector<std::string> findings;  // what the rows say, lines of Markdown
  std::optional<MapView> view;        // empty: not drawn
};

// Told the part done, 0 to 1.
using MapProgress = std::function<void(double)>;

}  // namespace myowave::solver
