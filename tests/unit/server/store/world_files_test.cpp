// The files of a world: creation, permissions, formats, and files that are not worlds.
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "server/store/store.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

void create(const std::string& folder) {
  const auto store = create_world(folder, sample_meta());
  if (!store) FAIL(store.error().message());
}

std::vector<char> bytes_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("a new world is for its owner alone, and a folder that is there stays as it is",
          "[store][sqlite]") {
  using std::filesystem::perms;
  const auto mode = [](const std::string& path) {
    return std::filesystem::status(path).permissions();
  };
  const perms own_file = perms::owner_read | perms::owner_write;
  const TempFolder folder;
  const std::string fresh = folder / "deep/world";
  const auto umask_before = ::umask(0);  // permits every mode
  {
    auto store = create_world(fresh, sample_meta());
    REQUIRE(store.has_value());
    SplitMix64 rng(3);
    REQUIRE((*store)->raise_epoch().has_value());
    REQUIRE((*store)->append({}, sample_records(rng, 1, 1, 1)).has_value());
    CHECK(mode(fresh) == perms::owner_all);
    CHECK(mode(fresh + "/world.sqlite") == own_file);
    CHECK(mode(fresh + "/world.sqlite-wal") == own_file);
    CHECK(mode(fresh + "/world.sqlite-shm") == own_file);
    CHECK(mode(fresh + "/world.durable") == own_file);
  }
  const std::string given = folder / "given";
  std::filesystem::create_directory(given);
  std::filesystem::permissions(given, perms::owner_all | perms::group_all);
  const bool is_made = create_world(given + "/", sample_meta()).has_value();
  ::umask(umask_before);
  CHECK(is_made);
  CHECK(mode(given) == (perms::owner_all | perms::group_all));
  CHECK(mode(given + "/world.sqlite") == own_file);
}

TEST_CASE("a world of a newer format is refused and its bytes stay as they are",
          "[store][sqlite]") {
  const TempFolder folder;
  create(folder.path());
  const std::string file = folder / "world.sqlite";
  REQUIRE(raw_sql(file, "PRAGMA user_version = 13").empty());
  const auto before = bytes_of(file);
  for (const StoreAccess access : {StoreAccess::read_only, StoreAccess::read_write}) {
    const auto store = open_world(folder.path(), access);
    REQUIRE_FALSE(store.has_value());
    CHECK(store.error().kind == StoreError::Kind::newer_version);
    CHECK(store.error().message() ==
          file + ": is of world format 13; this program knows format 12. Nothing was changed.");
  }
  CHECK(bytes_of(file) == before);
  CHECK_FALSE(std::filesystem::exists(file + "-wal"));
  REQUIRE(raw_sql(file, "PRAGMA user_version = 1").empty());
  const auto older = open_world(folder.path(), StoreAccess::read_write);
  REQUIRE_FALSE(older.has_value());
  CHECK(older.error().message().find(": is of world format 1; this program knows format 5. ") !=
        std::string::npos);
  REQUIRE(raw_sql(file, "PRAGMA user_version = 0").empty());
  CHECK(open_world(folder.path(), StoreAccess::read_only).error().kind ==
        StoreError::Kind::corrupt);
}

TEST_CASE("a file that is not a world is refused and does not change", "[store][sqlite]") {
  const TempFolder folder;
  const std::string file = folder / "world.sqlite";
  const auto kind = [&] { return open_world(folder.path(), StoreAccess::read_write).error().kind; };
  CHECK(kind() == StoreError::Kind::not_a_world);  // there is no file
  CHECK(std::filesystem::is_empty(folder.path()));
  std::ofstream(file)
      << "hello, I am a text file and long enough to be mistaken for something else";
  const auto text = bytes_of(file);
  CHECK(kind() == StoreError::Kind::not_a_world);
  CHECK(bytes_of(file) == text);
  CHECK(create_world(folder.path(), sample_meta()).error().kind == StoreError::Kind::exists);
  CHECK(bytes_of(file) == text);
  std::filesystem::remove(file);
  std::ofstream(file).flush();
  REQUIRE(raw_sql(file, "CREATE TABLE meta(key, value)").empty());  // a database of another program
  CHECK(kind() == StoreError::Kind::not_a_world);
}

TEST_CASE("a world is created once and only from meta that can be read back", "[store][sqlite]") {
  const TempFolder folder;
  WorldMeta meta = sample_meta();
  meta.chunk_edge = 48;
  CHECK(create_world(folder.path(), meta).error().kind == StoreError::Kind::bad_request);
  CHECK(std::filesystem::is_empty(folder.path()));
  create(folder.path());
  CHECK(create_world(folder.path(), sample_meta()).error().kind == StoreError::Kind::exists);
  CHECK(open_world(folder.path(), StoreAccess::read_write).has_value());
}

TEST_CASE("a WAL without its world is not replaced by a new world", "[store][sqlite]") {
  const TempFolder folder;
  const std::string wal = folder / "world.sqlite-wal";
  std::ofstream(wal) << "edits";
  const auto made = create_world(folder.path(), sample_meta());
  REQUIRE_FALSE(made.has_value());
  CHECK(made.error().kind == StoreError::Kind::exists);
  CHECK(made.error().what.find("world.sqlite-wal") != std::string::npos);
  CHECK(std::filesystem::file_size(wal) == 5);
  CHECK_FALSE(std::filesystem::exists(folder / "world.sqlite"));
}

TEST_CASE("a folder that cannot be written is reported", "[store][sqlite]") {
  // Root cannot make a folder there either, so the test holds in containers too.
  const auto made = create_world("/proc/runstone-world", sample_meta());
  REQUIRE_FALSE(made.has_value());
  CHECK(made.error().kind == StoreError::Kind::io);
  CHECK(made.error().file == "/proc/runstone-world/world.sqlite");
  const TempFolder folder;
  create(folder.path());
  std::filesystem::remove(folder / "world.lock");
  std::filesystem::create_directory(folder /
                                    "world.lock");  // root cannot open a folder for writing either
  const auto opened_again = open_world(folder.path(), StoreAccess::read_write);
  REQUIRE_FALSE(opened_again.has_value());
  CHECK(opened_again.error().kind == StoreError::Kind::io);
  CHECK(opened_again.error().file == folder / "world.lock");
}
