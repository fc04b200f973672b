#include "apps/input/initial_state.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numeric>

#include "apps/base/hdf5_handle.hpp"
#include "apps/input/state_cache.hpp"
#include "apps/results/fields_file.hpp"
#include "solver/base/error.hpp"
#include "tests/support/synthetic_frames.hpp"
#include "tests/support/temporary_folder.hpp"

namespace myowave::apps {
namespace {

using test::TemporaryFolder;
using testing::AllOf;
using testing::HasSubstr;

void write_dataset(const std::filesystem::path& path, const char* name, const std::vector<hsize_t>& size,
                   double first = 0) {
  start_hdf5();
  const bool there = std::filesystem::exists(path);
  const Hdf5Handle file(there ? H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT)
                              : H5Fcreate(path.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT),
                        H5Fclose, path);
  const Hdf5Handle space(H5Screate_simple(int(size.size()), size.data(), nullptr), H5Sclose, name);
  const Hdf5Handle dataset(
      H5Dcreate2(file, name, H5T_IEEE_F32LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose, name);
  std::size_t count = 1;
  for (const auto n : size) count *= n;
  std::vector<double> values(count);
  std::iota(values.begin(), values.end(), first);
  check_hdf5(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), name);
}

std::string refusal(const std::filesystem::path& file, int rows, int columns,
                    const std::optional<std::array<int, 2>>& window = std::nullopt) {
  try {
    read_state(file, rows, columns, window);
  } catch (const solver::InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ReadState, TakesTheLastFrameOfARun) {
  const TemporaryFolder folder;
  solver::Scene scene;
  scene.grid.rows = 11;
  scene.grid.columns = 21;
  test::SyntheticFrames frames(scene);
  FieldsFile file(folder / "fields.h5", frame_shape(scene), 10, 10);
  for (const double t : {0.0, 1.0, 2.0}) file.append(frames.at(t));
  // The writer is still at work.
  const auto state = read_state(folder / "fields.h5", 11, 21, std::nullopt);
  const auto last = frames.at(2);
  EXPECT_THAT(state.V, testing::ElementsAreArray(last.V));
  EXPECT_THAT(state.r, testing::ElementsAreArray(last.r));
  EXPECT_THAT(state.Ta, testing::ElementsAreArray(last.Ta));

  const auto part = read_state(folder / "fields.h5", 3, 2, {{4, 7}});
  ASSERT_EQ(part.V.size(), 6u);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 2; ++j) {
      EXPECT_EQ(part.V[std::size_t(2 * i + j)], last.V[std::size_t((4 + i) * 21 + 7 + j)]);
    }
  }
}

TEST(ReadState, TakesPlainDatasetsAndNoTension) {
  const TemporaryFolder folder;
  write_dataset(folder / "state.h5", "V", {3, 4});
  write_dataset(folder / "state.h5", "r", {3, 4}, 100);
  const auto state = read_state(folder / "state.h5", 3, 4, std::nullopt);
  EXPECT_EQ(state.V[11], 11);
  EXPECT_EQ(state.r[0], 100);
  EXPECT_EQ(state.Ta, std::vector<double>(12, 0.0));
}

