#include "apps/results/fields_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <Kokkos_Core.hpp>
#include <csignal>
#include <cstdlib>

#include "apps/input/initial_state.hpp"
#include "apps/results/xdmf_file.hpp"
#include "tests/support/python.hpp"
#include "tests/support/synthetic_frames.hpp"
#include "tests/support/temporary_folder.hpp"

namespace myowave::apps {
namespace {

using test::SyntheticFrames;
using test::TemporaryFolder;

solver::Scene scene_of(int rows, int columns, bool deforms) {
  solver::Scene scene;
  scene.grid.rows = rows;
  scene.grid.columns = columns;
  if (deforms) scene.mechanics.emplace();
  return scene;
}

void write_frames(const TemporaryFolder& folder, const solver::Scene& scene, int count) {
  const auto shape = frame_shape(scene);
  FieldsFile fields(folder / "fields.h5", shape, 10, 10);
  XdmfFile xdmf(folder / "fields.xdmf", shape, "fields.h5");
  SyntheticFrames frames(scene);
  for (int n = 0; n < count; ++n) {
    fields.append(frames.at(0.5 * n));
    xdmf.append(fields.frames() - 1, 0.5 * n);
  }
}

std::vector<double> read_all(const std::filesystem::path& path, const char* name,
                             std::vector<hsize_t>& size) {
  const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, path);
  const Hdf5Handle dataset(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose, name);
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose, name);
  size.resize(std::size_t(H5Sget_simple_extent_ndims(space)));
  H5Sget_simple_extent_dims(space, size.data(), nullptr);
  std::size_t count = 1;
  for (const auto n : size) count *= n;
  std::vector<double> values(count);
  check_hdf5(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), name);
  return values;
}

TEST(FrameShape, GridPositionsAreBilinearInEachElement) {
  const auto scene = scene_of(21, 31, true);
  const auto shape = frame_shape(scene);
  EXPECT_EQ(shape.element_rows(), 2);
  EXPECT_EQ(shape.element_columns(), 3);
  SyntheticFrames frames(scene);
  const auto frame = frames.at(3);
  const auto x = grid_positions(shape, frame.nodes);
  ASSERT_EQ(x.size(), 2u * 21 * 31);
  const auto node = [&](int I, int J, int c) { return frame.nodes[std::size_t(2 * (I * 4 + J) + c)]; };
  for (int c : {0, 1}) {
    // A corner, a node on the last row and column, and a quarter of element (1, 2).
    EXPECT_FLOAT_EQ(x[std::size_t(c)], float(node(0, 0, c)));
    EXPECT_FLOAT_EQ(x[std::size_t(2 * (20 * 31 + 30) + c)], float(node(2, 3, c)));
    const double expected =
        0.5 * (0.8 * node(1, 2, c) + 0.2 * node(1, 3, c)) + 0.5 * (0.8 * node(2, 2, c) + 0.2 * node(2, 3, c));
    EXPECT_FLOAT_EQ(x[std::size_t(2 * (15 * 31 + 22) + c)], float(expected));
  }
}

TEST(FieldsFile, FramesAreReadBackBitwiseIdentical) {
  const TemporaryFolder folder;
  const auto scene = scene_of(21, 31, true);
  write_frames(folder, scene, 3);
  SyntheticFrames frames(scene);
  std::vector<hsize_t> size;
  EXPECT_THAT(read_all(folder / "fields.h5", "time", size), testing::ElementsAre(0, 0.5, 1));
  for (int n = 0; n < 3; ++n) {
    const auto frame = frames.at(0.5 * n);
    const auto expect_frame = [&](const char* name, std::span<const double> expected) {
      const auto all = read_all(folder / "fields.h5", name, size);
      ASSERT_EQ(all.size(), 3 * expected.size());
      EXPECT_TRUE(
          std::equal(expected.begin(), expected.end(), all.begin() + n * std::ptrdiff_t(expected.size())))
          << name;
    };
    expect_frame("V", frame.V);
    EXPECT_THAT(size, testing::ElementsAre(3, 21, 31));
    expect_frame("r", frame.r);
    expect_frame("Ta", frame.Ta);
    expect_frame("nodes", frame.nodes);
    EXPECT_THAT(size, testing::ElementsAre(3, 12, 2));
  }
  read_all(folder / "fields.h5", "grid", size);
  EXPECT_THAT(size, testing::ElementsAre(3, 21, 31, 2));
}

