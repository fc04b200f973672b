#include "apps/draw/figure.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "apps/draw/plot_axes.hpp"
#include "tests/support/png.hpp"
#include "tests/support/python.hpp"
#include "tests/support/temporary_folder.hpp"

namespace myowave::apps {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// The mean position of all pixels of a colour.
Point middle_of(const Picture& picture, Colour colour) {
  double x = 0, y = 0, n = 0;
  for (int row = 0; row < picture.height(); ++row)
    for (int column = 0; column < picture.width(); ++column) {
      const Colour& c = picture.at(column, row);
      if (c.red == colour.red && c.green == colour.green && c.blue == colour.blue) x += column, y += row, ++n;
    }
  return {x / n, y / n};
}

int count_of(const Picture& picture, Colour colour) {
  int n = 0;
  for (int row = 0; row < picture.height(); ++row)
    for (int column = 0; column < picture.width(); ++column) {
      const Colour& c = picture.at(column, row);
      n += c.red == colour.red && c.green == colour.green && c.blue == colour.blue;
    }
  return n;
}

TEST(Ticks, AreRoundNumbers) {
  EXPECT_THAT(round_ticks({0, 1}, 6).labels, ElementsAre("0.0", "0.2", "0.4", "0.6", "0.8", "1.0"));
  EXPECT_THAT(round_ticks({-0.04, 1.04}, 6).labels, ElementsAre("0.0", "0.2", "0.4", "0.6", "0.8", "1.0"));
  EXPECT_THAT(round_ticks({-0.3, 0.3}, 5).labels, ElementsAre("−0.2", "0.0", "0.2"));
  EXPECT_THAT(round_ticks({0, 400}, 5).values, ElementsAre(0, 100, 200, 300, 400));
  EXPECT_THAT(round_ticks({26.1, 27.9}, 5).labels, ElementsAre("26.5", "27.0", "27.5"));
}

TEST(Ticks, OfManyRangesAreInsideAndNotTooMany) {
  for (const double low : {-1e4, -3.3, 0.0, 1e-5, 7.0, 1e6}) {
    for (const double length : {1e-3, 0.27, 1.0, 4.9, 5.1, 99.0, 3e7}) {
      const AxisRange range{low, low + length};
      const Ticks ticks = round_ticks(range, 6);
      EXPECT_GE(ticks.values.size(), 2u) << low << ' ' << length;
      EXPECT_LE(ticks.values.size(), 7u) << low << ' ' << length;
      for (const double value : ticks.values) {
        EXPECT_GE(value, range.low - 1e-6 * length);
        EXPECT_LE(value, range.high + 1e-6 * length);
      }
      for (std::size_t n = 1; n < ticks.labels.size(); ++n) EXPECT_NE(ticks.labels[n], ticks.labels[n - 1]);
    }
  }
}

TEST(Ticks, OfLargeAndSmallNumbersShareTheirPowerOfTen) {
  const Ticks large = round_ticks({0, 3e8}, 3);
  EXPECT_EQ(large.exponent, 6);
  EXPECT_THAT(large.labels, ElementsAre("0", "100", "200", "300"));
  EXPECT_EQ(axis_text({.label = "rate", .unit = "1/s"}, large.exponent), "rate (10⁶ 1/s)");
  EXPECT_EQ(axis_text({.label = "error"}, round_ticks({0, 2e-5}, 4).exponent), "error (10⁻⁶)");
  EXPECT_EQ(axis_text({.label = "time", .unit = "s"}, 0), "time (s)");
  EXPECT_EQ(axis_text({.label = "tips"}, 0), "tips");
}

TEST(DecadeTicks, ArePowersOfTenAndBetweenThemWhereTheyAreFew) {
  EXPECT_THAT(decade_ticks({-0.5, 1.1}, 6).labels, ElementsAre("0.5", "1", "2", "5", "10"));
  EXPECT_THAT(decade_ticks({-2, 2}, 6).labels, ElementsAre("0.01", "0.1", "1", "10", "100"));
  EXPECT_THAT(decade_ticks({-8, -4}, 6).labels, ElementsAre("10⁻⁸", "10⁻⁷", "10⁻⁶", "10⁻⁵", "10⁻⁴"));
  EXPECT_THAT(decade_ticks({-12, 12}, 6).values.size(), 7u);
}

TEST(AxisRange, IsThatOfTheDataOrAsGiven) {
  const std::vector<double> values{3, nan, 1, 2};
  EXPECT_EQ(axis_range({}, values, 0).low, 1);
  EXPECT_EQ(axis_range({}, values, 0).high, 3);
  EXPECT_DOUBLE_EQ(axis_range({}, values, 0.1).high, 3.2);
  EXPECT_EQ(axis_range({.min = 0}, values, 0.1).low, 0);
  for (const auto& none : {std::vector<double>{}, {nan}, {5, 5}, {0}}) {
    const AxisRange range = axis_range({}, none, 0.1);
    EXPECT_LT(range.low, range.high);
    const AxisRange given = axis_range({.min = 7}, none, 0.1);
    EXPECT_EQ(given.low, 7);
    EXPECT_LT(given.low, given.high);
  }
}

TEST(Figure, APointIsWhereItBelongs) {
  const auto at = [](double x, double y, int colour) {
    return Series{.name = "", .x = {x}, .y = {y}, .mark = Mark::points, .colour = colour};
  };
  const Plot plot{.title = "",
                  .x = {"time", "s", -1, 11},
                  .y = {"V", "", -0.2, 1.2},
                  .series = {at(0, 0, 0), at(10, 1, 1), at(2.5, 0.75, 2)}};
  const Picture picture = test::decode_png(figure_png({.panels = {plot}}));
  EXPECT_EQ(picture.width(), 480);
  const Point low = middle_of(picture, palette[0]), high = middle_of(picture, palette[1]);
  const Point point = middle_of(picture, palette[2]);
  EXPECT_GT(high.x, low.x + 200);
  EXPECT_LT(high.y, low.y - 100) << "y points up";
  EXPECT_NEAR(point.x, low.x + 0.25 * (high.x - low.x), 0.6);
  EXPECT_NEAR(point.y, low.y + 0.75 * (high.y - low.y), 0.6);
}

TEST(Figure, OnLogarithmicAxesPowersOfTenAreEquallyFarApart) {
  const auto at = [](double x, double y, int colour) {
    return Series{.name = "", .x = {x}, .y = {y}, .mark = Mark::points, .colour = colour};
  };
  const Plot plot{.title = "",
                  .x = {.label = "time", .unit = "s", .min = 0.1, .max = 1000, .logarithmic = true},
                  .y = {.label = "error", .unit = "%", .logarithmic = true},
                  .series = {at(1, 0.01, 0), at(100, 1, 1), at(10, 0.1, 2), at(10, 0, 3)}};
  const Picture picture = test::decode_png(figure_png({.panels = {plot}}));
  const Point low = middle_of(picture, palette[0]), high = middle_of(picture, palette[1]);
  const Point middle = middle_of(picture, palette[2]);
  EXPECT_NEAR(middle.x, 0.5 * (low.x + high.x), 0.6);
  EXPECT_NEAR(middle.y, 0.5 * (low.y + high.y), 0.6);
  EXPECT_EQ(count_of(picture, palette[3]), 0) << "zero is not on a logarithmic axis";
}

TEST(Figure, ARingIsOpenWhereAPointIsNot) {
  const auto drawn = [](Mark mark) {
    const Plot plot{.title = "",
                    .x = {"time", "s", 0, 2},
                    .y = {"V", "", 0, 2},
                    .series = {{.name = "", .x = {1}, .y = {1}, .mark = mark, .colour = 0}}};
    return test::decode_png(figure_png({.panels = {plot}}));
  };
  const Picture point = drawn(Mark::points), ring = drawn(Mark::rings);
  const Point middle = middle_of(point, palette[0]);
  const int x = int(middle.x), y = int(middle.y);
  EXPECT_EQ(point.at(x, y).red, palette[0].red);
  EXPECT_EQ(ring.at(x, y).red, 255);
  // In every direction from its middle there is its line.
  for (const auto& [right, up] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
    int darkest = 255;
    for (int n = 1; n < 8; ++n) darkest = std::min<int>(darkest, ring.at(x + n * right, y + n * up).red);
    EXPECT_LT(darkest, 200);
  }
}

TEST(Figure, EqualScalesMakeACircleOfACircle) {
  Plot plot{.title = "", .x = {"X₁", "mm"}, .y = {"X₂", "mm"}, .series = {}, .equal_scales = true};
  const double x[] = {-3, 3, 0, 0}, y[] = {0, 0, -1, 1};
  for (int n = 0; n < 4; ++n)
    plot.series.push_back({.name = "", .x = {x[n]}, .y = {y[n]}, .mark = Mark::points, .colour = n});
  const Picture picture = test::decode_png(figure_png({.panels = {plot}}));
  const double across = middle_of(picture, palette[1]).x - middle_of(picture, palette[0]).x;
  const double up = middle_of(picture, palette[2]).y - middle_of(picture, palette[3]).y;
  EXPECT_NEAR(across / up, 3, 0.02);
}

TEST(Figure, BarsStandOnZeroWithTheirHeights) {
  const Plot plot{.title = "",
                  .x = {"area", ""},
                  .y = {"count", "", 0, 4},
                  .series = {{.name = "", .x = {1}, .y = {3}, .mark = Mark::bars, .colour = 0},
                             {.name = "", .x = {3}, .y = {1}, .mark = Mark::bars, .colour = 1}}};
  const Picture picture = test::decode_png(figure_png({.panels = {plot}}));
  // Bars are half opaque on white; mixed colours are rounded either way.
  const auto area = [&](Colour c) {
    const auto near = [](std::uint8_t seen, std::uint8_t of) { return std::abs(seen - (of + 255) / 2) <= 2; };
    double n = 0;
    for (int row = 0; row < picture.height(); ++row)
      for (int column = 0; column < picture.width(); ++column) {
        const Colour& seen = picture.at(column, row);
        n += near(seen.red, c.red) && near(seen.green, c.green) && near(seen.blue, c.blue);
      }
    return n;
  };
  const double three = area(palette[0]), one = area(palette[1]);
  EXPECT_GT(one, 1000);
  EXPECT_NEAR(three / one, 3, 0.1);
}

TEST(Figure, TheLegendLeavesTheDataInSight) {
  // Points everywhere: the same number of their pixels is seen with a legend and without.
  Series everywhere{.name = "", .x = {}, .y = {}, .mark = Mark::points, .colour = 1};
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 12; ++j) everywhere.x.push_back(i), everywhere.y.push_back(j);
  const Plot plot{.title = "", .x = {"x", ""}, .y = {"y", ""}, .series = {everywhere}};
  Plot named = plot;
  named.series.push_back({.name = "a name", .colour = 3});
  const Picture without = test::decode_png(figure_png({.panels = {plot}}));
  const Picture with = test::decode_png(figure_png({.panels = {named}}));
  // A point more or less is 0.7 %.
  EXPECT_NEAR(double(count_of(with, palette[1])) / count_of(without, palette[1]), 1, 0.012);
  EXPECT_GT(with.height(), without.height()) << "there is no free place between the axes";
}