TEST(ReadState, ReportsWhatIsWrongWithAFile) {
  const TemporaryFolder folder;
  EXPECT_THAT(refusal(folder / "none.h5", 3, 4), AllOf(HasSubstr("none.h5"), HasSubstr("no such file")));
  EXPECT_THAT(refusal(folder.path(), 3, 4), HasSubstr("HDF5"));

  std::ofstream(folder / "text.h5") << "V r Ta";
  EXPECT_THAT(refusal(folder / "text.h5", 3, 4), AllOf(HasSubstr("text.h5"), HasSubstr("HDF5")));

  write_dataset(folder / "no_r.h5", "V", {3, 4});
  EXPECT_THAT(refusal(folder / "no_r.h5", 3, 4), HasSubstr("no dataset r"));

  write_dataset(folder / "line.h5", "V", {12});
  EXPECT_THAT(refusal(folder / "line.h5", 3, 4), HasSubstr("1 dimensions"));

  write_dataset(folder / "unequal.h5", "V", {3, 4});
  write_dataset(folder / "unequal.h5", "r", {4, 3});
  EXPECT_THAT(refusal(folder / "unequal.h5", 3, 4), HasSubstr("r has 4 x 3 nodes, V 3 x 4"));

  write_dataset(folder / "empty.h5", "V", {0, 3, 4});
  write_dataset(folder / "empty.h5", "r", {0, 3, 4});
  EXPECT_THAT(refusal(folder / "empty.h5", 3, 4), HasSubstr("holds no frame"));

  write_dataset(folder / "nan.h5", "V", {3, 4}, std::nan(""));
  write_dataset(folder / "nan.h5", "r", {3, 4});
  EXPECT_THAT(refusal(folder / "nan.h5", 3, 4), HasSubstr("is nan at row 0, column 0"));

  write_dataset(folder / "good.h5", "V", {3, 4});
  write_dataset(folder / "good.h5", "r", {3, 4});
  EXPECT_THAT(refusal(folder / "good.h5", 3, 3),
              AllOf(HasSubstr("3 x 4"), HasSubstr("3 x 3"), HasSubstr("window")));
  EXPECT_THAT(refusal(folder / "good.h5", 3, 5, {{0, 0}}), HasSubstr("part of the file's sheet"));
  EXPECT_THAT(refusal(folder / "good.h5", 2, 2, {{0, 3}}), HasSubstr("[0, 0] to [1, 2] fit"));
  EXPECT_THAT(refusal(folder / "good.h5", 2, 2, {{-1, 0}}), HasSubstr("[-1, 0] leaves it"));
  EXPECT_EQ(refusal(folder / "good.h5", 2, 2, {{1, 2}}), "");

  std::filesystem::resize_file(folder / "good.h5", 700);
  EXPECT_THAT(refusal(folder / "good.h5", 3, 4), HasSubstr("truncated"));
}

class StateCache : public testing::Test {
 protected:
  solver::InitialState get(const std::filesystem::path& path, const std::string& definition = "one") {
    return cached_state(path, definition, [this] {
      ++computed_;
      return solver::InitialState{2, 3, {0.1, 2, 3, 4, 5, 1.0 / 3}, {1, 2, 3, 4, 5, 7}, {1, 2, 3, 4, 5, 8}};
    });
  }

  TemporaryFolder folder_;
  int computed_ = 0;
};

TEST_F(StateCache, ComputesOnceAndReadsBackBitwiseIdentical) {
  const auto path = folder_ / "deep/state.h5";
  const auto first = get(path), second = get(path);
  EXPECT_EQ(computed_, 1);
  EXPECT_EQ(second.rows, 2);
  EXPECT_EQ(second.columns, 3);
  EXPECT_EQ(first.V, second.V);
  EXPECT_EQ(first.r, second.r);
  EXPECT_EQ(first.Ta, second.Ta);
  // Nothing temporary is left.
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_ / "deep"), {}), 1);
}

TEST_F(StateCache, RecomputesADamagedState) {
  const auto path = folder_ / "state.h5";
  get(path);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  get(path);
  EXPECT_EQ(computed_, 2) << "truncated";
  get(path);
  EXPECT_EQ(computed_, 2);

  // One bit of V: 0.1 is in the file once.
  auto bytes = test::read_text(path);
  const double value = 0.1;
  const auto at = bytes.find(std::string(reinterpret_cast<const char*>(&value), sizeof value));
  ASSERT_NE(at, std::string::npos);
  bytes[at] = char(bytes[at] ^ 1);
  std::ofstream(path, std::ios::binary) << bytes;
  EXPECT_EQ(get(path).V[0], 0.1);
  EXPECT_EQ(computed_, 3) << "a bit";

  std::ofstream(path) << "";
  get(path);
  EXPECT_EQ(computed_, 4) << "empty";
}

TEST_F(StateCache, RecomputesAStateOfAnotherDefinition) {
  const auto path = folder_ / "state.h5";
  get(path, "one");
  get(path, "other");
  EXPECT_EQ(computed_, 2);
}

