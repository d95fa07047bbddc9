// The bytes of world format 5: columns, row checksums and marks. A change here means a new
// kWorldFormat.
#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <string>

#include "common/core/hex.hpp"
#include "common/tiles/tile_rules.hpp"
#include "server/store/sqlite_backend.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/store/compact_by_hand.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

ChunkPtr golden_chunk(Material material, Version version) {
  Chunk chunk;
  chunk.voxels = uniform_chunk(Extent::cube(kSampleEdge), material, AxisOrder::xzy);
  chunk.version = version;
  chunk.digest = digest_of(chunk.voxels);
  return std::make_shared<const Chunk>(std::move(chunk));
}

/// Makes a world with at least one row in every table. Every value is fixed.
std::string make_world(const TempFolder& folder) {
  auto store = *create_world(folder.path(), sample_meta());
  const std::vector<std::pair<ChunkKey, ChunkPtr>> base = {{{0, {-1, 2, 3}}, golden_chunk(1, {})}};
  REQUIRE(store->save_base(base).has_value());
  REQUIRE(store->raise_epoch().has_value());
  const PlayerRow player = sample_player(1);
  const EditDescriptor edit{FillBox{{{-4, 5, 6}, {7, 8, 9}}}, {MaskKind::only_material, 2}, 3};
  const std::vector<EditRecord> records = {
      {{1, 1}, {1, 0x8000000000000002ULL, 3}, 1'700'000'000'000'000, Cause::player, edit},
      {{1, 2}, {1, 0x8000000000000002ULL, 4}, 1'700'000'000'000'001, Cause::undo, edit, 1}};
  REQUIRE(store->append({&player, 1}, records).has_value());
  const NameChange claim{{"builder 1", "Builder 1", player.key}};
  REQUIRE(store->change_names({&claim, 1}).has_value());
  const std::vector<std::pair<ChunkKey, ChunkPtr>> snapshots = {
      {{0, {0, 0, -7}}, golden_chunk(2, {1, 1})}};
  REQUIRE(store->save_snapshots(snapshots, 1).has_value());
  const std::vector<std::pair<ChunkKey, ChunkPtr>> kept = {
      {{0, {-1, 2, -3}}, golden_chunk(3, {1, 2})}};
  const Keyframe keyframe{{{1, 2}, 1'700'000'000'000'001},
                          1,
                          world_digest_term(kept.front().first, kept.front().second->digest)};
  REQUIRE(store->save_keyframe(kept, keyframe).has_value());
  const std::vector<std::pair<ChunkKey, ChunkPtr>> tiles = {
      {{3, {0, -1, -1}}, golden_chunk(4, {1, 2})}};
  REQUIRE(store->save_tiles(tiles, kTileRules).has_value());
  return store->file();
}

std::string columns(const std::string& file, const std::string& table) {
  return raw_sql(file,
                 "SELECT group_concat(name || ' ' || type || pk, ', ') FROM pragma_table_info('" +
                     table + "')");
}

}  // namespace

TEST_CASE("the marks of a world are where format 5 has them", "[store][golden]") {
  const TempFolder folder;
  const std::string file = make_world(folder);
  CHECK(raw_sql(file, "PRAGMA application_id") == "1383427667");
  CHECK(raw_sql(file, "PRAGMA user_version") == "5");
  CHECK(raw_sql(file, "PRAGMA journal_mode") == "wal");
}

TEST_CASE("the tables have the columns of format 5", "[store][golden]") {
  const TempFolder folder;
  const std::string file = make_world(folder);
  CHECK(columns(file, "meta") == "key TEXT1, value ANY0, checksum INTEGER0");
  CHECK(columns(file, "base") ==
        "lod INTEGER1, x INTEGER2, y INTEGER3, z INTEGER4, epoch INTEGER0, seq INTEGER0, "
        "digest0 INTEGER0, digest1 INTEGER0, checksum INTEGER0, data BLOB0");
  CHECK(columns(file, "edit_log") ==
        "log INTEGER1, seq INTEGER2, epoch INTEGER0, author INTEGER0, instance INTEGER0, "
        "client_seq INTEGER0, time_us INTEGER0, cause INTEGER0, subject INTEGER0, min_x INTEGER0, "
        "min_y INTEGER0, min_z INTEGER0, max_x INTEGER0, max_y INTEGER0, max_z INTEGER0, "
        "descriptor BLOB0, checksum INTEGER0");
  CHECK(columns(file, "snapshot") ==
        "lod INTEGER1, x INTEGER2, y INTEGER3, z INTEGER4, epoch INTEGER0, seq INTEGER0, "
        "digest0 INTEGER0, digest1 INTEGER0, checksum INTEGER0, data BLOB0");
  CHECK(columns(file, "tile") ==
        "lod INTEGER1, x INTEGER2, y INTEGER3, z INTEGER4, epoch INTEGER0, seq INTEGER0, "
        "digest0 INTEGER0, digest1 INTEGER0, checksum INTEGER0, data BLOB0");
  CHECK(columns(file, "keyframe") ==
        "seq INTEGER1, epoch INTEGER0, time_us INTEGER0, chunks INTEGER0, digest0 INTEGER0, "
        "digest1 INTEGER0, checksum INTEGER0");
  CHECK(columns(file, "keyframe_chunk") ==
        "lod INTEGER1, x INTEGER2, y INTEGER3, z INTEGER4, seq INTEGER5, epoch INTEGER0, "
        "digest0 INTEGER0, digest1 INTEGER0, checksum INTEGER0, data BLOB0");
  CHECK(columns(file, "player") == "author INTEGER1, key BLOB0, name TEXT0, checksum INTEGER0");
  CHECK(columns(file, "name_claim") == "folded TEXT1, name TEXT0, key BLOB0, checksum INTEGER0");
  CHECK(columns(file, "rights_record") == "seq INTEGER1, record BLOB0, checksum INTEGER0");
  CHECK(columns(file, "player_name") ==
        "author INTEGER1, number INTEGER2, name TEXT0, checksum INTEGER0");
  CHECK(
      columns(file, "player_instance") ==
      "author INTEGER1, instance INTEGER2, decided INTEGER0, last_us INTEGER0, checksum INTEGER0");
  CHECK(raw_sql(file,
                "SELECT group_concat(name, ' ') FROM (SELECT name FROM sqlite_master "
                "WHERE type = 'table' ORDER BY name)") ==
        "base edit_log keyframe keyframe_chunk log_box log_box_node log_box_parent log_box_rowid "
        "meta name_claim player player_instance player_name rights_record snapshot tile");
  CHECK(
      raw_sql(
          file,
          "SELECT group_concat(name || ' ' || sql, '; ') FROM (SELECT name, sql FROM sqlite_master "
          "WHERE type = 'index' AND sql IS NOT NULL ORDER BY name)") ==
      "edit_log_author CREATE INDEX edit_log_author ON edit_log(author, seq); "
      "edit_log_cause CREATE INDEX edit_log_cause ON edit_log(cause, seq) WHERE cause <> 0; "
      "keyframe_chunk_digest CREATE INDEX keyframe_chunk_digest ON keyframe_chunk(seq, lod, x, y, "
      "z, epoch, digest0, digest1)");
  CHECK(raw_sql(file,
                "SELECT first_seq || ' ' || last_seq || ' ' || author || ' ' || min_x || ' ' || "
                "min_y || ' ' || min_z || ' ' || max_x || ' ' || max_y || ' ' || max_z "
                "FROM log_box") == "1 2 1 -4 5 6 7 8 9");
  CHECK(
      raw_sql(file, "SELECT group_concat(key, ' ') FROM (SELECT key FROM meta ORDER BY key)") ==
      "author_max base_fold checkpoint chunk_edge epoch generator generator_parameters "
      "generator_version log_head log_last materials name_claim_fold open_epoch player_fold "
      "player_instance_fold rights_record_fold row_counts seed server_key_seed snapshot_fold spawn tile_rules world_id");
}

TEST_CASE("rows have the bytes and checksums of format 5", "[store][golden]") {
  const TempFolder folder;
  const std::string file = make_world(folder);
  const auto value = [&](const std::string& column, const std::string& from) {
    return raw_sql(file, "SELECT " + column + " FROM " + from);
  };
  const std::string undo = "edit_log WHERE seq = 2";
  CHECK(value("checksum", undo) == "-9055125786412931878");
  CHECK(value("hex(descriptor)", undo) == "02030203070A0C0A0202");
  CHECK(
      value(
          "seq || ' ' || epoch || ' ' || author || ' ' || instance || ' ' || client_seq || ' ' || "
          "time_us || ' ' || cause || ' ' || subject || ' ' || min_x || ' ' || min_y || ' ' || "
          "min_z || ' ' || max_x || ' ' || max_y || ' ' || max_z",
          undo) == "2 1 1 -9223372036854775806 4 1700000000000001 3 1 -4 5 6 7 8 9");
  CHECK(value("hex(data)", "base") == "02010110101001010100");
  CHECK(value("digest0 || ' ' || digest1", "base") == "31824059738278227 938747246342400335");
  CHECK(value("checksum", "base") == "3696686867783136701");
  CHECK(value("hex(data)", "snapshot") == "02010110101001010200");
  CHECK(value("checksum", "snapshot") == "9083433871044378110");
  CHECK(value("hex(data)", "tile") == "02010110101001010400");
  CHECK(value("lod || ' ' || x || ' ' || y || ' ' || z || ' ' || epoch || ' ' || seq", "tile") ==
        "3 0 -1 -1 1 2");
  CHECK(value("checksum", "tile") == "-2266305544635191156");
  CHECK(value("hex(data)", "keyframe_chunk") == "02010110101001010300");
  CHECK(value("seq || ' ' || epoch || ' ' || digest0 || ' ' || digest1", "keyframe_chunk") ==
        "2 1 86466051881807956 2019403095640583695");
  CHECK(value("checksum", "keyframe_chunk") == "-2224641355094749811");
  CHECK(value("seq || ' ' || epoch || ' ' || time_us || ' ' || chunks || ' ' || digest0 || ' ' || "
              "digest1",
              "keyframe") == "2 1 1700000000000001 1 1657188782348826176 737397801681045469");
  CHECK(value("checksum", "keyframe") == "-6012113385911227469");
  CHECK(value("checksum", "player") == "-8523557106004048105");
  CHECK(value("author || ' ' || number || ' ' || name", "player_name") == "1 1 builder 1");
  CHECK(value("checksum", "player_name") == "8744597731677023775");
  CHECK(value("folded || ', ' || name", "name_claim") == "builder 1, Builder 1");
  CHECK(value("checksum", "name_claim") == "-5687735127959943699");
  CHECK(value("epoch || ' ' || seq", "base") == "0 0");
  CHECK(value("epoch || ' ' || seq", "snapshot") == "1 1");
  CHECK(value("decided || ' ' || last_us", "player_instance") == "4 1700000000000001");
  CHECK(value("checksum", "player_instance") == "4364206919407918968");
  CHECK(value("checksum", "meta WHERE key = 'seed'") == "1688236515335772665");
  CHECK(value("checksum", "meta WHERE key = 'world_id'") == "308304262276956158");
  CHECK(value("checksum", "meta WHERE key = 'generator'") == "-5376564082402544169");
  CHECK(value("hex(value)", "meta WHERE key = 'spawn'") ==
        "000000000000E03F000000000090514000000000000008C0");
  CHECK(value("hex(value)", "meta WHERE key = 'log_head'") ==
        "0000000000000000000000000000000000000000");
  CHECK(value("hex(value)", "meta WHERE key = 'base_fold'") == "0100000000000000BED44F992268158D");
  CHECK(value("hex(value)", "meta WHERE key = 'snapshot_fold'") ==
        "0100000000000000D2455B47B79BD394");
  CHECK(value("value", "meta WHERE key = 'author_max'") == "1");
  CHECK(value("value", "meta WHERE key = 'log_last'") == "2");
  // The sum over one row is the checksum of this row.
  CHECK(value("hex(value)", "meta WHERE key = 'player_fold'") ==
        "01000000000000001747DFC9F83DB689");
  CHECK(value("hex(value)", "meta WHERE key = 'player_instance_fold'") ==
        "0100000000000000785F9C1512C7903C");
  CHECK(value("hex(value)", "meta WHERE key = 'name_claim_fold'") ==
        "0100000000000000EDC56F39091B11B1");
}

TEST_CASE("the mark of the durable log has the bytes of format 1", "[store][golden]") {
  const TempFolder folder;
  make_world(folder);
  std::ifstream in(folder / "world.durable", std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const Bytes bytes(text.begin(), text.end());
  REQUIRE(bytes.size() == 4096 + 40);
  const ByteView all(bytes);
  // world id, u64 sequence, u32 epoch, u32 highest author number, checksum
  CHECK(to_hex(all.first(40)) ==
        "0102030405060708090a0b0c0d0e0f10"
        "0200000000000000"
        "01000000"
        "01000000"
        "de63444f483b92df");
  CHECK(to_hex(all.subspan(4096, 40)) ==
        "0102030405060708090a0b0c0d0e0f10"
        "0000000000000000"
        "01000000"
        "00000000"
        "b0b8d79b2f382501");
}

TEST_CASE("the head of a compacted log has the bytes of format 1", "[store][golden]") {
  const TempFolder folder;
  const std::string file = make_world(folder);
  compact_by_hand(file, {{1, 2}, 1'700'000'000'000'001}, {});
  // u32 epoch, u64 sequence, u64 time
  CHECK(raw_sql(file, "SELECT hex(value) FROM meta WHERE key = 'log_head'") ==
        "01000000020000000000000001401E18240A0600");
}
