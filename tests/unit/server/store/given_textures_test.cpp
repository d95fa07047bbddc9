// Textures of a world on disk: read, compacted, copied, and the format.
#include <catch2/catch.hpp>

#include "server/store/copy_stored_world.hpp"
#include "server/store/sqlite_backend.hpp"
#include "server/store/world_schema.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/sql/temp_place.hpp"
#include "tests/support/store/sample_world.hpp"
#include "tests/support/textures/test_png.hpp"

namespace runstone::test {
namespace {

EditRecord record_of_texture(Sequence seq, GivenTexture given) {
  EditRecord record;
  record.version = {1, seq};
  record.op = {0, 5, seq};
  record.time_us = 1'700'000'000'000'000 + static_cast<TimeUs>(seq) * 1000;
  record.cause = Cause::textures;
  record.edit = texture_edit(std::move(given));
  return record;
}

const GivenTexture kFirst{plain_png(16, 16, {1, 2, 3, 255}), {{1, 63}}};
const GivenTexture kSecond{plain_png(32, 32, {4, 5, 6, 255}), {{2, 1}, {3, 62}}};

/// Makes a world whose edits 5 and 20 of 30 give textures, with a keyframe at 10.
void make_textured_world(const std::string& place) {
  auto store = *create_world(place, sample_meta());
  REQUIRE(store->raise_epoch().has_value());
  SplitMix64 rng(7);
  auto records = sample_records(rng, 1, 1, 30);
  records[4] = record_of_texture(5, kFirst);
  records[19] = record_of_texture(20, kSecond);
  REQUIRE(store->append({}, records).has_value());
  REQUIRE(store->save_keyframe({}, Keyframe{{records[9].version, records[9].time_us}, 0, {}})
              .has_value());
}

std::vector<GivenTexture> textures_in(LogReader& reader) {
  std::vector<GivenTexture> out;
  const auto read = reader.read_textures([&](const EditRecord& record) {
    out.push_back(*given_texture_of(record.edit));
    return true;
  });
  REQUIRE(read.has_value());
  return out;
}

const std::vector<GivenTexture> kTextures = {kFirst, kSecond};

}  // namespace

TEST_CASE("textures are read, and kept when the log is compacted", "[store][textures]") {
  TempPlace place;
  make_textured_world(place / "w");
  {
    auto store = *open_world(place / "w", StoreAccess::read_write);
    CHECK(textures_in(*store) == kTextures);
    std::size_t rights = 0;
    REQUIRE(store->read_rights([&](const EditRecord&) { return ++rights > 0; }).has_value());
    CHECK(rights == 0);
    REQUIRE(store->compact(10).has_value());
    CHECK(textures_in(*store) == kTextures);
    CHECK(store->check().has_value());
  }
  const auto store = *open_world(place / "w", StoreAccess::read_only);
  CHECK(store->log_range()->first == 11);
  CHECK(textures_in(*store) == kTextures);
  std::size_t rights = 0;
  REQUIRE(store->read_rights([&](const EditRecord&) { return ++rights > 0; }).has_value());
  CHECK(rights == 0);
}

TEST_CASE("a world is of format 9 from its first texture on, and so is a copy",
          "[store][textures]") {
  TempPlace place;
  make_textured_world(place / "w");
  CHECK(stored_format(place / "w") == std::to_string(kWorldFormatOfTextures));
  REQUIRE(copy_stored_world(place / "w", place / "copy").has_value());
  {
    auto store = *open_world(place / "copy", StoreAccess::read_write);
    CHECK(textures_in(*store) == kTextures);
    CHECK(store->check().has_value());
  }
  CHECK(stored_format(place / "copy") == std::to_string(kWorldFormatOfTextures));
}

}  // namespace runstone::test
