// The library of builds in a store: builds are added and removed by records, found, copied, and
// verified, and their files come back byte by byte.
#include <xxhash.h>

#include <catch2/catch.hpp>
#include <optional>
#include <string>
#include <vector>

#include "server/store/build_table.hpp"
#include "server/store/copy_stored_world.hpp"
#include "server/store/world_schema.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/sql/temp_place.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {
namespace {

constexpr std::size_t kFileBytes = kBuildPartBytes * 2 + 100;

Bytes file_of_build(std::uint64_t content, std::size_t bytes = kFileBytes) {
  Bytes file(bytes);
  SplitMix64 rng(content);
  for (std::uint8_t& byte : file) byte = static_cast<std::uint8_t>(rng.next());
  return file;
}

AddBuild build_named(std::string name, std::uint64_t content, std::vector<std::string> tags = {}) {
  AddBuild build;
  build.info.name = std::move(name);
  build.info.author = "Ada";
  build.info.tags = std::move(tags);
  build.info.sides = {10, 20, 30};
  build.touched = 99;
  const Bytes file = file_of_build(content);
  build.file_bytes = file.size();
  build.file_digest = XXH3_64bits(file.data(), file.size());
  build.content = content;
  return build;
}

EditRecord library_record(Store& store, Sequence seq, LibraryChange change) {
  EditRecord record;
  record.version = {store.epoch(), seq};
  record.op = {static_cast<AuthorId>(1 + seq % 2), 7, seq};
  record.time_us = 1'700'000'000'000'000 + static_cast<TimeUs>(seq);
  record.cause = Cause::library;
  record.edit = library_edit(std::move(change));
  return record;
}

void save_file(Store& store, std::uint64_t content, const Bytes& file) {
  for (std::size_t at = 0; at < file.size(); at += kBuildPartBytes) {
    const std::size_t count = std::min(kBuildPartBytes, file.size() - at);
    const auto saved =
        store.save_build_part(content, static_cast<std::uint32_t>(at / kBuildPartBytes),
                              ByteView(file).subspan(at, count));
    if (!saved) FAIL(saved.error().message());
  }
}

void append_change(Store& store, Sequence seq, LibraryChange change) {
  const auto appended =
      store.append({}, std::vector{library_record(store, seq, std::move(change))});
  if (!appended) FAIL(appended.error().message());
}

void add_build(Store& store, Sequence seq, const AddBuild& build) {
  save_file(store, build.content, file_of_build(build.content));
  append_change(store, seq, build);
}

Bytes file_in(LibraryReader& reader, const StoredBuild& build) {
  Bytes file;
  const auto read = reader.read_build(build, [&](ByteView part) {
    file.insert(file.end(), part.begin(), part.end());
    return true;
  });
  if (!read) FAIL(read.error().message());
  return file;
}

std::vector<Sequence> numbers_found(LibraryReader& reader, const LibraryQuery& query) {
  const auto builds = reader.builds(query);
  if (!builds) FAIL(builds.error().message());
  std::vector<Sequence> numbers;
  for (const StoredBuild& build : *builds) numbers.push_back(build.number());
  return numbers;
}

std::unique_ptr<Store> started_world(const std::string& place) {
  auto store = create_world(place, sample_meta());
  REQUIRE(store.has_value());
  REQUIRE((*store)->raise_epoch().has_value());
  return *std::move(store);
}

void check_sound(Store& store) {
  if (const auto sound = store.check(); !sound) FAIL(sound.error().message());
}

/// A world with four builds, numbers 1 to 4.
std::unique_ptr<Store> world_with_builds(const std::string& place) {
  auto store = started_world(place);
  add_build(*store, 1, build_named("Old Mill", 11, {"Wood", "mill"}));
  add_build(*store, 2, build_named("Tower", 12, {"stone"}));
  add_build(*store, 3, build_named("M\xc3\x9chle am Bach", 13, {"mill"}));
  add_build(*store, 4, build_named("Windmill", 14, {"mill", "tall"}));
  return store;
}

}  // namespace

TEST_CASE("a build comes back with its record and its file, also after a restart", "[store]") {
  TempPlace place;
  std::optional<StoredBuild> before;
  {
    const auto store = world_with_builds(place.path());
    const auto build = store->build(3);
    REQUIRE((build.has_value() && build->has_value()));
    before = **build;
    check_sound(*store);
  }
  const auto store = open_world(place.path(), StoreAccess::read_only);
  REQUIRE(store.has_value());
  const auto build = (*store)->build(3);
  REQUIRE((build.has_value() && build->has_value()));
  CHECK((*build)->record == before->record);
  CHECK((*build)->build() == build_named("M\xc3\x9chle am Bach", 13, {"mill"}));
  CHECK(file_in(**store, **build) == file_of_build(13));
  const auto none = (*store)->build(5);
  REQUIRE(none.has_value());
  CHECK_FALSE(none->has_value());
  const auto rows = (*store)->library_rows();
  REQUIRE(rows.has_value());
  REQUIRE(rows->size() == 4);
  CHECK((*rows)[1] == LibraryRow{2, 1, kFileBytes});
}

