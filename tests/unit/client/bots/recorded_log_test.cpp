// Recorded logs by author, and the materials that they need in the world that they are played in.
#include "client/bots/recorded_log.hpp"

#include <catch2/catch.hpp>

#include "protocol/limits.hpp"
#include "tests/support/rlog/rlog_bytes.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

EditRecord voxel(Sequence seq, AuthorId author, TimeUs time_us, Material material) {
  EditRecord record;
  record.version = {1, seq};
  record.op = {author, 9, seq};
  record.time_us = time_us;
  record.cause = author == 0 ? Cause::rollback : Cause::player;
  record.edit = {SetVoxel{{static_cast<std::int32_t>(seq), 0, 0}}, {}, material};
  return record;
}

RlogWorld world_of_defaults() {
  RlogWorld world;
  world.generator = {"empty", 1, 1, ""};
  world.materials = to_toml(default_material_table());
  return world;
}

Bytes three_authors() {
  const std::vector<RlogPlayer> players = {
      {1, {}, "ada"}, {2, {}, std::string(100, 'b')}, {3, {}, "idle"}};
  const std::vector<EditRecord> records = {voxel(1, 2, 5'000, 1), voxel(2, 1, 5'000, 2),
                                           voxel(3, 0, 6'500, 0), voxel(4, 2, 9'000, 4)};
  return rlog_of(world_of_defaults(), players, records, {0, 2});
}

}  // namespace

TEST_CASE("edits are sorted by author, each at its time since the first of all", "[bots][play]") {
  const Bytes file = three_authors();
  const auto log = read_recorded_log(source_of(file));
  REQUIRE(log.has_value());
  CHECK(log->edits == 4);
  REQUIRE(log->authors.size() == 3);  // authors without edits are left out
  CHECK(log->authors[0].name == "recorded world");
  CHECK(log->authors[1].name == "ada");
  CHECK(log->authors[2].name == std::string(kPlayerNameBytesMax, 'b'));
  CHECK(log->authors[0].edits.at(0).offset_us == 1'500);
  CHECK(log->authors[1].edits.at(0).offset_us == 0);
  REQUIRE(log->authors[2].edits.size() == 2);
  CHECK(log->authors[2].edits[1].offset_us == 4'000);
  CHECK(log->authors[2].edits[1].edit == voxel(4, 2, 9'000, 4).edit);
  CHECK(log->used == std::vector<Material>{0, 1, 2, 4});
}

TEST_CASE("changes of rights are not played", "[bots][play]") {
  EditRecord grant = voxel(2, 1, 5'000, 1);
  grant.cause = Cause::rights;
  grant.edit = rights_edit(GrantRole{{}, kModeratorRole});
  const std::vector<EditRecord> records = {voxel(1, 2, 5'000, 1), grant, voxel(3, 2, 6'000, 1)};
  const std::vector<RlogPlayer> players = {{1, {}, "ada"}, {2, {}, "bob"}};
  const Bytes file = rlog_of(world_of_defaults(), players, records, {0, 2});
  const auto log = read_recorded_log(source_of(file));
  REQUIRE(log.has_value());
  CHECK(log->edits == 2);
  REQUIRE(log->authors.size() == 1);
  CHECK(log->authors[0].name == "bob");
}

TEST_CASE("a file that is damaged or cut anywhere is rejected", "[bots][play]") {
  const Bytes file = three_authors();
  for (std::size_t bytes = 0; bytes < file.size(); ++bytes) {
    const Bytes cut(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(bytes));
    CHECK_FALSE(read_recorded_log(source_of(cut)).has_value());
  }
  Bytes damaged = file;
  damaged[blocks_of(file).at(3) + kRlogHeaderBytes] ^= 1;  // the second block of edits
  const auto log = read_recorded_log(source_of(damaged));
  REQUIRE_FALSE(log.has_value());
  CHECK(log.error().find("edit 3 at byte ") == 0);
}

TEST_CASE("names of recorded players become names of sessions", "[bots][play]") {
  CHECK(session_name("ada", 0) == "recorded world");
  CHECK(session_name("", 7) == "author 7");
  CHECK(session_name("a\nb", 7) == "author 7");
  CHECK(session_name("\xff", 7) == "author 7");
  CHECK(session_name(std::string(31, 'x') + "\xc3\xa9", 7) == std::string(31, 'x'));
}

TEST_CASE("the world must have the materials that the edits use, by id and name", "[bots][play]") {
  const Bytes file = three_authors();
  const auto log = read_recorded_log(source_of(file));
  REQUIRE(log.has_value());
  CHECK(check_materials(*log, default_material_table()).has_value());
  MaterialTable live;
  const auto add = [&live](const std::string& name) {
    MaterialInfo info;
    info.name = name;
    REQUIRE(live.add(info).has_value());
  };
  add(default_material_table()[1].name);
  add(default_material_table()[2].name);
  add("unlike");  // 3, which no edit uses
  const auto short_table = check_materials(*log, live);
  REQUIRE_FALSE(short_table.has_value());
  CHECK(short_table.error().find("material 4 ") == 0);
  add("other");
  const auto other = check_materials(*log, live);
  REQUIRE_FALSE(other.has_value());
  CHECK(other.error() == "material 4 is \"" + default_material_table()[4].name +
                             "\" in the file and \"other\" in the world");
}

TEST_CASE("materials that the recorded log adds are known from there on", "[bots][play]") {
  const auto first = static_cast<Material>(default_material_table().size());
  EditRecord added = voxel(2, 0, 5'000, 0);
  added.cause = Cause::materials;
  added.edit = materials_edit({first, {{"lime", {1, 2, 3, 255}, Visibility::opaque}}});
  const std::vector<RlogPlayer> players = {{2, {}, "bob"}};
  const auto read = [&](const std::vector<EditRecord>& records) {
    const Bytes file = rlog_of(world_of_defaults(), players, records, {0, 2});
    return read_recorded_log(source_of(file));
  };
  const auto log = read({voxel(1, 2, 5'000, 1), added, voxel(3, 2, 6'000, first)});
  REQUIRE(log.has_value());
  CHECK(log->edits == 2);
  CHECK(log->materials.find("lime") == first);
  CHECK(check_materials(*log, default_material_table()).error().find("\"lime\" in the file") !=
        std::string::npos);
  CHECK_FALSE(read({voxel(1, 2, 5'000, first)}).has_value());
  added.edit = materials_edit({1, {{"lime", {1, 2, 3, 255}, Visibility::opaque}}});
  CHECK(read({voxel(1, 2, 5'000, 1), added}).error() ==
        "edit 2: materials do not continue the table");
}
