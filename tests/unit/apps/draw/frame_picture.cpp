#include "apps/draw/frame_picture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "solver/mechanics/equibiaxial.hpp"
#include "tests/support/png.hpp"
#include "tests/support/synthetic_frames.hpp"

namespace myowave::apps {
namespace {

using test::decode_png;

int difference(const Colour& a, const Colour& b) {
  return std::max({std::abs(a.red - b.red), std::abs(a.green - b.green), std::abs(a.blue - b.blue)});
}

constexpr Colour white{255, 255, 255};

TEST(ColourMap, LuminanceFallsSteadilySoThatItPrintsInGrey) {
  const auto level = [](int n) { return luminance(colour_of(n / 255.0)); };
  for (int n = 1; n < 256; ++n) EXPECT_LE(level(n), level(n - 1)) << n;  // neighbours may round to the same
  for (int n = 2; n < 256; ++n) EXPECT_LT(level(n), level(n - 2)) << n;
  EXPECT_GT(luminance(colour_of(0)), 0.9);
  EXPECT_LT(luminance(colour_of(1)), 0.02);
  EXPECT_EQ(difference(colour_of(-3), colour_of(0)), 0);
  EXPECT_EQ(difference(colour_of(7), colour_of(1)), 0);
}

TEST(Picture, SurvivesPng) {
  Picture picture(31, 17, white);
  for (int y = 0; y < 17; ++y) {
    for (int x = 0; x < 31; ++x)
      picture.at(x, y) = {std::uint8_t(8 * x), std::uint8_t(15 * y), std::uint8_t(x * y)};
  }
  const Picture back = decode_png(picture.png());
  ASSERT_EQ(back.width(), 31);
  ASSERT_EQ(back.height(), 17);
  EXPECT_EQ(std::memcmp(&back.at(0, 0), &picture.at(0, 0), 3 * 31 * 17), 0);
}

TEST(Strokes, ALineCoversItsWidthAndStaysInThePicture) {
  Picture picture(20, 20, white);
  Strokes strokes(picture);
  strokes.line(std::array<Point, 2>{{{-50, 10}, {70, 10}}}, 3);
  strokes.line(std::array<Point, 2>{{{5, -50}, {5, 70}}}, 3);
  strokes.paint(picture, {0, 0, 0}, 0.5);
  EXPECT_EQ(picture.at(15, 10).red, 128);
  EXPECT_EQ(picture.at(15, 11).red, 128);
  EXPECT_EQ(picture.at(15, 12).red, 255);
  EXPECT_EQ(picture.at(5, 10).red, 128) << "crossing strokes do not add up";
}

TEST(Strokes, ContrastDarkensLightGroundAndLightensDarkGround) {
  for (const auto ground : {std::uint8_t(0), std::uint8_t(255)}) {
    Picture picture(9, 9, {ground, ground, ground});
    Strokes strokes(picture);
    strokes.line(std::array<Point, 2>{{{-1, 4}, {9, 4}}}, 1);
    strokes.paint_contrast(picture, 0.2);
    EXPECT_EQ(picture.at(4, 4).red, ground == 0 ? 51 : 204);
    EXPECT_EQ(picture.at(4, 6).red, ground);
  }
}

// The box of all pixels that are not white: left, top, right, bottom.
std::array<int, 4> inked(const Picture& picture) {
  std::array<int, 4> box{picture.width(), picture.height(), -1, -1};
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x)
      if (difference(picture.at(x, y), white) > 0)
        box = {std::min(box[0], x), std::min(box[1], y), std::max(box[2], x), std::max(box[3], y)};
  return box;
}

TEST(Strokes, ATextStandsOnItsBaseLineAndIsAlignedAsAsked) {
  const auto drawn = [](double align) {
    Picture picture(200, 60, white);
    Strokes strokes(picture);
    strokes.text({100, 40}, "t = 12", {.size = 20, .align = align});
    strokes.paint(picture, {0, 0, 0}, 1);
    return inked(picture);
  };
  const double width = text_width("t = 12", {.size = 20});
  const auto left = drawn(0), middle = drawn(0.5), right = drawn(1);
  EXPECT_NEAR(left[1], 40 - 0.73 * 20, 2) << "as high as a digit";
  EXPECT_NEAR(left[3], 40, 1);
  EXPECT_GE(left[0], 99);
  EXPECT_NEAR(left[2], 100 + width, 4);
  EXPECT_NEAR(middle[0], 100 - 0.5 * width, 4);
  EXPECT_LE(right[2], 101);
}

solver::Scene scene_of(int rows, int columns, bool deforms) {
  solver::Scene scene;
  scene.grid.rows = rows;
  scene.grid.columns = columns;
  if (deforms) scene.mechanics.emplace();
  return scene;
}

TEST(FramePicture, ShowsVWhereTheDeformedMaterialIs) {
  const auto scene = scene_of(121, 121, true);
  test::SyntheticFrames frames(scene);
  const FramePicture drawing(scene);
  const double t = 2;
  const auto frame = frames.at(t);
  const Picture picture = decode_png(drawing.draw(frame).png());
  EXPECT_NEAR(std::max(picture.width(), picture.height()), 960, 40);
  EXPECT_EQ(picture.height() % 2, 0);
  EXPECT_EQ(picture.width() % 2, 0);
  // Middles of all elements, away from the lines.
  for (int I = 0; I < 12; ++I) {
    for (int J = 0; J < 12; ++J) {
      double x[2] = {0, 0};
      for (const int node : {I * 13 + J, I * 13 + J + 1, (I + 1) * 13 + J, (I + 1) * 13 + J + 1}) {
        for (const int c : {0, 1}) x[c] += 0.25 * frame.nodes[std::size_t(2 * node + c)];
      }
      const auto at = drawing.to_pixel(x[0], x[1]);
      const double V = frame.V[std::size_t((10 * I + 5) * 121 + 10 * J + 5)];
      EXPECT_LE(difference(picture.at(int(std::lround(at.x)), int(std::lround(at.y))), colour_of(V)), 24)
          << "element " << I << ", " << J;
    }
  }
}

TEST(FramePicture, ARigidSheetFillsItsSquareWithRowsUpwards) {
  auto scene = scene_of(11, 21, false);
  std::vector<double> V(11 * 21, 0.0);
  for (int j = 0; j < 21; ++j) V[std::size_t(j)] = 1;  // row 0
  solver::Frame frame;
  frame.rows = 11;
  frame.columns = 21;
  frame.V = V;
  const FramePicture drawing(scene);
  const Picture picture = drawing.draw(frame);
  const auto low = drawing.to_pixel(6, 0), high = drawing.to_pixel(6, 6);
  EXPECT_GT(low.y, high.y);
  EXPECT_LE(difference(picture.at(int(low.x), int(low.y) - 4), colour_of(1)), 40);
  EXPECT_LE(difference(picture.at(int(high.x), int(high.y) + 4), colour_of(0)), 1);
  const auto outside = drawing.to_pixel(6, 6);
  EXPECT_EQ(difference(picture.at(int(outside.x), int(outside.y) - 6), white), 0);
}

// A sheet of 251 x 251 nodes is pinned at element node (12, 12) of 25 x 25.
void expect_corners_in_view(const solver::Scene& scene, double stretch) {
  const FramePicture drawing(scene);
  constexpr double pin = 72;
  for (const double X : {0.0, 150.0}) {
    const auto at = drawing.to_pixel(pin + stretch * (X - pin), pin + stretch * (X - pin));
    EXPECT_GT(at.x, 0);
    EXPECT_LT(at.x, 900);
  }
}

TEST(FramePicture, TheViewHoldsTheSheetAtRest) {
  for (const auto load : {solver::Load::follower, solver::Load::dead}) {
    for (const double p : {-10.0, 0.0, 10.0}) {
      auto scene = scene_of(251, 251, true);
      scene.mechanics->load = load;
      scene.mechanics->p = p;
      expect_corners_in_view(scene, solver::equibiaxial_stretch(*scene.mechanics, 0).value());
    }
  }
}

// A dead load p on a sheet with c2 = 0 stretches it by p / (2 c1), as far as its thickness does not resist.
TEST(FramePicture, TheViewHoldsASheetThatALoadStretchesManyTimes) {
  for (const double stretch : {9.9, 10.0, 10.1, 40.0}) {
    auto scene = scene_of(251, 251, true);
    auto& mechanics = *scene.mechanics;
    mechanics.load = solver::Load::dead;
    mechanics.c2 = 0;
    mechanics.p = 2 * mechanics.c1 * (stretch - std::pow(stretch, -5));
    EXPECT_NEAR(solver::equibiaxial_stretch(mechanics, 0).value(), stretch, 1e-12 * stretch);
    expect_corners_in_view(scene, stretch);
  }
}

TEST(FramePicture, AStripIsDrawnAsAStrip) {
  const auto scene = scene_of(2, 201, false);
  test::SyntheticFrames frames(scene);
  const Picture picture = FramePicture(scene).draw(frames.at(0));
  EXPECT_LT(picture.height(), 300);
  EXPECT_GT(picture.width(), 900);
}

}  // namespace
}  // namespace myowave::apps