TEST_F(StateCache, WorksWithoutAWritableFolder) {
  std::ofstream(folder_ / "file") << "";
  testing::internal::CaptureStderr();
  EXPECT_EQ(get(folder_ / "file/state.h5").V[0], 0.1);
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("could not be kept"));
  EXPECT_EQ(get({}).V[0], 0.1);
  EXPECT_EQ(computed_, 2);
}

TEST_F(StateCache, UsesTheUsersCacheFolder) {
  setenv("XDG_CACHE_HOME", "/somewhere", 1);
  const auto path = cached_state_path("spiral", "definition");
  EXPECT_EQ(path.parent_path(), "/somewhere/myowave");
  EXPECT_THAT(path.filename().string(), testing::MatchesRegex("spiral_[0-9a-f]+\\.h5"));
  EXPECT_NE(path, cached_state_path("spiral", "another"));

  setenv("XDG_CACHE_HOME", "relative", 1);
  setenv("HOME", "/home/someone", 1);
  EXPECT_EQ(cached_state_path("spiral", "definition").parent_path(), "/home/someone/.cache/myowave");
  unsetenv("XDG_CACHE_HOME");
  EXPECT_EQ(cached_state_path("spiral", "definition").parent_path(), "/home/someone/.cache/myowave");
  unsetenv("HOME");
  EXPECT_TRUE(cached_state_path("spiral", "definition").empty());
}

solver::Scene scene_at_rest(int n) {
  solver::Scene scene;
  scene.grid.rows = scene.grid.columns = n;
  return scene;
}

TEST(InitialState, NoiseHasItsDeviationAndItsSeed) {
  solver::OutputSink sink;
  auto scene = scene_at_rest(101);
  const auto quiet = resolve_initial_state(scene, sink);
  EXPECT_EQ(quiet.V, std::vector<double>(101 * 101, 0.0));
  scene.initial.noise = 0.02;
  const auto noisy = resolve_initial_state(scene, sink);
  double sum = 0, squares = 0;
  for (const double v : noisy.V) {
    sum += v;
    squares += v * v;
  }
  const double n = double(noisy.V.size());
  EXPECT_NEAR(sum / n, 0, 4 * 0.02 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares / n), 0.02, 4 * 0.02 / std::sqrt(2 * n));
  EXPECT_EQ(noisy.r, quiet.r);
  EXPECT_EQ(resolve_initial_state(scene, sink).V, noisy.V);
  scene.initial.seed = 1;
  EXPECT_NE(resolve_initial_state(scene, sink).V, noisy.V);
}

// The same on every machine: Box-Muller of the first two numbers that the standard gives for
// std::mt19937_64 with seed 5489: 14514284786278117030 and 4620546740167642908.
TEST(InitialState, NoiseIsThatOfTheStandardEngine) {
  solver::OutputSink sink;
  auto scene = scene_at_rest(2);
  scene.initial.noise = 1;
  scene.initial.seed = 5489;
  const double u = 14514284786278117030.0 / 18446744073709551616.0;
  const double v = 4620546740167642908.0 / 18446744073709551616.0;
  const auto state = resolve_initial_state(scene, sink);
  EXPECT_NEAR(state.V[0], std::sqrt(-2 * std::log(u)) * std::cos(2 * M_PI * v), 1e-12);
  EXPECT_NEAR(state.V[1], std::sqrt(-2 * std::log(u)) * std::sin(2 * M_PI * v), 1e-12);
}

TEST(InitialState, ASettledSpiralHasItsPlaceAndItsSpacing) {
  solver::OutputSink sink;
  auto scene = scene_at_rest(121);
  scene.initial.type = solver::InitialSettings::Type::settled_spiral;
  scene.initial.core_offset = {0, 40};
  EXPECT_THROW(resolve_initial_state(scene, sink), solver::InputError);
  scene.initial.core_offset = {0, 0};
  scene.grid.dx = 0.3;
  EXPECT_THROW(resolve_initial_state(scene, sink), solver::InputError);
}

}  // namespace
}  // namespace myowave::apps
