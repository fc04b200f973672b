// Records of a sweep: reading them back, and the handling of damaged ones.
#include "apps/sweep/sweep_records.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "apps/base/revision.hpp"
#include "apps/sweep/sweep_file.hpp"
#include "apps/sweep/sweep_slurm.hpp"
#include "apps/sweep/sweep_table.hpp"
#include "tests/support/command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace myowave::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using test::read_text;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

ordered_json record(const std::string& id, const char* outcome = "end", const char* revision = git_revision(),
                    int schema = sweep_schema) {
  return {{"schema", schema}, {"id", id}, {"program", {{"git_hash", revision}}}, {"outcome", outcome}};
}

// A sweep's folder with one file of records.
class RecordsFolder {
 public:
  RecordsFolder() { fs::create_directories(folder_ / "records"); }
  fs::path file(const char* name = "shard_1_of_1.jsonl") const { return folder_ / "records" / name; }
  Records read() const { return read_records(folder_.path()); }
  void write(const std::string& text, const char* name = "shard_1_of_1.jsonl") const {
    std::ofstream(file(name), std::ios::app | std::ios::binary) << text;
  }

 private:
  test::TemporaryFolder folder_;
};

TEST(Records, AreReadAsTheyWereWritten) {
  const RecordsFolder folder;
  ordered_json one = record("a");
  one["observables"] = {{"period", 0.1 + 0.2}, {"text", "\"quoted\"\nand more \xff"}};
  {
    RecordFile file(folder.file());
    file.append(one);
    file.append(record("b", "failed"));
  }
  const auto records = folder.read();
  EXPECT_THAT(records.refused, IsEmpty());
  ASSERT_THAT(records.by_id, SizeIs(2));
  EXPECT_EQ(records.by_id.at("a")["observables"]["period"], 0.1 + 0.2);
  EXPECT_FALSE(failed(records.by_id.at("a")));
  EXPECT_TRUE(failed(records.by_id.at("b")));
}

TEST(Records, APartOfALineIsLeftOutAndCutByTheNextWriter) {
  const std::string a = record_line(record("a")), b = record_line(record("b")), c = record_line(record("c"));
  for (std::size_t cut = 0; cut < b.size(); ++cut) {
    const RecordsFolder folder;
    folder.write(a + b.substr(0, cut));
    EXPECT_THAT(folder.read().by_id, SizeIs(1)) << cut;
    RecordFile(folder.file()).append(record("c"));
    EXPECT_EQ(read_text(folder.file()), a + c) << cut;
    EXPECT_THAT(folder.read().refused, IsEmpty());
  }
}

TEST(Records, EveryFlippedBitIsFound) {
  const std::string a = record_line(record("a")), b = record_line(record("b"));
  for (std::size_t at = 0; at + 1 < b.size(); ++at) {
    const RecordsFolder folder;
    std::string damaged = b;
    damaged[at] = char(damaged[at] ^ (1 << (at % 8)));
    if (damaged[at] == '\n') continue;  // two partial lines: tested below
    folder.write(a + damaged + record_line(record("c")));
    const auto records = folder.read();
    EXPECT_THAT(records.by_id, SizeIs(2)) << at;
    ASSERT_THAT(records.refused, SizeIs(1)) << at;
    EXPECT_THAT(records.refused[0],
                AllOf(HasSubstr("shard_1_of_1.jsonl:2: the line is"), HasSubstr("the sweep repeats it")))
        << at;
  }
}

TEST(Records, ForeignAndNewerLinesAreReported) {
  const RecordsFolder folder;
  folder.write("hello\n\n{\"check\":\"0123456789abcdef\",\"schema\":1}\n" + record_line({{"some", "thing"}}) +
               record_line(record("new", "end", git_revision(), sweep_schema + 1)) +
               record_line(record("a")) +
               record_line({{"schema", 1}, {"id", "b"}, {"program", "myowave"}, {"outcome", "end"}}) +
               record_line({{"schema", 1}, {"id", "c"}, {"program", {{"git_hash", "x"}}}, {"outcome", 5}}));
  const auto records = folder.read();
  EXPECT_THAT(records.by_id, SizeIs(1));
  ASSERT_THAT(records.refused, SizeIs(7));
  EXPECT_THAT(records.refused[3], HasSubstr(":4: the line is not a record of a sweep"));
  EXPECT_THAT(records.refused[4], HasSubstr(":5: the line is of a newer myowave (schema 2, here 1)"));
  EXPECT_THAT(records.refused[5], HasSubstr(":7: the line is not a record of a sweep"));
  EXPECT_THAT(records.refused[6], HasSubstr(":8: the line is not a record of a sweep"));
}

