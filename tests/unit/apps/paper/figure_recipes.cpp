// The recipes of the paper's figures: every run is a valid, stable scene, and figures are found by number.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <map>

#include "apps/input/scene_file.hpp"
#include "apps/paper/reproduce.hpp"
#include "solver/base/error.hpp"
#include "solver/run/stages.hpp"
#include "tests/support/temporary_folder.hpp"

namespace myowave::apps {
namespace {

using testing::HasSubstr;

// The scenes of all runs, by name. The states that they start from are empty files.
class Scenes {
 public:
  explicit Scenes(Extent extent) {
    for (const auto& recipe : figure_recipes())
      for (const Job& job : recipe.jobs(extent)) {
        for (const auto& need : job.needs) make_state(need);
        scenes_[job.name] = parse_scene(job.scene, folder_ / ("scenes/" + job.name + ".toml"));
      }
  }
  const std::map<std::string, solver::Scene>& all() const { return scenes_; }

 private:
  void make_state(const std::string& job) {
    std::filesystem::create_directories(folder_ / ("runs/" + job));
    std::filesystem::create_directories(folder_ / "scenes");
    std::ofstream(folder_ / ("runs/" + job + "/fields.h5")) << "";
  }

  test::TemporaryFolder folder_;
  std::map<std::string, solver::Scene> scenes_;
};

class Extents : public testing::TestWithParam<Extent> {};
INSTANTIATE_TEST_SUITE_P(, Extents, testing::Values(Extent::full, Extent::quick));

TEST_P(Extents, EveryRunIsAValidStableScene) {
  const Scenes scenes(GetParam());
  EXPECT_GT(scenes.all().size(), 40u);
  for (const auto& [name, scene] : scenes.all()) EXPECT_NO_THROW(solver::require_stable_step(scene)) << name;
}

TEST_P(Extents, RunsOfOneNameAreTheSame) {
  std::map<std::string, std::string> scenes;
  for (const auto& recipe : figure_recipes())
    for (const Job& job : recipe.jobs(GetParam())) {
      const auto [known, is_new] = scenes.emplace(job.name, job.scene);
      EXPECT_EQ(known->second, job.scene) << job.name;
    }
}

// Rigid and contracting runs that are compared differ only in the mechanics.
TEST(FigureRecipes, PairsStartFromTheSameState) {
  const Scenes all(Extent::full);
  const auto& scenes = all.all();
  int pairs = 0;
  for (const auto& [name, rigid] : scenes) {
    const auto at = name.find("rigid");
    if (at == std::string::npos) continue;
    const auto contracting = scenes.find(std::string(name).replace(at, 5, "contracting"));
    if (contracting == scenes.end()) continue;
    ++pairs;
    EXPECT_FALSE(rigid.mechanics) << name;
    ASSERT_TRUE(contracting->second.mechanics) << name;
    EXPECT_EQ(rigid.initial.type, contracting->second.initial.type) << name;
    EXPECT_EQ(rigid.initial.file, contracting->second.initial.file) << name;
    EXPECT_EQ(rigid.initial.core_offset, contracting->second.initial.core_offset) << name;
    EXPECT_EQ(rigid.excitation.mu1, contracting->second.excitation.mu1) << name;
    EXPECT_EQ(rigid.time.t_end, contracting->second.time.t_end) << name;
  }
  EXPECT_GE(pairs, 40 + 8 + 3);  // Figs 11, 10 and 7
}

TEST(FigureRecipes, AreFoundByNumber) {
  EXPECT_EQ(choose_figures({}).size(), figure_recipes().size());
  EXPECT_EQ(choose_figures({"3", "all"}).size(), figure_recipes().size());
  const auto chosen = choose_figures({"11", "2"});
  ASSERT_EQ(chosen.size(), 2u);
  EXPECT_EQ(chosen[0].number, "2");
  EXPECT_EQ(chosen[1].number, "11");
  try {
    choose_figures({"sizes"});
    FAIL();
  } catch (const solver::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean \"size\"?"));
  }
}

TEST(FigureCsv, HoldsEveryPointOfEveryCurve) {
  const double gap = std::numeric_limits<double>::quiet_NaN();
  const Figure figure{
      .columns = 1,
      .panels = {SheetPicture{},
                 Plot{.title = "a",
                      .series = {{.name = "s", .x = {1, 2, 3}, .y = {4, gap, 6}, .error = {0.5, 0, 1}},
                                 {.name = "", .x = {7}, .y = {8}}}}}};
  EXPECT_EQ(figure_csv(figure),
            "panel,title,series,x,y,error\n1,\"a\",\"s\",1,4,0.5\n1,\"a\",\"s\",3,6,1\n1,\"a\",\"\",7,8,\n");
  EXPECT_EQ(figure_csv({.panels = {SheetPicture{}}}), "");
}

}  // namespace
}  // namespace myowave::apps