TEST_CASE("a piece of a file is read without the parts before it", "[store]") {
  TempPlace place;
  const auto store = world_with_builds(place.path());
  const auto build = store->build(2);
  REQUIRE((build.has_value() && build->has_value()));
  const Bytes file = file_of_build(12);
  struct Piece {
    std::size_t offset, bytes_max;
  };
  for (const Piece& wanted : {Piece{0, 65'536}, Piece{196'608, 65'536}, Piece{kBuildPartBytes, 1},
                              Piece{kBuildPartBytes - 10, kBuildPartBytes + 20},
                              Piece{kBuildPartBytes * 2, 65'536}, Piece{kFileBytes - 1, 65'536}}) {
    CAPTURE(wanted.offset, wanted.bytes_max);
    const std::size_t count = std::min(wanted.bytes_max, kFileBytes - wanted.offset);
    const auto begin = file.begin() + static_cast<std::ptrdiff_t>(wanted.offset);
    const auto piece = store->read_build_piece(**build, wanted.offset, wanted.bytes_max);
    if (!piece) FAIL(piece.error().message());
    CHECK(*piece == Bytes(begin, begin + static_cast<std::ptrdiff_t>(count)));
  }
}

TEST_CASE("a file whose build is not added is removed, and that of a build is not", "[store]") {
  TempPlace place;
  const auto store = world_with_builds(place.path());
  save_file(*store, 15, file_of_build(15));
  REQUIRE(store->remove_build_file(15).has_value());
  REQUIRE(store->remove_build_file(15).has_value());  // is gone
  CHECK_FALSE(store->append({}, std::vector{library_record(*store, 5, build_named("Late", 15))})
                  .has_value());
  const auto refused = store->remove_build_file(12);
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error().kind == StoreError::Kind::bad_request);
  check_sound(*store);
}

TEST_CASE("builds are found by name, author and tag, newest first, in pages", "[store]") {
  TempPlace place;
  const auto store = world_with_builds(place.path());
  CHECK(numbers_found(*store, {}) == std::vector<Sequence>{4, 3, 2, 1});
  LibraryQuery query;
  query.count_max = 2;
  CHECK(numbers_found(*store, query) == std::vector<Sequence>{4, 3});
  query.before = 3;
  CHECK(numbers_found(*store, query) == std::vector<Sequence>{2, 1});
  query = {};
  query.name = "MILL";
  CHECK(numbers_found(*store, query) == std::vector<Sequence>{4, 1});
  query.tag = "wood";
  CHECK(numbers_found(*store, query) == std::vector<Sequence>{1});
  query = {};
  query.name = "m\xc3\xbchle";  // the other case
  CHECK(numbers_found(*store, query) == std::vector<Sequence>{3});
  query = {};
  query.tag = "mil";  // a tag counts as a whole
  CHECK(numbers_found(*store, query).empty());
  query.tag = "mill";
  CHECK(numbers_found(*store, query) == std::vector<Sequence>{4, 3, 1});
  query = {};
  query.author = "ad";
  CHECK(numbers_found(*store, query).size() == 4);
  query.author = "bob";
  CHECK(numbers_found(*store, query).empty());
  query = {};
  query.name = "%";  // no pattern
  CHECK(numbers_found(*store, query).empty());
}

TEST_CASE("a removed build is gone with its file, and its number stays unused", "[store]") {
  TempPlace place;
  const auto store = world_with_builds(place.path());
  const auto build = store->build(2);
  REQUIRE((build.has_value() && build->has_value()));
  append_change(*store, 5, RemoveBuild{2});
  append_change(*store, 6, RemoveBuild{2});    // nothing more to remove
  append_change(*store, 7, RemoveBuild{700});  // never was
  CHECK(numbers_found(*store, {}) == std::vector<Sequence>{4, 3, 1});
  CHECK_FALSE(store->read_build(**build, [](ByteView) { return true; }).has_value());
  check_sound(*store);
}

TEST_CASE("a build whose file is not in the store is refused, and left out of a history",
          "[store]") {
  TempPlace place;
  const auto store = started_world(place.path());
  const AddBuild build = build_named("Mill", 11);
  const auto record = library_record(*store, 1, build);
  const auto refused = store->append({}, std::vector{record});
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error().kind == StoreError::Kind::bad_request);
  // A part is missing.
  REQUIRE(store->save_build_part(11, 0, ByteView(file_of_build(11)).first(kBuildPartBytes))
              .has_value());
  CHECK_FALSE(store->append({}, std::vector{record}).has_value());
  REQUIRE(store->append_history({}, std::vector{record}).has_value());
  CHECK(numbers_found(*store, {}).empty());
  check_sound(*store);
  // A file belongs to one build.
  add_build(*store, 2, build_named("Tower", 12));
  CHECK_FALSE(store->save_build_part(12, 0, file_of_build(1, 10)).has_value());
  CHECK_FALSE(store->append({}, std::vector{library_record(*store, 3, build_named("Again", 12))})
                  .has_value());
}

