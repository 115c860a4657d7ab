#include "view/file_watch.h"

#include <gtest/gtest.h>

#include "io/file_bytes.h"
#include "program/run_program.h"
#include "support/temporary_folder.h"

namespace arris::view {
namespace {

using test::write_text;

class FileWatchTest : public testing::Test {
 protected:
  void SetUp() override {
    write_text(folder_ / "a", "one");
    write_text(folder_ / "b", "one");
  }
  void read(const std::string& name) const { read_file_bytes(folder_ / name); }
  // After one that hears of it.
  FileWatch::Look look_twice() {
    watch_.look();
    return watch_.look();
  }

  test::TemporaryFolder folder_;
  FileWatch watch_;
};

TEST_F(FileWatchTest, says_once_that_a_file_has_changed) {
  {
    FileWatch::Reading reading(watch_);
    read("a");
    reading.succeed();
  }
  EXPECT_FALSE(look_twice().changed);
  write_text(folder_ / "b", "another");
  EXPECT_FALSE(look_twice().changed);
  write_text(folder_ / "a", "another");
  EXPECT_FALSE(watch_.look().changed);  // it may be written still
  EXPECT_TRUE(watch_.look().changed);
  EXPECT_FALSE(look_twice().changed);
}

TEST_F(FileWatchTest, notices_a_save_while_the_model_is_read) {
  {
    FileWatch::Reading reading(watch_);
    read("a");
    write_text(folder_ / "a", "another");
    read("b");
    EXPECT_FALSE(look_twice().changed);  // first to its end
    reading.succeed();
  }
  EXPECT_TRUE(look_twice().changed);
}

TEST_F(FileWatchTest, a_reading_that_failed_keeps_what_was_watched) {
  {
    FileWatch::Reading reading(watch_);
    read("a");
    read("b");
    reading.succeed();
  }
  {
    FileWatch::Reading reading(watch_);
    read("a");
  }
  write_text(folder_ / "b", "another");
  EXPECT_TRUE(look_twice().changed);
}

TEST_F(FileWatchTest, says_that_a_file_was_deleted_and_that_all_are_back) {
  {
    FileWatch::Reading reading(watch_);
    read("a");
    read("b");
    reading.succeed();
  }
  std::filesystem::rename(folder_ / "a", folder_ / "away");
  EXPECT_EQ(watch_.look().problem, "");  // as programs do that save beside
  EXPECT_EQ(watch_.look().problem, "a was deleted");
  EXPECT_FALSE(watch_.look().changed);
  std::filesystem::rename(folder_ / "away", folder_ / "a");
  const FileWatch::Look back = look_twice();
  EXPECT_EQ(back.problem, "");
  EXPECT_TRUE(back.changed);
  EXPECT_FALSE(look_twice().changed);
}

}  // namespace
}  // namespace arris::view
