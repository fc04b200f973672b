// Reading the results of a run.
#include "apps/results/run_results.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "solver/base/error.hpp"
#include "tests/support/command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace myowave::apps {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

void write(const fs::path& path, const char* text) { std::ofstream(path) << text; }

TEST(CsvTable, LeavesOutARowThatWasNotFinished) {
  const test::TemporaryFolder folder;
  const fs::path file = folder / "table.csv";
  write(file, "t,x,name\n0,1.5,a\n1,,b\n2,3");
  const CsvTable table = read_csv(file);
  EXPECT_THAT(table.columns, ElementsAre("t", "x", "name"));
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_THAT(table.numbers("t"), ElementsAre(0, 1));
  EXPECT_EQ(table.numbers("x")[0], 1.5);
  EXPECT_TRUE(std::isnan(table.numbers("x")[1]));
  EXPECT_EQ(table.rows[1][table.index_of("name")], "b");
  EXPECT_TRUE(table.has("x"));
  EXPECT_FALSE(table.has("y"));
  EXPECT_THROW(table.numbers("y"), std::out_of_range);
}

TEST(CsvTable, LastRowWithoutItsEndMayBeCutInANumber) {
  const test::TemporaryFolder folder;
  write(folder / "table.csv", "t,x\n0,1\n1,23");
  EXPECT_THAT(read_csv(folder / "table.csv").numbers("x"), ElementsAre(1));
}

TEST(RunResults, ReadsFramesOfADeformedSheet) {
  const test::TemporaryFolder folder;
  write(folder / "scene.toml",
        "[grid]\nn = [11, 21]\n[time]\nt_end = 2\n[mechanics]\n[output]\nevery = 1\nfields = true\n"
        "[[stimulus]]\namplitude = 0.5\n");
  const auto out = folder / "out";
  ASSERT_EQ(
      test::run_myowave({"run", (folder / "scene.toml").string(), "--out", out.string(), "--quiet"}).status,
      0);
  const RunResults run(out);
  EXPECT_THAT(run.frame_times(), ElementsAre(0, 1, 2));
  const StoredFrame first = run.frame(0), last = run.last_frame();
  EXPECT_EQ(last.t, 2);
  EXPECT_EQ(last.shape.rows, 11);
  EXPECT_EQ(last.shape.columns, 21);
  EXPECT_EQ(last.shape.cells, 10);
  EXPECT_EQ(last.shape.dx, 0.6);
  EXPECT_EQ(first.V, std::vector<double>(231, 0.0));
  EXPECT_GT(last.V[0], 0.3);
  // 1 x 2 elements: nodes of the loaded rest state, stretched by 1.1293 both ways.
  ASSERT_EQ(first.nodes.size(), 12u);
  EXPECT_NEAR(first.nodes[2] - first.nodes[0], 6 * 1.1293425101, 1e-6);
  EXPECT_THROW(run.frame(3), solver::InputError);
}

TEST(RunResults, ReportsWhatIsMissing) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(RunResults{folder.path()}, solver::InputError);
  write(folder / "summary.json", "{ \"t\": ");
  EXPECT_THROW(RunResults{folder.path()}, solver::InputError);
  write(folder / "summary.json", "{}");
  const RunResults run(folder.path());
  EXPECT_TRUE(run.frame_times().empty());
  EXPECT_THROW(run.last_frame(), solver::InputError);
  EXPECT_THROW(run.csv("tips.csv"), solver::InputError);
}

}  // namespace
}  // namespace myowave::apps
