#include "common/os/new_folder.hpp"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "tests/support/core/temp_folder.hpp"

namespace runstone::test {
namespace {

namespace fs = std::filesystem;

std::set<std::string> names_in(const std::string& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    names.insert(entry.path().filename().string());
  return names;
}

/// Makes a folder with two files. Returns the error, or an empty text.
std::string make_at(const std::string& target) {
  std::ostringstream out;
  auto folder = NewFolder::make(target, out);
  if (!folder) return folder.error();
  std::ofstream(folder->path() + "/world.sqlite") << "a world";
  std::ofstream(folder->path() + "/world.durable") << "a mark";
  const auto finished = folder->finish("world.sqlite");
  return finished ? "" : finished.error();
}

const std::set<std::string> kMade = {"world.durable", "world.sqlite"};

}  // namespace

TEST_CASE("a new folder has its name when it is complete", "[os]") {
  const TempFolder folder;
  for (const char* name : {"a", "b/", "./c"}) {
    CAPTURE(name);
    REQUIRE(make_at(folder / name) == "");
    CHECK(names_in(folder / name) == kMade);
  }
  CHECK(names_in(folder.path()) == std::set<std::string>{"a", "b", "c"});
}

TEST_CASE("an empty folder is filled and stays the same folder", "[os]") {
  const TempFolder folder;
  fs::create_directory(folder / "disk");
  fs::create_directory(folder / "disk/lost+found");
  fs::permissions(folder / "disk", fs::perms::owner_all | fs::perms::group_read);
  fs::create_directory_symlink("disk", folder / "link");
  struct stat before{}, after{};
  REQUIRE(::stat((folder / "disk").c_str(), &before) == 0);
  SECTION("by its name") { REQUIRE(make_at(folder / "disk/") == ""); }
  SECTION("through a link, which stays") { REQUIRE(make_at(folder / "link") == ""); }
  REQUIRE(::stat((folder / "disk").c_str(), &after) == 0);
  CHECK(before.st_ino == after.st_ino);
  CHECK(before.st_mode == after.st_mode);
  CHECK(fs::is_symlink(folder / "link"));
  CHECK(names_in(folder / "disk") ==
        std::set<std::string>{"lost+found", "world.durable", "world.sqlite"});
  CHECK(make_at(folder / "disk") == (folder / "disk") + ": is not empty");
}

TEST_CASE("a folder that cannot be made is refused before the work", "[os]") {
  const TempFolder folder;
  fs::create_directory(folder / "full");
  std::ofstream(folder / "full/notes") << "mine";
  fs::create_directory_symlink("nowhere", folder / "dangling");
  const auto refused = [&](const std::string& name, const std::string& why) {
    CAPTURE(name);
    const auto checked = NewFolder::check(folder / name);
    REQUIRE_FALSE(checked.has_value());
    CHECK(checked.error().find(why) != std::string::npos);
    CHECK(make_at(folder / name) == checked.error());
  };
  refused("full", "is not empty");
  refused("full/notes", "is there and is no folder");
  refused("missing/world", "is no folder");
  refused("dangling", "is a symbolic link to a folder that does not exist");
  fs::create_directory(folder / "theirs.partial");
  std::ofstream(folder / "theirs.partial/thesis.txt") << "mine";
  refused("theirs", "is not what an interrupted program leaves");
  CHECK(fs::exists(folder / "theirs.partial/thesis.txt"));
}

TEST_CASE("an unfinished folder leaves nothing, and one that was interrupted is removed", "[os]") {
  const TempFolder folder;
  const bool is_there = GENERATE(false, true);
  if (is_there) fs::create_directory(folder / "world");
  const std::string partial = is_there ? folder / "world/.partial" : folder / "world.partial";
  std::ostringstream out;
  {
    auto made = NewFolder::make(folder / "world", out);
    REQUIRE(made.has_value());
    CHECK(made->path() == partial);
    std::ofstream(made->path() + "/world.sqlite") << "half a world";
    const auto second = NewFolder::make(folder / "world", out);
    REQUIRE_FALSE(second.has_value());
    CHECK(second.error() == partial + ": another program is writing it");
  }
  CHECK_FALSE(fs::exists(partial));
  CHECK(fs::exists(folder / "world") == is_there);
  fs::create_directory(partial);
  std::ofstream(partial + "/partial.lock") << "";
  std::ofstream(partial + "/world.sqlite") << "half a world";
  REQUIRE(make_at(folder / "world") == "");
  CHECK(names_in(folder / "world") == kMade);
  CHECK_FALSE(fs::exists(partial));
}

}  // namespace runstone::test
