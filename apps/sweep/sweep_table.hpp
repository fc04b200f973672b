// The table of a sweep: a row a run, from the records of all shards.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/sweep/sweep_folder.hpp"

namespace myowave::apps {

struct SweepTable {
  StoredPlan plan;
  std::vector<std::string> columns;                        // apps/sweep/README.md; those of the axes first
  std::vector<std::vector<nlohmann::ordered_json>> cells;  // null: none
  std::vector<std::size_t> runs;                           // of each row, its number in the plan
  std::size_t missing = 0;                                 // runs without a record
  std::size_t failed = 0, other_revision = 0;
  std::vector<std::string> refused;  // invalid lines of the files

  // Errors: std::out_of_range where there is no such column.
  std::size_t column(std::string_view name) const;
};

// Rows in the order of the plan. Errors: InputError if the folder is not that of a sweep.
SweepTable read_table(const std::filesystem::path& sweep_folder);

// RFC 4180: cells with commas or quotes stand in quotes. An empty cell: none.
std::string table_csv(const SweepTable&);
// {"columns", "rows" (objects), "missing", "failed"}
std::string table_json(const SweepTable&);
// Aligned, for a terminal; columns that are empty in all rows are left out.
std::string table_text(const SweepTable&);

}  // namespace myowave::apps