TEST(Figure, AGapIsNotDrawnOver) {
  Plot plot{.title = "",
            .x = {"t", ""},
            .y = {"V", ""},
            .series = {{.name = "", .x = {0, 1, 2, 3, 4}, .y = {0, 0, 0, 0, 0}}}};
  const int whole = count_of(test::decode_png(figure_png({.panels = {plot}})), palette[0]);
  plot.series[0].x = {0, 1, nan, 3, 4};
  const int part = count_of(test::decode_png(figure_png({.panels = {plot}})), palette[0]);
  EXPECT_NEAR(double(part) / whole, 0.5, 0.05);
}

TEST(Figure, ASheetShowsWhereVIsAboveTheThreshold) {
  SheetPicture sheet{.title = "", .shape = {.rows = 11, .columns = 11, .cells = 0, .dx = 0.6}};
  sheet.V.assign(121, 0.0);
  // Rows upwards: the upper quarter.
  for (std::size_t n = 0; n < 121; ++n) sheet.V[n] = double(n / 11) / 10;
  sheet.shading = SheetPicture::Shading::dark_above;
  sheet.dark_above = 0.75;
  const Picture picture = test::decode_png(figure_png({.panels = {sheet}}));
  const Colour dark{70, 70, 70};
  EXPECT_NEAR(double(count_of(picture, dark)) / (picture.width() * picture.width()), 0.25 * 0.925 * 0.925,
              0.02);
  EXPECT_LT(middle_of(picture, dark).y, 0.3 * picture.height());
}