// A resumed run keeps the frames up to its checkpoint, whatever happened to its file since.
TEST(FieldsFile, ResumesAfterTheFramesOfTheCheckpoint) {
  for (const bool deforms : {true, false}) {
    const TemporaryFolder folder;
    auto scene = scene_of(21, 31, deforms);
    scene.output.tension = deforms;
    const auto shape = frame_shape(scene);
    write_frames(folder, scene, 5);
    SyntheticFrames frames(scene);
    const auto path = folder / "torn.h5";
    FieldsFile::Saved saved;
    {
      FieldsFile fields(path, shape, 10, 5);
      for (int n = 0; n < 4; ++n) {
        fields.append(frames.at(0.5 * n));
        if (n == 2) saved = fields.saved();
      }
    }
    EXPECT_EQ(saved.frames, 3U);
    std::ofstream(path, std::ios::app) << "a partial write before a kill";
    {
      FieldsFile fields(path, shape, 10, 5, saved);
      EXPECT_EQ(fields.saved().digest, saved.digest);
      for (int n = 3; n < 5; ++n) fields.append(frames.at(0.5 * n));
    }
    for (const char* name : {"time", "V", "r", "Ta", "nodes", "grid"}) {
      if (!deforms && name != std::string("time") && name != std::string("V") && name != std::string("r"))
        continue;
      std::vector<hsize_t> size, expected_size;
      EXPECT_EQ(read_all(path, name, size), read_all(folder / "fields.h5", name, expected_size)) << name;
      EXPECT_EQ(size, expected_size);
    }
    EXPECT_THROW(FieldsFile(path, shape, 10, 5, {3, saved.digest + 1}), std::runtime_error);
    EXPECT_THROW(FieldsFile(path, shape, 10, 5, {6, saved.digest}), std::runtime_error);
    EXPECT_THROW(FieldsFile(folder / "none.h5", shape, 10, 5, saved), std::runtime_error);
  }
}

