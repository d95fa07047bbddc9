// Shapes of the materials of a world on disk: from record to record, compacted, copied, and the
// format.
#include <array>
#include <catch2/catch.hpp>
#include <fstream>

#include "common/sqlite/sqlite_file.hpp"
#include "common/tiles/tile_rules.hpp"
#include "server/store/copy_stored_world.hpp"
#include "server/store/meta_table.hpp"
#include "server/store/sqlite_backend.hpp"
#include "server/store/world_folder.hpp"
#include "server/store/world_schema.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/sql/temp_place.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {
namespace {

const Shape kSlab{ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}}};
const Shape kPlant{ShapeForm::crossed, {{{1, 0, 1}, {15, 12, 15}}}};

EditRecord record_of_shapes(Sequence seq, const std::vector<GivenShape>& rows) {
  EditRecord record;
  record.version = {1, seq};
  record.op = {0, 5, seq};
  record.time_us = 1'700'000'000'000'000 + static_cast<TimeUs>(seq) * 1000;
  record.cause = Cause::materials;
  record.edit = shapes_edit({rows});
  return record;
}

/// Makes a world whose edits 5 and 20 of 30 give shapes, with a keyframe at 10.
void make_shaped_world(const std::string& place) {
  auto store = *create_world(place, sample_meta());
  REQUIRE(store->raise_epoch().has_value());
  SplitMix64 rng(7);
  auto records = sample_records(rng, 1, 1, 30);
  records[4] = record_of_shapes(5, {{1, kSlab}});
  records[19] = record_of_shapes(20, {{2, kPlant}});
  REQUIRE(store->append({}, records).has_value());
  REQUIRE(store->save_keyframe({}, Keyframe{{records[9].version, records[9].time_us}, 0, {}})
              .has_value());
}

}  // namespace

TEST_CASE("materials have the shapes of the log, from sequence to sequence",
          "[store][materials][shapes]") {
  TempPlace place;
  make_shaped_world(place / "w");
  const auto store = *open_world(place / "w", StoreAccess::read_only);
  CHECK((*store->materials(4))[1].shape.is_cube());
  CHECK((*store->materials(5))[1].shape == kSlab);
  CHECK((*store->materials(19))[2].shape.is_cube());
  CHECK((*store->materials())[2].shape == kPlant);
  CHECK(store->meta().materials[1].shape.is_cube());
  CHECK(store->check().has_value());
}

TEST_CASE("shapes are kept when the log is compacted", "[store][materials][shapes]") {
  TempPlace place;
  make_shaped_world(place / "w");
  MaterialTable all;
  {
    auto store = *open_world(place / "w", StoreAccess::read_write);
    all = *store->materials();
    REQUIRE(store->compact(10).has_value());
    CHECK(*store->materials() == all);
    CHECK(store->meta().materials[1].shape == kSlab);
    CHECK(store->meta().materials[2].shape.is_cube());
    CHECK(store->check().has_value());
  }
  const auto store = *open_world(place / "w", StoreAccess::read_only);
  CHECK(*store->materials() == all);
}

TEST_CASE("records of shapes that do not fit the table are refused", "[store][materials][shapes]") {
  TempPlace place;
  const auto store = *create_world(place / "w", sample_meta());
  REQUIRE(store->raise_epoch().has_value());
  const auto beyond = static_cast<Material>(store->meta().materials.size());
  const auto refused = [&](const std::vector<EditRecord>& records) {
    const auto written = store->append({}, records);
    REQUIRE_FALSE(written.has_value());
    CHECK(written.error().kind == StoreError::Kind::bad_request);
    CHECK(*store->last_sequence() == 0);
  };
  refused({record_of_shapes(1, {{beyond, kSlab}})});
  refused({record_of_shapes(1, {{1, kSlab}}), record_of_shapes(2, {{1, kPlant}})});
  CHECK(store->append({}, std::vector{record_of_shapes(1, {{1, kSlab}})}).has_value());
}

