// Damage in any column of any table is detected, named in the error, and never repaired. The table
// of tiles is a cache and has its own test (tile_table_test.cpp).
#include <catch2/catch.hpp>
#include <filesystem>

#include "server/store/copy_stored_world.hpp"
#include "server/store/sqlite_backend.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/sql/temp_place.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

constexpr ChunkKey kBaseKey{0, {2, 3, 4}};
constexpr ChunkKey kSnapshotKey{0, {1, 0, -3}};

/// Makes a world with at least one row in every table, and closes it.
void make_world(const std::string& place) {
  SplitMix64 rng(77);
  auto store = create_world(place, sample_meta());
  REQUIRE(store.has_value());
  const std::vector<std::pair<ChunkKey, ChunkPtr>> base = {{kBaseKey, sample_chunk(rng, {})}};
  REQUIRE((*store)->save_base(base).has_value());
  REQUIRE((*store)->raise_epoch().has_value());
  const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
  REQUIRE((*store)->append(players, sample_records(rng, 1, 1, 20)).has_value());
  const std::vector<std::pair<ChunkKey, ChunkPtr>> snapshots = {
      {kSnapshotKey, sample_chunk(rng, {1, 12})}, {{0, {5, 5, 5}}, sample_chunk(rng, {1, 13})}};
  REQUIRE((*store)->save_snapshots(snapshots, 12).has_value());
}

/// Opens and checks a world. Returns the place of the first damage, or "fine".
std::string audit(const std::string& place) {
  auto store = open_world(place, StoreAccess::read_only);
  const auto verdict = store ? (*store)->check() : failure(store.error());
  if (verdict) return "fine";
  if (verdict.error().kind != StoreError::Kind::corrupt)
    return "not corrupt: " + verdict.error().message();
  if (verdict.error().what.empty()) return "no cause";
  return verdict.error().where;
}

/// Returns the place of the damage that one SQL statement does to a fresh copy of `pristine`.
std::string damage(TempPlace& pristine, const std::string& sql) {
  TempPlace copy;
  if (pristine.is_postgres()) {
    REQUIRE(copy_stored_world(pristine.path(), copy.path()).has_value());
  } else {
    std::filesystem::copy(pristine.path(), copy.path(),
                          std::filesystem::copy_options::recursive |
                              std::filesystem::copy_options::overwrite_existing);
  }
  const std::string answer = raw_sql(copy / "world.sqlite", sql + "; SELECT changes()");
  if (answer != "1") return "nothing damaged: " + answer;
  return audit(copy.path());
}

}  // namespace

TEST_CASE("an undamaged world passes its audit", "[store][damage]") {
  TempPlace place;
  make_world(place.path());
  CHECK(audit(place.path()) == "fine");
}

TEST_CASE("a changed column of the edit log is named", "[store][damage][sqlite]") {
  TempPlace place;
  make_world(place.path());
  for (const char* column : {"epoch", "author", "instance", "client_seq", "time_us", "min_x",
                             "min_y", "min_z", "max_x", "max_y", "max_z", "checksum"}) {
    CAPTURE(column);
    const std::string set =
        std::string("UPDATE edit_log SET ") + column + " = " + column + " + 1 WHERE seq = 7";
    CHECK(damage(place, set) == "edit_log seq=7");
  }
  for (const char* subject : {"1 - subject", "7", "-1", "99"}) {  // 7 would be its own subject
    CAPTURE(subject);
    CHECK(damage(place, std::string("UPDATE edit_log SET subject = ") + subject +
                            " WHERE seq = 7") == "edit_log seq=7");
  }
  CHECK(damage(place, "UPDATE edit_log SET client_seq = -client_seq WHERE seq = 7") ==
        "edit_log seq=7");
  CHECK(damage(place, "UPDATE edit_log SET cause = cause | 64 WHERE seq = 7") == "edit_log seq=7");
  CHECK(damage(place, "UPDATE edit_log SET cause = (cause + 1) % 6 WHERE seq = 7") ==
        "edit_log seq=7");
  CHECK(
      damage(place,
             "UPDATE edit_log SET descriptor = CAST(descriptor || x'00' AS BLOB) WHERE seq = 7") ==
      "edit_log seq=7");
  CHECK(damage(place,
               "UPDATE edit_log SET descriptor = (SELECT descriptor FROM edit_log WHERE seq = 8) "
               "WHERE seq = 7") == "edit_log seq=7");
  CHECK(damage(place, "UPDATE edit_log SET log = 1 WHERE seq = 7") == "edit_log");
  CHECK(damage(place, "UPDATE edit_log SET log = -1 WHERE seq = 20") == "edit_log");
}

