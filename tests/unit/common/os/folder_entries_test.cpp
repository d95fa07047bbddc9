#include "common/os/folder_entries.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "tests/support/core/temp_folder.hpp"

namespace runstone::test {

TEST_CASE("the entries of a folder are sorted, and a folder that cannot be read is named", "[os]") {
  namespace fs = std::filesystem;
  const TempFolder folder;
  CHECK(folder_entries(folder.path())->empty());
  for (const char* const name : {"c", ".hidden", "b"}) std::ofstream(folder / name) << "x";
  fs::create_directory(folder / "a");
  std::ofstream(folder / "a/inner") << "x";
  fs::create_symlink("nowhere", folder / "d");
  const auto entries = folder_entries(folder.path());
  REQUIRE(entries.has_value());
  CHECK(*entries == std::vector<fs::path>{folder / ".hidden", folder / "a", folder / "b",
                                          folder / "c", folder / "d"});
  for (const std::string& none : {folder / "none", folder / "b"}) {
    const auto unread = folder_entries(none);
    REQUIRE_FALSE(unread.has_value());
    CHECK(unread.error().starts_with(none + ": cannot be read: "));
  }
}

}  // namespace runstone::test