TEST(Figure, ADeformedSheetIsDrawnWhereItsNodesAre) {
  // One element, sheared: its upper edge is half its length to the right.
  SheetPicture sheet{.title = "", .shape = {.rows = 11, .columns = 11, .cells = 10, .dx = 0.1}};
  sheet.V.assign(121, 1.0);
  sheet.nodes = {0, 0, 1, 0, 0.5, 1, 1.5, 1};
  sheet.shading = SheetPicture::Shading::dark_above;
  const Picture picture = test::decode_png(figure_png({.panels = {sheet}}));
  const Colour dark{70, 70, 70};
  const int width = picture.width() - 36;  // margins: 12 points on both sides
  EXPECT_NEAR(double(count_of(picture, dark)) / (width * width), 1 / 1.5 / 1.5, 0.02);
  EXPECT_EQ(picture.at(18 + width / 20, 15 + width / 20).red, 255) << "the upper left corner is free";
}

TEST(Figure, ASheetThatLacksValuesIsAnError) {
  SheetPicture sheet{.title = "", .shape = {.rows = 11, .columns = 11, .cells = 0, .dx = 0.6}};
  sheet.V.assign(120, 0.0);
  EXPECT_THROW(figure_png({.panels = {sheet}}), std::invalid_argument);
}

TEST(Figure, TheSvgIsWellFormedWhateverTheTextSays) {
  const test::TemporaryFolder folder;
  const std::string evil = "<script>alert(\"1\")</script> & ]]> \x01 \xff\xfe µ";
  Plot plot{.title = evil,
            .x = {evil, evil},
            .y = {evil, ""},
            .series = {{.name = evil, .x = {0, 1}, .y = {0, 1}}}};
  SheetPicture sheet{
      .title = evil, .shape = {.rows = 3, .columns = 3, .cells = 0, .dx = 0.6}, .V = std::vector<double>(9)};
  write_figure({.title = evil, .columns = 2, .panels = {plot, sheet}}, folder / "evil");
  const std::string svg = test::read_text(folder / "evil.svg");
  EXPECT_THAT(svg, testing::Not(HasSubstr("<script")));
  EXPECT_THAT(svg, HasSubstr("&lt;script&gt;"));
  EXPECT_EQ(test::run_python(folder.path(),
                             "import xml.dom.minidom as m\n"
                             "root = m.parse('evil.svg').documentElement\n"
                             "assert root.tagName == 'svg', root.tagName\n"
                             "assert float(root.getAttribute('viewBox').split()[2]) == 640\n"
                             "assert len(root.getElementsByTagName('title')) == 1\n"
                             "assert root.getElementsByTagName('image')\n"),
            0);
  EXPECT_EQ(test::decode_png(test::read_text(folder / "evil.png")).width(), 960);
}