TEST_CASE("a missing or moved edit is named", "[store][damage]") {
  TempPlace place;
  make_world(place.path());
  CHECK(damage(place, "DELETE FROM edit_log WHERE seq = 7") == "edit_log seq=7");
  CHECK(damage(place, "UPDATE edit_log SET seq = 99 WHERE seq = 7") == "edit_log seq=7");
  CHECK(damage(place, "UPDATE edit_log SET seq = 21 WHERE seq = 20") == "edit_log seq=20");
  CHECK(damage(place, "DELETE FROM edit_log WHERE seq > 12 AND seq > 19") ==
        "fine");  // a log without its last edits is a log; world.durable reveals the loss
}

TEST_CASE("a log that ends before its snapshots or its checkpoint is noticed", "[store][damage]") {
  TempPlace place;
  make_world(place.path());
  REQUIRE(raw_sql(place / "world.sqlite", "DELETE FROM edit_log WHERE seq > 12").empty());
  CHECK(audit(place.path()) == "snapshot chunk=5,5,5");  // a snapshot refers to the missing edits
  REQUIRE(raw_sql(place / "world.sqlite", "DELETE FROM edit_log WHERE seq > 11").empty());
  CHECK(audit(place.path()) == "edit_log");
  const auto store = open_world(place.path(), StoreAccess::read_only);
  CHECK((*store)->checkpoint().error().kind == StoreError::Kind::corrupt);
}

TEST_CASE("a changed column of a snapshot or base chunk is named", "[store][damage][sqlite]") {
  TempPlace place;
  make_world(place.path());
  struct Table {
    std::string name, where, place;
  };
  const Table tables[] = {{"base", " WHERE x = 2", "base chunk=2,3,4"},
                          {"snapshot", " WHERE x = 1", "snapshot chunk=1,0,-3"}};
  for (const Table& table : tables) {
    const std::string update = "UPDATE " + table.name + " SET ";
    for (const char* column : {"digest0", "digest1", "checksum"}) {
      CAPTURE(table.name, column);
      CHECK(damage(place, update + column + " = " + column + " + 1" + table.where) == table.place);
    }
    // A test of every byte of the chunk would take long. The first, the last and one between are
    // enough.
    for (const char* at : {"1", "length(data) / 2 + 1", "length(data)"}) {
      CAPTURE(table.name, at);
      const std::string byte = std::string("substr(data, ") + at + ", 1)";
      CHECK(damage(place, update + "data = CAST(substr(data, 1, " + at + " - 1) || (CASE " + byte +
                              " WHEN x'ff' THEN x'00' ELSE x'ff' END) || substr(data, " + at +
                              " + 1) AS BLOB)" + table.where) == table.place);
    }
    CHECK(damage(place, update + "data = CAST(substr(data, 1, length(data) - 1) AS BLOB)" +
                            table.where) == table.place);
    // A row with another key counts as one that vanished.
    for (const char* column : {"lod", "x", "y", "z"}) {
      CAPTURE(table.name, column);
      CHECK(damage(place, update + column + " = " + column + " + 256" + table.where) == table.name);
    }
    CHECK(damage(place, "DELETE FROM " + table.name + table.where) == table.name);
  }
  CHECK(damage(place, "UPDATE base SET seq = 1 WHERE x = 2") == "base");
  CHECK(damage(place, "UPDATE base SET epoch = 1 WHERE x = 2") == "base");
  CHECK(damage(place, "UPDATE snapshot SET seq = seq - 1 WHERE x = 1") == "snapshot");
  CHECK(damage(place, "UPDATE snapshot SET epoch = 0 WHERE x = 1") == "snapshot");
}

TEST_CASE("loading one damaged chunk fails and its neighbours still load",
          "[store][damage][sqlite]") {
  TempPlace place;
  make_world(place.path());
  REQUIRE(
      raw_sql(place / "world.sqlite", "UPDATE snapshot SET data = x'0102' WHERE x = 1").empty());
  const auto store = open_world(place.path(), StoreAccess::read_only);
  const auto damaged = (*store)->load_snapshot(kSnapshotKey);
  REQUIRE_FALSE(damaged.has_value());
  CHECK(damaged.error().kind == StoreError::Kind::corrupt);
  CHECK(damaged.error().message() ==
        place / "world.sqlite: snapshot chunk=1,0,-3: checksum is wrong");
  CHECK((*store)->load_snapshot({0, {5, 5, 5}})->has_value());
  CHECK((*store)->load_base(kBaseKey)->has_value());
}

TEST_CASE("a changed column of a player's name is named", "[store][damage]") {
  TempPlace place;
  make_world(place.path());
  CHECK(damage(place, "UPDATE player_name SET name = name || '!' WHERE author = 2") ==
        "player_name author=2 number=1");
  CHECK(damage(place, "UPDATE player_name SET author = 3 WHERE author = 2") ==
        "player_name author=3 number=1");
  CHECK(damage(place, "UPDATE player_name SET number = 4 WHERE author = 2") ==
        "player_name author=2 number=4");
  CHECK(damage(place, "UPDATE player_name SET checksum = 0 WHERE author = 2") ==
        "player_name author=2 number=1");
}