TEST(FieldsFile, ARigidRunHasNoNodes) {
  const TemporaryFolder folder;
  write_frames(folder, scene_of(5, 7, false), 1);
  const Hdf5Handle file(H5Fopen((folder / "fields.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose,
                        "fields.h5");
  EXPECT_GT(H5Lexists(file, "V", H5P_DEFAULT), 0);
  EXPECT_EQ(H5Lexists(file, "nodes", H5P_DEFAULT), 0);
  EXPECT_EQ(H5Lexists(file, "grid", H5P_DEFAULT), 0);
}

TEST(FieldsFile, OpensInH5py) {
  const TemporaryFolder folder;
  if (!test::python_has(folder.path(), "h5py")) GTEST_SKIP() << "no h5py for /usr/bin/python3";
  write_frames(folder, scene_of(21, 31, true), 3);
  EXPECT_EQ(test::run_python(folder.path(), R"(
import h5py
with h5py.File("fields.h5", "r") as f:
    assert f["time"][:].tolist() == [0, 0.5, 1]
    assert f["V"].shape == f["r"].shape == f["Ta"].shape == (3, 21, 31)
    assert f["V"].dtype == "float64" and f["V"].compression == "gzip" and f["V"].chunks == (1, 21, 31)
    assert f["nodes"].shape == (3, 12, 2)
    assert f["Ta"].attrs["units"] == "kPa" and f["time"].attrs["units"] == "t.u."
    assert f.attrs["dx"] == 0.6 and f.attrs["ms_per_tu"] == 10
    assert (f["Ta"][:] == 40 * f["V"][:]).all()
)"),
            0);
}

// The writer is killed between two frames, as by a scheduler: the frames it wrote are readable.
TEST(FieldsFile, IsReadableAfterAKill) {
  const TemporaryFolder folder;
  const auto scene = scene_of(21, 31, true);
  const auto child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    FieldsFile fields(folder / "fields.h5", frame_shape(scene), 10, 10);
    SyntheticFrames frames(scene);
    for (int n = 0; n < 7; ++n) fields.append(frames.at(n));
    raise(SIGKILL);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  const auto state = read_state(folder / "fields.h5", 21, 31, std::nullopt);
  SyntheticFrames frames(scene);
  const auto last = frames.at(6);
  EXPECT_TRUE(std::equal(last.V.begin(), last.V.end(), state.V.begin()));
}

// The file may not grow past a limit, as on a full disk.
TEST(FieldsFile, AFailedWriteNamesTheFileAndTheReason) {
#ifdef KOKKOS_ENABLE_THREADS
  GTEST_SKIP() << "at exit Kokkos joins threads that a forked process does not have";
#endif
  const TemporaryFolder folder;
  const auto scene = scene_of(101, 101, true);
  const auto child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{2000000, 2000000};
    setrlimit(RLIMIT_FSIZE, &limit);
    int result = 1;
    try {
      FieldsFile fields(folder / "fields.h5", frame_shape(scene), 10, 10);
      SyntheticFrames frames(scene);
      for (int n = 0; n < 1000; ++n) fields.append(frames.at(n));
    } catch (const std::runtime_error& error) {
      const std::string message = error.what();
      result = message.find("fields.h5") != std::string::npos &&
                       message.find("File too large") != std::string::npos
                   ? 0
                   : 2;
    }
    // exit and not _exit: HDF5 then closes open files, which must not fail either.
    std::exit(result);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status)) << "signal " << WTERMSIG(status);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_NO_THROW(read_state(folder / "fields.h5", 101, 101, std::nullopt));
}

// Well formed after each frame, and each reference fits the datasets.
TEST(XdmfFile, RefersToTheDatasetsAsTheyAre) {
  const TemporaryFolder folder;
  if (!test::python_has(folder.path(), "h5py")) GTEST_SKIP() << "no h5py for /usr/bin/python3";
  for (const bool deforms : {true, false}) {
    for (const int count : {1, 3}) {
      write_frames(folder, scene_of(21, 31, deforms), count);
      EXPECT_EQ(test::run_python(folder.path(), R"(
import h5py, xml.etree.ElementTree as tree
h5 = h5py.File("fields.h5", "r")
frames = tree.parse("fields.xdmf").getroot().findall("Domain/Grid/Grid")
assert len(frames) == len(h5["time"])
names = {"V", "r", "Ta"} | ({"grid"} if "grid" in h5 else set())
for n, frame in enumerate(frames):
    assert float(frame.find("Time").get("Value")) == h5["time"][n]
    size = "21 31" if "grid" in h5 else "1 21 31"
    assert frame.find("Topology").get("Dimensions") == size
    seen = set()
    for slab in frame.iter("DataItem"):
        if slab.get("ItemType") != "HyperSlab":
            continue
        select, source = slab.findall("DataItem")
        file, name = source.text.split(":/")
        assert file == "fields.h5"
        shape = tuple(map(int, source.get("Dimensions").split()))
        assert shape[0] == n + 1 <= h5[name].shape[0] and shape[1:] == h5[name].shape[1:]
        assert int(source.get("Precision")) == h5[name].dtype.itemsize
        numbers = list(map(int, select.text.split()))
        rank = len(shape)
        assert numbers == [n] + [0] * (rank - 1) + [1] * rank + [1] + list(shape[1:])
        assert slab.get("Dimensions") == size + (" 2" if name == "grid" else "")
        seen.add(name)
    assert seen == names, seen
)"),
                0)
          << (deforms ? "deforming" : "rigid") << ", " << count << " frames";
    }
  }
}

}  // namespace
}  // namespace myowave::apps
