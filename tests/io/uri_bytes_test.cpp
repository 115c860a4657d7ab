#include "io/uri_bytes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "arris/error.h"
#include "io/file_bytes.h"
#include "support/temporary_folder.h"

namespace arris {
namespace {

using testing::HasSubstr;

TEST(UriBytes, stay_in_the_models_folder) {
  const test::TemporaryFolder folder;
  const std::vector<std::uint8_t> bytes{1, 2, 3};
  std::filesystem::create_directories(folder / "model/parts");
  for (const char* name : {"secret", "model/a b.bin", "model/parts/..b", "model/parts/c"}) {
    write_file_whole(folder / name, bytes);
  }
  const auto load = [&](const std::string& uri) {
    return load_uri(uri, folder / "model", "m.gltf: buffer 0");
  };
  for (const char* uri : {"a%20b.bin", "parts/c", "./parts/../a b.bin", "parts/..b"}) {
    EXPECT_EQ(load(uri), bytes) << uri;
  }
  for (const std::string& uri :
       {std::string("../secret"), std::string("parts/../../secret"), std::string("%2e%2e/secret"),
        std::string("../model/parts/c"), (folder / "secret").string()}) {
    try {
      load(uri);
      ADD_FAILURE() << uri;
    } catch (const Error& error) {
      EXPECT_EQ(int(error.kind()), int(Error::Kind::input));
      EXPECT_THAT(error.what(), HasSubstr("is outside the model's folder; put the file in it"));
      EXPECT_THAT(error.what(), HasSubstr("m.gltf: buffer 0: "));
    }
  }
}

}  // namespace
}  // namespace arris