TEST_CASE("a changed column of a player is named", "[store][damage][sqlite]") {
  TempPlace place;
  make_world(place.path());
  CHECK(damage(place, "UPDATE player SET name = name || '!' WHERE author = 2") ==
        "player author=2");
  CHECK(damage(place, "UPDATE player SET author = 3 WHERE author = 2") == "player author=3");
  CHECK(damage(place, "UPDATE player SET key = zeroblob(32) WHERE author = 2") ==
        "player author=2");
  CHECK(damage(place, "UPDATE player SET checksum = 0 WHERE author = 2") == "player author=2");
  CHECK(damage(place, "DELETE FROM player WHERE author = 2") == "player");
  const std::string last =
      " WHERE author = 2 AND instance = (SELECT max(instance) FROM player_instance)";
  const std::string name =
      "player_instance author=2 instance=" + std::to_string(0xf000000000000001ULL);
  CHECK(damage(place, "UPDATE player_instance SET decided = decided + 1" + last) == name);
  CHECK(damage(place, "UPDATE player_instance SET decided = 0" + last) == name);
  CHECK(damage(place, "UPDATE player_instance SET decided = -decided" + last) == name);
  CHECK(damage(place, "UPDATE player_instance SET last_us = last_us - 1" + last) == name);
  CHECK(damage(place, "UPDATE player_instance SET checksum = 0" + last) == name);
  CHECK(damage(place, "UPDATE player_instance SET author = 5" + last) ==
        "player_instance author=5 instance=" + std::to_string(0xf000000000000001ULL));
  CHECK(damage(place, "DELETE FROM player_instance" + last) == name);  // the log has it
}

TEST_CASE("a damaged mark is not overwritten by the next edit of its client", "[store][damage]") {
  TempPlace place;
  make_world(place.path());
  REQUIRE(raw_sql(place / "world.sqlite", "UPDATE player_instance SET decided = 1").empty());
  SplitMix64 rng(78);
  auto store = *open_world(place.path(), StoreAccess::read_write);
  const auto appended = store->append({}, sample_records(rng, 1, 21, 5));
  REQUIRE_FALSE(appended.has_value());
  CHECK(appended.error().kind == StoreError::Kind::corrupt);
  CHECK(*store->last_sequence() == 20);
}

TEST_CASE("a changed, missing or retyped row of meta is named and the world does not open",
          "[store][damage][sqlite]") {
  TempPlace pristine;
  make_world(pristine.path());
  for (const char* key :
       {"world_id", "chunk_edge", "generator", "generator_version", "seed", "generator_parameters",
        "materials", "server_key_seed", "spawn", "epoch", "checkpoint", "log_head", "base_fold",
        "snapshot_fold", "author_max", "log_last", "player_fold", "player_instance_fold"}) {
    CAPTURE(key);
    const std::string where = std::string(" WHERE key = '") + key + "'";
    const std::string place = std::string("meta key=") + key;
    CHECK(damage(pristine, "UPDATE meta SET checksum = checksum + 1" + where) == place);
    CHECK(damage(pristine,
                 "UPDATE meta SET value = CASE typeof(value) WHEN 'integer' THEN value + 16 WHEN "
                 "'text' THEN value || ' ' ELSE CAST(value || x'00' AS BLOB) END" +
                     where) == place);
    CHECK(
        damage(
            pristine,
            "UPDATE meta SET value = CASE typeof(value) WHEN 'text' THEN CAST(value AS BLOB) ELSE "
            "CAST(value AS TEXT) END" +
                where) == place);
    CHECK(damage(pristine, "DELETE FROM meta" + where) == place);
  }
}

TEST_CASE("a page of the database overwritten from outside is noticed", "[store][damage][sqlite]") {
  TempPlace place;
  make_world(place.path());
  const std::string file = place / "world.sqlite";
  const auto size = std::filesystem::file_size(file);
  const std::size_t page_bytes = std::stoul(raw_sql(file, "PRAGMA page_size"));
  CHECK(page_bytes == 2'048);  // SQLite ignores a wish for another size without a word
  int noticed = 0, pages = 0;
  for (std::uintmax_t page = page_bytes; page < size; page += page_bytes) {
    TempPlace copy;
    std::filesystem::copy_file(file, copy / "world.sqlite");
    {
      std::FILE* out = std::fopen((copy / "world.sqlite").c_str(), "r+b");
      REQUIRE(out != nullptr);
      REQUIRE(std::fseek(out, static_cast<long>(page), SEEK_SET) == 0);
      const std::vector<char> garbage(page_bytes, '\x5a');
      REQUIRE(std::fwrite(garbage.data(), 1, garbage.size(), out) == garbage.size());
      std::fclose(out);
    }
    ++pages;
    noticed += audit(copy.path()) != "fine" ? 1 : 0;
  }
  CHECK(pages > 6);
  CHECK(noticed == pages);
}
