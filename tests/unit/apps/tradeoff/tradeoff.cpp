#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/input/scene_file.hpp"
#include "apps/input/schema.hpp"
#include "apps/tradeoff/tradeoff_errors.hpp"
#include "apps/tradeoff/tradeoff_settings.hpp"
#include "solver/base/error.hpp"

namespace myowave::apps {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

template <class Action>
std::string refusal_of(const Action& action) {
  try {
    action();
  } catch (const solver::InputError& error) {
    return error.what();
  }
  return "accepted";
}

solver::Scene elastic_scene() {
  solver::Scene scene;
  scene.mechanics.emplace();
  return scene;
}

TEST(ParetoFront, HasWhatNoOtherBeats) {
  const std::vector<double> cost{1, 2, 3, 4, 2, 1, 5, 0.5}, error{8, 4, 4, 1, 4, 9, nan, infinity};
  EXPECT_THAT(pareto_front(cost, error), ElementsAre(true, true, false, true, true, false, false, false));
}

TEST(ErrorTargets, AreMetByTheCheapest) {
  const std::vector<Candidate> candidates{{5, {{"cv", {0.1}}, {"period", {0.1}}}},
                                          {2, {{"cv", {0.9}}, {"period", {0.8}}}},
                                          {1, {{"cv", {0.5}}, {"period", {3}}}},
                                          {0.5, {{"cv", {0.1}}}}};
  const auto both = parse_targets({"period=1%,cv=1"});
  EXPECT_EQ(choose(candidates, both), 1u);
  const auto strict = parse_targets({"period=0.05%", "cv=2%"});
  EXPECT_FALSE(choose(candidates, strict));
  EXPECT_EQ(nearest_to(candidates, strict), 0u);
  EXPECT_FALSE(nearest_to(candidates, parse_targets({"tip=1"})));
}

TEST(ErrorTargets, ReportWhatIsWrong) {
  const auto refusal = [](const std::string& text) {
    return refusal_of([&] { return parse_targets({text}); });
  };
  EXPECT_THAT(refusal("perod=1%"), HasSubstr("no error \"perod\"; did you mean \"period\"?"));
  EXPECT_THAT(refusal("cv"), HasSubstr("must be cv=E with a number E > 0 (%)"));
  EXPECT_THAT(refusal("cv=0"), HasSubstr("E > 0"));
  EXPECT_THAT(refusal("tip=1%"), HasSubstr("(length units)"));
}

TEST(Axes, AreReadWithValuesAndWithout) {
  const solver::Scene scene = elastic_scene();
  const auto axes = parse_axes("time.dt=0.01, 0.02; precision,mechanics.interval ;scheme=split", scene);
  ASSERT_EQ(axes.size(), 4u);
  EXPECT_EQ(axes[0], (DialValues{"time.dt", {"0.01", "0.02"}}));
  EXPECT_EQ(axes[1], (DialValues{"accuracy.precision", {"float64", "float32"}}));
  EXPECT_EQ(axes[2].values.size(), 6u);
  EXPECT_EQ(axes[3], (DialValues{"accuracy.scheme", {"split"}}));
  EXPECT_THAT(parse_axes("dx", scene)[0].values, ElementsAre("0.3", "0.4", "0.5", "0.6", "0.75", "1", "1.2"));
}

TEST(Axes, ReportWhatIsWrong) {
  const auto refusal = [](std::string_view text, const solver::Scene& scene) {
    return refusal_of([&] { return parse_axes(text, scene); });
  };
  EXPECT_THAT(refusal("time.dr=0.1", elastic_scene()),
              HasSubstr("no dial \"time.dr\"; did you mean \"time.dt\"?"));
  EXPECT_THAT(refusal("dt=", elastic_scene()), HasSubstr("must be time.dt=VALUE,VALUE"));
  EXPECT_THAT(refusal("dt=0.1,scheme=split", elastic_scene()), HasSubstr("a semicolon ends it"));
  EXPECT_THAT(refusal("dt;time.dt=0.1", elastic_scene()), HasSubstr("named twice"));
  EXPECT_THAT(refusal("mechanics.interval", {}), HasSubstr("no effect: the sheet of this scene is rigid"));
}

TEST(Axes, OfARigidSceneHaveNoDialsOfTheMechanics) {
  const auto rigid = parse_axes("", {});
  EXPECT_EQ(rigid.size(), 5u);
  for (const auto& axis : rigid) EXPECT_THAT(axis.key, Not(HasSubstr("mechanics")));
  EXPECT_EQ(parse_axes("", elastic_scene()).size(), dials().size());
  EXPECT_TRUE(parse_axes("none", {}).empty());
}

TEST(Settings, ArePresetsAndOneDialAtATimeOrAllCombinations) {
  const std::vector<DialValues> axes{{"time.dt", {"0.01", "0.02"}}, {"accuracy.scheme", {"euler", "split"}}};
  const auto alone = make_settings(axes, false);
  ASSERT_EQ(alone.size(), 4u + 2 * 4);
  EXPECT_EQ(alone[0].name, "paper");
  EXPECT_EQ(alone[4].name, "paper, time.dt=0.01");
  EXPECT_THAT(alone[4].overrides, ElementsAre("accuracy.preset=paper", "time.dt=0.01"));
  const auto all = make_settings(axes, true);
  ASSERT_EQ(all.size(), 4u + 2 * 4);
  EXPECT_THAT(all.back().overrides,
              ElementsAre("accuracy.preset=balanced", "time.dt=0.02", "accuracy.scheme=split"));
  EXPECT_THAT(refusal_of([] { return make_settings(parse_axes("", elastic_scene()), true); }),
              HasSubstr("more than 1000 combinations"));
}

// dt is 0.2 / (7 k^2), a solve comes each 0.4 / k.
TEST(References, HaveDtWithTheSquareOfDxAndTheIntervalWithDx) {
  EXPECT_THAT(reference_overrides(elastic_scene(), 1),
              testing::IsSupersetOf({"accuracy.dx=0.6", "mechanics.interval=14"}));
  EXPECT_THAT(reference_overrides(elastic_scene(), 2),
              testing::IsSupersetOf({"accuracy.dx=0.3", "mechanics.interval=28"}));
  EXPECT_THAT(reference_overrides(elastic_scene(), 3),
              testing::IsSupersetOf({"accuracy.dx=0.2", "mechanics.interval=42"}));
  EXPECT_THAT(reference_overrides({}, 2), testing::Contains("time.dt=0.0125"));
  EXPECT_THAT(parse_levels("1, 2,4"), ElementsAre(1, 2, 4));
  for (const char* wrong : {"2,3", "2,2,3", "0,1,2", "a,b,c", ""})
    EXPECT_THAT(refusal_of([&] { return parse_levels(wrong); }), HasSubstr("three integers")) << wrong;
}

// The reference is the same whatever --set gives of the dials.
TEST(References, DoNotDependOnOverrides) {
  constexpr const char* scene = "[grid]\nn = 61\n[mechanics]\n";
  std::vector<std::string> overrides{"accuracy.precision=float32", "mechanics.tolerance=1e-3"};
  const auto own = reference_overrides(elastic_scene(), 2);
  overrides.insert(overrides.end(), own.begin(), own.end());
  EXPECT_EQ(effective_configuration(parse_scene(scene, "sheet.toml", overrides)),
            effective_configuration(parse_scene(scene, "sheet.toml", own)));
}

TEST(OverriddenText, GivesTheSceneOfTheOverrides) {
  constexpr const char* scene =
      "[grid]\nn = 61\n[time]\ndt = 0.01\n[mechanics]\ninterval = 20\n[[stimulus]]\namplitude = 2\n";
  for (const auto& overrides :
       std::vector<std::vector<std::string>>{{},
                                             {"time.dt=0.02"},
                                             {"accuracy.preset=fast"},
                                             {"accuracy.preset=balanced", "mechanics.interval=40",
                                              "stimulus.0.region={center=[30,30],radius=3}"},
                                             {"accuracy.preset=reference", "mechanics.on=false"}}) {
    const std::string text = overridden_text(scene, "sheet.toml", overrides);
    EXPECT_EQ(effective_configuration(parse_scene(text, "sheet.toml")),
              effective_configuration(parse_scene(scene, "sheet.toml", overrides)))
        << text;
  }
  EXPECT_THAT(overridden_text("[initial]\ntype = 'file'\nfile = 'a.h5'\n", "/scenes/sheet.toml", {}),
              HasSubstr("/scenes/a.h5"));
}

Measures made(double cv, std::vector<double> V, double tips = 1) {
  Measures measures;
  measures.numbers = {{"cv", cv}, {"tips", tips}};
  measures.V_end = std::move(V);
  return measures;
}

TEST(References, AreExtrapolatedOfNumbersAndTheFinestGridOfFields) {
  std::vector<Measures> levels;
  for (const int k : {2, 3, 4}) levels.push_back(made(2 - 1. / (k * k), {1 + 1. / (k * k), 1}));
  const Reference reference = make_reference({2, 3, 4}, levels, {});
  EXPECT_FALSE(reference.chaotic);
  EXPECT_NEAR(reference.best.numbers.at("cv"), 2, 1e-9);
  EXPECT_NEAR(*reference.values.at("cv").order, 2, 1e-6);
  EXPECT_NEAR(reference.values.at("cv").uncertainty, 100. / 32, 1e-6);
  EXPECT_NEAR(*reference.values.at("field_end").order, 2, 0.1);
  EXPECT_FALSE(reference.values.contains("tips")) << "means are used only where single paths are chaotic";
  const Errors errors = errors_of(std::vector{made(1.5, {0, 1})}, reference);
  EXPECT_NEAR(errors.at("cv").value, 25, 1e-6);
  EXPECT_EQ(errors.at("cv").uncertainty, reference.values.at("cv").uncertainty);
  EXPECT_NEAR(errors.at("field_end").value, 100 * 1.0625 / std::hypot(1.0625, 1), 1e-6);
}

TEST(References, OfAChaoticSceneAreMeansOverStarts) {
  const std::vector<Measures> levels{made(1, {1, 0}), made(1.1, {0, 1}), made(1.15, {1, 0})};
  const std::vector<Measures> starts{made(1, {}, 4), made(1, {}, 6)};
  const Reference reference = make_reference({1, 2, 3}, levels, starts);
  EXPECT_TRUE(reference.chaotic);
  EXPECT_FALSE(reference.values.contains("field_end"));
  EXPECT_EQ(reference.best.numbers.at("tips"), 5);
  EXPECT_NEAR(reference.values.at("tips").uncertainty, 100 * 1 / 5., 1e-9);
  const std::vector runs{made(1, {}, 2), made(1, {}, 6)};
  const Error error = errors_of(runs, reference).at("tips");
  EXPECT_NEAR(error.value, 20, 1e-9);
  EXPECT_NEAR(error.uncertainty, 100 * std::hypot(1, 2) / 5, 1e-9) << "that of the difference of two means";
  EXPECT_TRUE(error.is_below());
}

Measures breaking_up(std::optional<double> t, std::vector<double> V_end) {
  Measures measures;
  if (t) measures.numbers["breakup"] = *t;
  measures.V_end = std::move(V_end);
  return measures;
}

TEST(References, OfABreakUpAreItsTime) {
  std::vector<Measures> levels;
  for (const int k : {1, 2, 3}) levels.push_back(breaking_up(200 + 9. / (k * k), {1, 0}));
  const Reference reference = make_reference({1, 2, 3}, levels, {});
  EXPECT_NEAR(*reference.values.at("breakup").value, 200, 1e-6);
  EXPECT_NEAR(errors_of(std::vector{breaking_up(190, {})}, reference).at("breakup").value, 10, 1e-6);
  EXPECT_EQ(errors_of(std::vector{breaking_up({}, {})}, reference).at("breakup").value, infinity);
}

// The state after a break-up is chaotic; its time need not be.
TEST(References, OfABreakUpIntoChaosAreItsMeanTime) {
  const std::vector levels{breaking_up(200, {1, 0}), breaking_up(203, {0, 1}), breaking_up(204, {1, 0})};
  const std::vector starts{breaking_up(201, {}), breaking_up({}, {}), breaking_up(203, {})};
  const Reference reference = make_reference({1, 2, 3}, levels, starts);
  ASSERT_TRUE(reference.chaotic);
  EXPECT_NEAR(*reference.values.at("breakup").value, 202, 1e-9);
  EXPECT_THAT(reference.values.at("breakup").how, HasSubstr("2 of 3 starts"));
  const std::vector runs{breaking_up(190, {}), breaking_up(194, {}), breaking_up({}, {})};
  const Error error = errors_of(runs, reference).at("breakup");
  EXPECT_NEAR(error.value, 10, 1e-9);
  EXPECT_NEAR(error.uncertainty, std::hypot(1, 2), 1e-9);
}

TEST(References, ReportABreakUpOfASettingAlone) {
  const std::vector levels(3, breaking_up({}, {1, 0}));
  const Reference reference = make_reference({1, 2, 3}, levels, {});
  EXPECT_FALSE(errors_of(std::vector{breaking_up({}, {})}, reference).contains("breakup"));
  EXPECT_EQ(errors_of(std::vector{breaking_up(190, {})}, reference).at("breakup").value, infinity);
}

TEST(Errors, OfCurvesAreOfTheDistanceFromOne) {
  Measures reference, run;
  for (double t = 0; t < 10; t += 0.2) {
    reference.area.t.push_back(t);
    reference.area.value.push_back(1 - 0.1 * std::sin(t));
  }
  for (double t = 0.5; t < 9; t += 0.7) {
    run.area.t.push_back(t);
    run.area.value.push_back(1 - 0.11 * std::sin(t));
  }
  EXPECT_NEAR(*error_of(*find_observable("area"), run, reference), 10, 0.01);
}

TEST(Errors, OfTipsAreDistancesToTheNearestOfTheSameTurn) {
  Measures reference, run;
  reference.tips = {{0, 0, 1}, {10, 0, -1}};
  EXPECT_FALSE(error_of(*find_observable("tip"), run, reference));
  run.tips = {{3, 4, 1}, {10, 1, -1}, {0, 1, -1}};
  EXPECT_DOUBLE_EQ(*error_of(*find_observable("tip"), run, reference), 3);
  run.tips = {{3, 4, 1}};
  EXPECT_FALSE(error_of(*find_observable("tip"), run, reference)) << "no tip has the other charge";
}

}  // namespace
}  // namespace myowave::apps