TEST_CASE("shapes end the stored tiles unless their materials are new",
          "[store][materials][shapes]") {
  TempPlace place;
  const auto tiles = [] {
    SplitMix64 rng(3);
    std::vector<std::pair<ChunkKey, ChunkPtr>> out;
    Chunk tile{
        random_chunk(rng, Extent::cube(kSampleEdge), AxisOrder::zxy, 4, ChunkShape::boxes), {}, {}};
    tile.digest = digest_of(tile.voxels);
    out.emplace_back(ChunkKey{1, {0, 0, 0}}, std::make_shared<const Chunk>(std::move(tile)));
    return out;
  }();
  const ChunkKey key = tiles[0].first;
  auto store = *create_world(place / "w", sample_meta());
  REQUIRE(store->raise_epoch().has_value());
  REQUIRE(store->save_tiles(tiles, kTileRules).has_value());
  const auto rules = [&] { return tile_rules_of(tile_shapes_number(*store->materials())); };
  const auto next = static_cast<Material>(store->meta().materials.size());

  EditRecord added = record_of_shapes(1, {});
  added.edit = materials_edit({next, {{"ramp", {9, 9, 9, 255}}}});
  REQUIRE(store->append({}, std::vector{added, record_of_shapes(2, {{next, kSlab}})}).has_value());
  const std::uint32_t with_ramp = rules();
  CHECK(with_ramp != kTileRules);
  CHECK_FALSE(store->load_tile(key, kTileRules)->has_value());
  CHECK(store->load_tile(key, with_ramp)->has_value());
  CHECK(store->tile_keys(with_ramp)->size() == 1);

  const auto reader = *open_world(place / "w", StoreAccess::read_only);
  CHECK(reader->load_tile(key, with_ramp)->has_value());
  REQUIRE(store->append({}, std::vector{record_of_shapes(3, {{1, kPlant}})}).has_value());
  const std::uint32_t with_plant = rules();
  CHECK(with_plant != with_ramp);
  for (const std::uint32_t number : {kTileRules, with_ramp, with_plant}) {
    CAPTURE(number);
    CHECK_FALSE(store->load_tile(key, number)->has_value());
    CHECK_FALSE(reader->load_tile(key, number)->has_value());  // it was opened before
  }
  // Tiles that were made before the record are not saved behind it.
  REQUIRE(store->save_tiles(tiles, with_ramp).has_value());
  CHECK(store->tile_keys(with_plant)->empty());
  REQUIRE(store->save_tiles(tiles, with_plant).has_value());
  CHECK(reader->load_tile(key, with_plant)->has_value());

  // The tiles are kept over a restart.
  store.reset();
  store = *open_world(place / "w", StoreAccess::read_write);
  CHECK(rules() == with_plant);
  CHECK(store->load_tile(key, with_plant)->has_value());
}

TEST_CASE("a start deletes tiles of rules that are not those of the materials",
          "[store][materials][shapes][sqlite]") {
  TempPlace place;
  if (place.is_postgres()) return;
  make_shaped_world(place / "w");
  const std::string file = place / "w" + "/world.sqlite";
  const auto rules = [&] {
    return raw_sql(file, "SELECT value FROM meta WHERE key = 'tile_rules'");
  };
  const std::string present = rules();
  CHECK(present != std::to_string(kTileRules));
  for (const std::int64_t other : {std::int64_t{0}, std::int64_t{kTileRules}}) {
    {
      auto database = *sql::open_sqlite(file, sql::SqliteMode::write);
      auto meta = *MetaTable::open(database);
      REQUIRE(meta.put("tile_rules", other).has_value());
    }
    CHECK(rules() == std::to_string(other));
    static_cast<void>(*open_world(place / "w", StoreAccess::read_only));
    CHECK(rules() == std::to_string(other));
    static_cast<void>(*open_world(place / "w", StoreAccess::read_write));
    CHECK(rules() == present);
  }
}

