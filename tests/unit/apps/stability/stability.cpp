// The files of `myowave stability` from a small table, and the command itself.
#include "apps/stability/stability.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/draw/map_picture.hpp"
#include "solver/base/error.hpp"
#include "tests/support/command.hpp"
#include "tests/support/scene_run.hpp"

namespace myowave::apps {
namespace {

using solver::MapCell;
using solver::MapTable;
using test::read_text;
using test::run_myowave;
using ::testing::HasSubstr;

MapTable small_table() {
  MapTable table;
  table.name = "small";
  table.caption = "V < 1 & more";
  table.columns = {{"form", ""}, {"x", "kPa"}, {"dt", "t.u."}, {"bound", "t.u."}, {"noise", ""}};
  table.outcomes = {"right", "wrong"};
  for (const char* form : {"a", "b"})
    for (const double x : {1.0, 2.0})
      for (const double dt : {0.1, 0.3})
        table.rows.push_back({{form, x, dt, 0.2, dt > 0.2 ? MapCell() : MapCell(0.5)}, dt > 0.2, true});
  table.rows.back().handled = false;
  table.view = solver::MapView{{"form"}, "x", "dt", {{"bound", "the bound"}}, "bound"};
  return table;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(StabilityFiles, CsvHasNamesUnitsOutcomeAndEmptyCells) {
  const std::string csv = map_csv(small_table());
  EXPECT_THAT(csv, ::testing::StartsWith("form,x [kPa],dt [t.u.],bound [t.u.],noise,outcome,handled\n"
                                         "\"a\",1,0.1,0.2,0.5,\"right\",yes\n"
                                         "\"a\",1,0.3,0.2,,\"wrong\",yes\n"));
  EXPECT_THAT(csv, ::testing::EndsWith("\"b\",2,0.3,0.2,,\"wrong\",no\n"));
  EXPECT_EQ(count(csv, "\n"), 9u);
}

TEST(StabilityFiles, JsonCounts) {
  const std::vector<MapTable> tables{small_table(), small_table()};
  const auto json = stability_json(tables);
  EXPECT_EQ(json["tried"], 16);
  EXPECT_EQ(json["not_handled"], 2);
  EXPECT_EQ(json["maps"][0]["outcomes"], (nlohmann::ordered_json{{"right", 4}, {"wrong", 4}}));
}

TEST(StabilityFiles, PictureHasACellForEachRunAxesAndLegend) {
  const std::string svg = map_svg(small_table());
  EXPECT_EQ(count(svg, "<rect x="), 8u);
  EXPECT_EQ(count(svg, "<polyline"), 2u);
  for (const char* text : {">x (kPa)<", ">dt / bound<", ">a<", ">b<", ">right<", ">wrong<", ">the bound<"})
    EXPECT_THAT(svg, HasSubstr(text));
  EXPECT_THAT(svg, HasSubstr("V &lt; 1 &amp; more"));
  EXPECT_EQ(count(svg, "<g"), count(svg, "</g>"));
  EXPECT_EQ(count(svg, "nan"), 0u);
}

// dt = 0.1 and 0.3 over the bound 0.2: cells meet half-way, at 1, where the line of the bound is too.
TEST(StabilityFiles, CellsMeetHalfWayBetweenRuns) {
  const std::string svg = map_svg(small_table());
  EXPECT_THAT(svg, HasSubstr("<rect x=\"0.0\" y=\"120.0\" width=\"150.0\" height=\"120.0\""));
  EXPECT_THAT(svg, HasSubstr("<polyline points=\"75.0,120.0 225.0,120.0 \""));
}

TEST(StabilityCommand, UnknownMapIsRefusedWithTheNearest) {
  const auto outcome = run_myowave({"stability", "--map", "dt_sheer", "--out", "/nowhere/at/all"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("there is no map \"dt_sheer\"; did you mean \"dt_shear\"?"));
  EXPECT_THAT(outcome.errors, HasSubstr("dt_rigid"));
}

TEST(StabilityCommand, HelpNamesTheMaps) {
  const auto outcome = run_myowave({"stability", "--help"});
  EXPECT_EQ(outcome.status, 0);
  for (const auto& map : solver::stability_maps()) EXPECT_THAT(outcome.output, HasSubstr(map.name));
}

TEST(StabilityCommand, WritesTableAndPictureOfOneMap) {
  const test::TemporaryFolder folder;
  const std::string out = (folder / "out").string();
  const auto outcome = run_myowave({"stability", "--map", "dt_rigid", "--out", out});
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("not handled: 0"));
  const auto table = test::read_csv(folder / "out/dt_rigid.csv");
  const auto json = nlohmann::json::parse(read_text(folder / "out/stability.json"));
  EXPECT_EQ(json["tried"], table.at("dt [t.u.]").size());
  EXPECT_EQ(json["not_handled"], 0);
  for (const char* outcome_name : {"right", "wrong", "blown up"})
    EXPECT_GT(json["maps"][0]["outcomes"][outcome_name], 0) << outcome_name;
  EXPECT_THAT(read_text(folder / "out/dt_rigid.svg"), HasSubstr("dx (length units)"));

  EXPECT_EQ(run_myowave({"stability", "--map", "dt_rigid", "--out", out}).status, 2);
}

}  // namespace
}  // namespace myowave::apps
