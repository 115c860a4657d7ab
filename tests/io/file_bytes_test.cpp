#include "io/file_bytes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "arris/error.h"
#include "support/temporary_folder.h"

namespace arris {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using testing::HasSubstr;

std::vector<std::uint8_t> some_bytes(std::size_t count) {
  std::vector<std::uint8_t> bytes(count);
  for (std::size_t i = 0; i < count; ++i) bytes[i] = std::uint8_t(i * 7 + i / 256);
  return bytes;
}

std::string error_of(auto&& action, Error::Kind kind) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(int(error.kind()), int(kind));
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

TEST(FileBytes, read_returns_what_was_written) {
  const TemporaryFolder folder;
  for (const std::size_t count : {0, 1, 65536, 65537, 1000003}) {
    write_file_whole(folder / "a", some_bytes(count));
    EXPECT_EQ(read_file_bytes(folder / "a"), some_bytes(count)) << count;
  }
}

TEST(FileBytes, read_takes_files_that_have_no_size) {
  EXPECT_FALSE(read_file_bytes("/proc/self/status").empty());
}

TEST(FileBytes, read_names_the_file_and_the_reason) {
  const TemporaryFolder folder;
  EXPECT_THAT(error_of([&] { read_file_bytes(folder / "none"); }, Error::Kind::input),
              testing::AllOf(HasSubstr("/none: "), HasSubstr("No such file")));
  EXPECT_THAT(error_of([&] { read_file_bytes(folder.path()); }, Error::Kind::input),
              HasSubstr("is a folder"));
}

TEST(FileBytes, read_refuses_files_above_the_limit) {
  const TemporaryFolder folder;
  write_file_whole(folder / "a", some_bytes(101));
  EXPECT_EQ(read_file_bytes(folder / "a", 101).size(), 101U);
  EXPECT_THAT(error_of([&] { read_file_bytes(folder / "a", 100); }, Error::Kind::input),
              HasSubstr("limit of 100 bytes"));
}

TEST(FileBytes, read_refuses_what_may_never_end) {
  const TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", folder / "zero");
  for (const char* name : {"pipe", "zero"}) {
    EXPECT_THAT(error_of([&] { read_file_bytes(folder / name); }, Error::Kind::input),
                HasSubstr("is a pipe or device, not a file; copy what comes from it to a file"));
  }
}

TEST(FileBytes, new_files_appear_together_or_not_at_all) {
  const TemporaryFolder folder;
  write_file_whole(folder / "a", some_bytes(3));
  fs::create_directory(folder / "c");
  {
    NewFiles files;
    files.add(folder / "a", some_bytes(10));
    files.add(folder / "b", some_bytes(10));
    EXPECT_THROW(files.add(folder / "c", some_bytes(10)), Error);
  }
  EXPECT_EQ(read_file_bytes(folder / "a"), some_bytes(3));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 2);
  NewFiles files;
  files.add(folder / "a", some_bytes(10));
  files.add(folder / "b", some_bytes(20));
  files.appear();
  EXPECT_EQ(read_file_bytes(folder / "a"), some_bytes(10));
  EXPECT_EQ(read_file_bytes(folder / "b"), some_bytes(20));
}

TEST(FileBytes, write_keeps_links_to_what_is_not_there_yet) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "d");
  fs::create_symlink("d/target", folder / "link");
  fs::create_symlink("link", folder / "second");
  write_file_whole(folder / "second", some_bytes(5));
  EXPECT_TRUE(fs::is_symlink(folder / "second"));
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(read_file_bytes(folder / "d/target"), some_bytes(5));
}

TEST(FileBytes, write_replaces_the_file_and_leaves_nothing_else) {
  const TemporaryFolder folder;
  write_file_whole(folder / "a", some_bytes(10));
  write_file_whole(folder / "a", some_bytes(5));
  EXPECT_EQ(read_file_bytes(folder / "a"), some_bytes(5));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1);
}

TEST(FileBytes, write_follows_links) {
  const TemporaryFolder folder;
  write_file_whole(folder / "target", some_bytes(10));
  fs::create_symlink(folder / "target", folder / "link");
  write_file_whole(folder / "link", some_bytes(5));
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(read_file_bytes(folder / "target"), some_bytes(5));
}

TEST(FileBytes, write_says_why_it_failed) {
  const TemporaryFolder folder;
  EXPECT_THAT(
      error_of([&] { write_file_whole(folder / "no/a", some_bytes(5)); }, Error::Kind::failed),
      testing::AllOf(HasSubstr("no/a: can't be written: "), HasSubstr("No such file")));
  EXPECT_THAT(
      error_of([&] { write_file_whole(folder.path(), some_bytes(5)); }, Error::Kind::failed),
      HasSubstr("directory"));
  EXPECT_THAT(error_of([&] { write_file_whole("/dev/full", some_bytes(5)); }, Error::Kind::failed),
              HasSubstr("No space"));
}

}  // namespace
}  // namespace arris
