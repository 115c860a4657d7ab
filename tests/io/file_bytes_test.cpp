#include "io/file_bytes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
