// Checkpoint files: the last two remain, and damaged ones are reported and not used.
#include "solver/run/checkpoint.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <optional>

#include "solver/base/archive.hpp"
#include "tests/support/temporary_folder.hpp"

namespace myowave::solver {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct Part {
  std::vector<double> values{1.5, -2};
  std::optional<int> number = 7;
  template <class Archive>
  void state(Archive& archive) {
    archive(values, number);
  }
};

struct Whole {
  int step = 3;
  std::string name = "a stage";
  std::vector<std::string> warnings{"one", "", "three"};
  Part part;
  Kokkos::View<double**, Kokkos::LayoutRight, Kokkos::HostSpace> small{"small", 2, 3},
      large{"large", 100, 200};
  Whole() {
    for (std::size_t n = 0; n < small.size(); ++n) small.data()[n] = double(n);
    for (std::size_t n = 0; n < large.size(); ++n) large.data()[n] = 0.5 * double(n);
  }
  template <class Archive>
  void state(Archive& archive) {
    archive(step, large, name, warnings, part, small);
  }
};

std::vector<std::byte> bytes_of(const StateWriter& writer) {
  std::vector<std::byte> bytes;
  for (const auto& piece : writer.pieces()) bytes.insert(bytes.end(), piece.begin(), piece.end());
  return bytes;
}

TEST(Archive, ReadsBackWhatWasWritten) {
  Whole saved;
  saved.step = 42;
  saved.part = {{}, std::nullopt};
  saved.warnings.push_back("four");
  StateWriter writer;
  writer(saved);
  const auto bytes = bytes_of(writer);
  Whole loaded;
  Kokkos::deep_copy(loaded.large, 0.0);
  Kokkos::deep_copy(loaded.small, 0.0);
  StateReader reader(bytes);
  reader(loaded);
  EXPECT_TRUE(reader.at_end());
  EXPECT_EQ(loaded.step, 42);
  EXPECT_EQ(loaded.name, "a stage");
  EXPECT_THAT(loaded.warnings, ElementsAre("one", "", "three", "four"));
  EXPECT_THAT(loaded.part.values, IsEmpty());
  EXPECT_EQ(loaded.part.number, std::nullopt);
  EXPECT_EQ(loaded.small(1, 2), 5);
  EXPECT_EQ(loaded.large(99, 199), 0.5 * 19999);
}

TEST(Archive, RefusesBytesOfAnotherKind) {
  Whole whole;
  StateWriter writer;
  writer(whole);
  const auto bytes = bytes_of(writer);
  for (std::size_t length = 0; length < 200; ++length) {
    StateReader cut{std::span(bytes).first(length)};
    EXPECT_THROW(cut(whole), StateMismatch) << length;
  }
  StateReader reader(bytes);
  double wrong = 0;
  EXPECT_THROW(reader(wrong), StateMismatch);
  Whole other;
  other.large = decltype(other.large)("large", 100, 201);
  StateReader again(bytes);
  EXPECT_THROW(again(other), StateMismatch);
}

class Checkpoint : public testing::Test {
 protected:
  test::TemporaryFolder folder;

  void keep(CheckpointKeeper& keeper, std::int64_t step) {
    StateWriter writer;
    writer(step, std::string(300, 'x'));
    keeper.keep(writer, step, 0.5 * double(step), "mark " + std::to_string(step));
  }
  // The newest and the previous one.
  void keep_two() {
    CheckpointKeeper keeper(folder.path(), "the run");
    keep(keeper, 1), keep(keeper, 2);
  }
  static std::int64_t step_in_state(const FoundCheckpoint& found) {
    std::int64_t step = 0;
    std::string filling;
    StateReader reader(found.state());
    reader(step, filling);
    EXPECT_TRUE(reader.at_end());
    return step;
  }
  std::filesystem::path newest() {
    std::vector<std::string> refused;
    return find_checkpoint(folder.path(), refused)->file;
  }
  void write(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
  }
  // The previous one is found, and the message says why the newest is not used.
  void expect_refused(const std::filesystem::path& file, const std::string& why) {
    std::vector<std::string> refused;
    const auto found = find_checkpoint(folder.path(), refused);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->step, 1);
    EXPECT_EQ(step_in_state(*found), 1);
    EXPECT_THAT(refused, ElementsAre(testing::AllOf(HasSubstr(file.string() + ": "), HasSubstr(why))));
  }
};