TEST_CASE("a world is of format 8 from its first shape on, and so is a copy",
          "[store][materials][shapes]") {
  TempPlace place;
  const std::string shaped = place / "shaped", plain = place / "plain", copy = place / "copy";
  make_shaped_world(shaped);
  CHECK(stored_format(shaped) == std::to_string(kWorldFormatOfShapes));
  {
    auto store = *create_world(plain, sample_meta());
    REQUIRE(store->raise_epoch().has_value());
  }
  CHECK(stored_format(plain) == std::to_string(kWorldFormat));
  REQUIRE(copy_stored_world(shaped, copy).has_value());
  {
    auto store = *open_world(copy, StoreAccess::read_write);
    CHECK((*store->materials())[1].shape == kSlab);
    CHECK(store->library_rows()->empty());
    CHECK(store->check().has_value());
  }
  CHECK(stored_format(copy) == std::to_string(kWorldFormatOfShapes));
}

TEST_CASE("a world is of format 8 from its first pattern of plants on",
          "[store][materials][shapes]") {
  TempPlace place;
  const auto format_with = [&](const std::string& name, MaterialPattern pattern) {
    auto store = *create_world(place / name, sample_meta());
    REQUIRE(store->raise_epoch().has_value());
    const auto next = static_cast<Material>(store->meta().materials.size());
    MaterialRow row{"plant", {9, 9, 9, 255}};
    row.look = MaterialLook{1, 2, 3, 4, pattern};
    EditRecord added = record_of_shapes(1, {});
    added.edit = materials_edit({next, {row}});
    REQUIRE(store->append({}, std::vector{added}).has_value());
    CHECK((*store->materials())[next].look == row.look);
    store.reset();
    return stored_format(place / name);
  };
  CHECK(format_with("plain", MaterialPattern::weave) == std::to_string(kWorldFormat));
  CHECK(format_with("blades", MaterialPattern::blades) == std::to_string(kWorldFormatOfShapes));
  CHECK(format_with("foliage", MaterialPattern::foliage) == std::to_string(kWorldFormatOfShapes));

  WorldMeta meta = sample_meta();
  MaterialInfo flower{"flower", {9, 9, 9, 255}, Visibility::opaque, std::nullopt};
  flower.look = MaterialLook{1, 2, 3, 4, MaterialPattern::flower};
  REQUIRE(meta.materials.add(flower).has_value());
  REQUIRE((*create_world(place / "created", meta))->raise_epoch().has_value());
  {
    const auto store = *open_world(place / "created", StoreAccess::read_write);
    CHECK(*store->materials() == meta.materials);
    CHECK(store->check().has_value());
  }
  CHECK(stored_format(place / "created") == std::to_string(kWorldFormatOfShapes));
}

TEST_CASE("a file of a new world gives patterns of plants to crossed planes alone",
          "[store][materials][shapes]") {
  const TempFolder folder;
  const std::string file = folder / "materials.toml";
  std::ofstream(file) << "[[material]]\nname = \"air\"\nvisibility = \"empty\"\n";
  const std::array<const char*, 3> shapes = {"shape = \"plant\"", "shape = \"slab\"", ""};
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    std::ofstream(file, std::ios::app)
        << "[[material]]\nname = \"m" << i
        << "\"\ncolour = \"#80ff20\"\nlook = { pattern = \"flower\" }\n"
        << shapes[i] << "\n";
  }
  const auto table = read_materials(file, "flat");
  INFO((table ? std::string() : table.error()));
  REQUIRE(table.has_value());
  REQUIRE(table->size() == 4);
  CHECK((*table)[1].look->pattern == MaterialPattern::flower);
  CHECK((*table)[2].look->pattern == MaterialPattern::none);
  CHECK((*table)[3].look->pattern == MaterialPattern::none);
}

TEST_CASE("a world that is created with shapes is of format 8", "[store][materials][shapes]") {
  TempPlace place;
  WorldMeta meta = sample_meta();
  REQUIRE(meta.materials.give_shapes(std::vector<GivenShape>{{1, kSlab}}).has_value());
  {
    auto store = *create_world(place / "w", meta);
    REQUIRE(store->raise_epoch().has_value());
    CHECK(*store->materials() == meta.materials);
  }
  {
    const auto store = *open_world(place / "w", StoreAccess::read_write);
    CHECK(*store->materials() == meta.materials);
    CHECK(store->check().has_value());
  }
  CHECK(stored_format(place / "w") == std::to_string(kWorldFormatOfShapes));
}

}  // namespace runstone::test