TEST_CASE("files whose builds were never added are removed by the next start", "[store]") {
  TempPlace place;
  {
    const auto store = world_with_builds(place.path());
    save_file(*store, 15, file_of_build(15));
    check_sound(*store);
  }
  auto store = open_world(place.path(), StoreAccess::read_write);
  REQUIRE(store.has_value());
  REQUIRE((*store)->raise_epoch().has_value());
  check_sound(**store);
  const auto late =
      (*store)->append({}, std::vector{library_record(**store, 5, build_named("Late", 15))});
  CHECK_FALSE(late.has_value());  // its file is gone
}

TEST_CASE("a world without a library stays of its format, and one with it is of format 7",
          "[store][sqlite]") {
  TempFolder folder;
  const std::string place = folder / "world";
  const auto format = [&] { return raw_sql(place + "/world.sqlite", "PRAGMA user_version"); };
  {
    const auto store = started_world(place);
    CHECK(numbers_found(*store, {}).empty());
    CHECK(store->library_rows()->empty());
  }
  CHECK(format() == std::to_string(kWorldFormat));
  {
    auto store = open_world(place, StoreAccess::read_write);
    REQUIRE(store.has_value());
    REQUIRE((*store)->raise_epoch().has_value());
    add_build(**store, 1, build_named("Mill", 11));
  }
  CHECK(format() == std::to_string(kWorldFormatOfLibrary));
}

TEST_CASE("a copy of a world has its library", "[store]") {
  TempPlace place;
  const std::string copy = place / "copy";
  {
    const auto store = world_with_builds(place.path());
  }
  const auto copied = copy_stored_world(place.path(), copy);
  if (!copied) FAIL(copied.error().message());
  {
    const auto store = open_world(copy, StoreAccess::read_only);
    REQUIRE(store.has_value());
    CHECK(numbers_found(**store, {}) == std::vector<Sequence>{4, 3, 2, 1});
    const auto build = (*store)->build(4);
    REQUIRE((build.has_value() && build->has_value()));
    CHECK(file_in(**store, **build) == file_of_build(14));
  }
  {
    auto store = open_world(copy, StoreAccess::read_write);
    REQUIRE(store.has_value());
    REQUIRE((*store)->raise_epoch().has_value());
    add_build(**store, 5, build_named("Fifth", 15));
    check_sound(**store);
  }
  if (place.is_postgres()) return;
  CHECK(raw_sql(copy + "/world.sqlite", "PRAGMA user_version") ==
        std::to_string(kWorldFormatOfLibrary));
}

TEST_CASE("damage to the rows of a library is named", "[store][sqlite]") {
  TempFolder folder;
  const std::string place = folder / "world";
  {
    const auto store = world_with_builds(place);
  }
  struct Damage {
    const char* sql;
    const char* where;
  };
  for (const Damage& damage :
       {Damage{"UPDATE build SET name = 'x' WHERE number = 2", "build number=2"},
        Damage{"DELETE FROM build WHERE number = 2", "build"},
        Damage{"UPDATE build_part SET data = zeroblob(100) WHERE content = 13 AND part = 2",
               "build_part content=13 part=2 of build 3"},
        Damage{"DELETE FROM build_part WHERE content = 13 AND part = 1",
               "build_part content=13 part=1 of build 3"}}) {
    CAPTURE(damage.sql);
    TempFolder damaged;
    const std::string copy = damaged / "copy";
    REQUIRE(copy_stored_world(place, copy).has_value());
    REQUIRE(raw_sql(copy + "/world.sqlite", damage.sql).empty());
    const auto store = open_world(copy, StoreAccess::read_only);
    REQUIRE(store.has_value());
    const auto sound = (*store)->check();
    REQUIRE_FALSE(sound.has_value());
    CHECK(sound.error().kind == StoreError::Kind::corrupt);
    CHECK(sound.error().where == damage.where);
  }
}

TEST_CASE("damage to one part of a file keeps only that part from being read", "[store][sqlite]") {
  TempFolder folder;
  const std::string place = folder / "world";
  {
    const auto store = world_with_builds(place);
  }
  REQUIRE(raw_sql(place + "/world.sqlite",
                  "UPDATE build_part SET data = zeroblob(100) WHERE content = 13 AND part = 1")
              .empty());
  const auto store = open_world(place, StoreAccess::read_only);
  REQUIRE(store.has_value());
  const auto build = (*store)->build(3);
  REQUIRE((build.has_value() && build->has_value()));
  CHECK((*store)->read_build_piece(**build, 0, 65'536).has_value());
  CHECK((*store)->read_build_piece(**build, kBuildPartBytes * 2, 65'536).has_value());
  const auto damaged = (*store)->read_build_piece(**build, kBuildPartBytes, 65'536);
  REQUIRE_FALSE(damaged.has_value());
  CHECK(damaged.error().where == "build_part content=13 part=1 of build 3");
}

}  // namespace runstone::test
