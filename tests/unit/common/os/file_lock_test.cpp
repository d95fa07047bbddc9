#include "common/os/file_lock.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <utility>

#include "tests/support/core/temp_folder.hpp"

using namespace runstone;
using namespace runstone::test;

TEST_CASE("a lock refuses a second lock on its file until it is released", "[os]") {
  const TempFolder folder;
  const std::string file = folder / "a.lock";
  {
    auto first = FileLock::take(file);
    REQUIRE(first.has_value());
    const auto second = FileLock::take(file);
    REQUIRE_FALSE(second.has_value());
    CHECK(second.error().is_held);
    CHECK(FileLock::take(folder / "b.lock").has_value());

    FileLock moved = *std::move(first);
    CHECK_FALSE(FileLock::take(file).has_value());
    FileLock assigned;
    assigned = std::move(moved);
    CHECK_FALSE(FileLock::take(file).has_value());
  }
  CHECK(std::filesystem::exists(file));
  CHECK(FileLock::take(file).has_value());
}

TEST_CASE("the error of a lock on a file that cannot be opened has the reason", "[os]") {
  const TempFolder folder;
  const auto lock = FileLock::take(folder / "none/a.lock");
  REQUIRE_FALSE(lock.has_value());
  CHECK_FALSE(lock.error().is_held);
  CHECK(lock.error().what == "No such file or directory");
}