// Prefers a success to a failure, this revision to another, then the newest.
TEST(Records, TheBestOfDuplicateRecordsIsUsed) {
  const RecordsFolder folder;
  folder.write(record_line(record("a", "failed")) + record_line(record("a", "breakup", "old")) +
                   record_line(record("b", "death")) + record_line(record("b", "end", "old")),
               "shard_1_of_2.jsonl");
  folder.write(record_line(record("a", "failed")) + record_line(record("b", "breakup")),
               "shard_2_of_2.jsonl");
  const auto records = folder.read();
  EXPECT_EQ(records.by_id.at("a")["outcome"], "breakup");
  EXPECT_EQ(records.by_id.at("b")["outcome"], "breakup");
}

TEST(RecordFile, ReportsThatItWasRemoved) {
  const RecordsFolder folder;
  RecordFile file(folder.file());
  file.append(record("a"));
  fs::remove(folder.file());
  try {
    file.append(record("b"));
    FAIL() << "a record was written to a removed file";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr(folder.file().string() + ": the file was removed"));
  }
}

TEST(ShardLock, NamesItsOwnerAndEndsWithIt) {
  const test::TemporaryFolder folder;
  const fs::path path = folder / "shard.lock";
  EXPECT_EQ(ShardLock::owner_of(path), "");
  const pid_t child = fork();
  if (child == 0) {
    const ShardLock lock(path);
    kill(getpid(), SIGKILL);
  }
  waitpid(child, nullptr, 0);
  {
    const ShardLock lock(path);  // although its text is still there
    EXPECT_THAT(ShardLock::owner_of(path), HasSubstr("process " + std::to_string(getpid()) + " on "));
    try {
      const ShardLock second(path);
      FAIL() << "two owners";
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), HasSubstr(path.string() + " is locked"));
      EXPECT_THAT(error.what(), HasSubstr("process " + std::to_string(getpid())));
    }
  }
  EXPECT_EQ(ShardLock::owner_of(path), "");
}

// As ShardLock::owner_of() does, in another process.
TEST(ShardLock, WaitsForOneWhoOnlyAsks) {
  const test::TemporaryFolder folder;
  const fs::path path = folder / "shard.lock";
  { const ShardLock made(path); }
  const int asking = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(flock(asking, LOCK_SH | LOCK_NB), 0);
  const std::jthread ends([asking] {
    std::this_thread::sleep_for(std::chrono::milliseconds(15));
    close(asking);
  });
  EXPECT_NO_THROW(ShardLock{path});
}

TEST(Shard, PartsHaveEveryRunOnce) {
  for (std::size_t run = 0; run < 20; ++run) {
    int owners = 0;
    for (std::size_t number = 1; number <= 3; ++number) owners += Shard{number, 3}.has(run);
    EXPECT_EQ(owners, 1);
  }
  EXPECT_EQ((Shard{2, 3}.name()), "shard_2_of_3");
}

TEST(Slurm, QuotesForTheShell) {
  EXPECT_EQ(shell_quoted("/a/b-c_1.toml"), "/a/b-c_1.toml");
  EXPECT_EQ(shell_quoted("it's here"), R"('it'\''s here')");
  EXPECT_EQ(shell_quoted(""), "''");
  const std::string script = slurm_script("/bin/my wave", "/s $x.toml", "/o%t", {.tasks = 5, .cpus = 3});
  EXPECT_THAT(script, HasSubstr("#SBATCH --array=1-5\n"));
  EXPECT_THAT(script, HasSubstr("#SBATCH --cpus-per-task=3\n#SBATCH --time=24:00:00\n#SBATCH --requeue\n"));
  EXPECT_THAT(script, HasSubstr("#SBATCH --output=\"/o%%t/slurm_%A_%a.log\"\n"));
  EXPECT_THAT(script, HasSubstr("'/bin/my wave' sweep '/s $x.toml' --out '/o%t' --shard "
                                "\"$SLURM_ARRAY_TASK_ID\"/5 --jobs 3 &\n"));
}

}  // namespace
}  // namespace myowave::apps