TEST(Figure, NothingToShowIsStillAPicture) {
  EXPECT_GT(test::decode_png(figure_png({.panels = {Plot{}}})).width(), 0);
  const Plot gaps{.title = "",
                  .x = {"x", ""},
                  .y = {"y", ""},
                  .series = {{.name = "a", .x = {nan, 1}, .y = {1, nan}, .error = {nan, 1}}}};
  EXPECT_GT(test::decode_png(figure_png({.panels = {gaps}})).width(), 0);
}

TEST(PlotJson, HasWhatThePageDraws) {
  const Plot plot{.title = "periods",
                  .x = {"time", "s", 0, std::nullopt},
                  .y = {"period", "ms"},
                  .series = {{.name = "probe",
                              .x = {1, 1.0 / 3},
                              .y = {nan, 268.15},
                              .mark = Mark::linked_points,
                              .dashed = true,
                              .colour = 1,
                              .error = {0.5, nan}}},
                  .guides = {269}};
  const auto json = plot_json(plot);
  EXPECT_EQ(json["x"].dump(), R"({"label":"time","unit":"s","min":0.0,"max":null})");
  EXPECT_EQ(json["series"][0].dump(),
            R"({"name":"probe","x":[1.0,0.333333],"y":[null,268.15],"mark":"linked_points","dashed":true,)"
            R"("colour":"#d55e00","error":[0.5,null]})");
  EXPECT_EQ(json["guides"].dump(), "[269.0]");
}

}  // namespace
}  // namespace myowave::apps