TEST_F(Checkpoint, HoldsWhatWasSaved) {
  keep_two();
  std::vector<std::string> refused;
  const auto found = find_checkpoint(folder.path(), refused);
  ASSERT_TRUE(found);
  EXPECT_THAT(refused, IsEmpty());
  EXPECT_EQ(found->identity, "the run");
  EXPECT_EQ(found->mark, "mark 2");
  EXPECT_EQ(found->step, 2);
  EXPECT_EQ(found->t, 1.0);
  EXPECT_EQ(step_in_state(*found), 2);
}

TEST_F(Checkpoint, TheLastTwoRemain) {
  CheckpointKeeper keeper(folder.path(), "the run");
  for (std::int64_t step = 1; step <= 5; ++step) keep(keeper, step);
  std::vector<std::string> refused;
  const auto newest = find_checkpoint(folder.path(), refused);
  EXPECT_EQ(newest->step, 5);
  std::filesystem::remove(newest->file);
  const auto before = find_checkpoint(folder.path(), refused);
  EXPECT_EQ(before->step, 4);
  // A run that resumes from it does not overwrite it.
  CheckpointKeeper next(folder.path(), "the run", &*before);
  keep(next, 6);
  EXPECT_EQ(find_checkpoint(folder.path(), refused)->step, 6);
  std::filesystem::remove(find_checkpoint(folder.path(), refused)->file);
  EXPECT_EQ(find_checkpoint(folder.path(), refused)->step, 4);
  next.remove_all();
  EXPECT_FALSE(std::filesystem::exists(folder.path()));
  EXPECT_FALSE(find_checkpoint(folder.path(), refused));
  EXPECT_THAT(refused, IsEmpty());
}

TEST_F(Checkpoint, EveryFlippedBitIsFound) {
  keep_two();
  const auto file = newest();
  const std::string sound = test::read_text(file);
  ASSERT_GT(sound.size(), 380U);
  for (std::size_t byte = 0; byte < sound.size(); ++byte) {
    std::string altered = sound;
    altered[byte] = static_cast<char>(altered[byte] ^ (1 << byte % 8));
    write(file, altered);
    SCOPED_TRACE(byte);
    expect_refused(file, "");
  }
  write(file, sound);
  EXPECT_EQ(newest(), file);
}

TEST_F(Checkpoint, EveryTruncationIsFound) {
  keep_two();
  const auto file = newest();
  const std::string sound = test::read_text(file);
  for (std::size_t length = 0; length < sound.size(); ++length) {
    write(file, sound.substr(0, length));
    SCOPED_TRACE(length);
    expect_refused(file, length == 0 ? "not a checkpoint" : "truncated");
  }
  write(file, sound + "x");
  expect_refused(file, "it has 1 extra bytes at its end");
}

TEST_F(Checkpoint, OtherFilesAreReported) {
  keep_two();
  const auto file = newest();
  const std::string sound = test::read_text(file);
  write(file, "\x89HDF\r\n\x1a\n" + std::string(1000, 'x'));
  expect_refused(file, "not a checkpoint of myowave");
  std::string newer = sound;
  newer[16] = 9;
  write(file, newer);
  expect_refused(file, "its format, 9, is newer than this program's, 3");
  std::string swapped = sound;
  std::reverse(swapped.begin() + 20, swapped.begin() + 24);
  write(file, swapped);
  expect_refused(file, "byte order");
}

TEST_F(Checkpoint, AFailedWriteLeavesEarlierOnes) {
  keep_two();
  std::vector<std::string> refused;
  const auto before = find_checkpoint(folder.path(), refused);
  CheckpointKeeper keeper(folder.path(), "the run", &*before);
  // A folder has the name of the file to write.
  std::filesystem::create_directory(folder / "checkpoint_even.tmp");
  EXPECT_THROW(
      {
        try {
          keep(keeper, 3);
        } catch (const std::runtime_error& error) {
          EXPECT_THAT(error.what(), HasSubstr("cannot write"));
          EXPECT_THAT(error.what(), HasSubstr("checkpoint_even.tmp"));
          throw;
        }
      },
      std::runtime_error);
  EXPECT_EQ(find_checkpoint(folder.path(), refused)->step, 2);
  std::filesystem::remove(folder / "checkpoint_even.tmp");
  keep(keeper, 3);
  EXPECT_EQ(find_checkpoint(folder.path(), refused)->step, 3);
  EXPECT_THAT(refused, IsEmpty());
}

}  // namespace
}  // namespace myowave::solver
