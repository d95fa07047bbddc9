// The table of textures: what fits, and what never changes.
#include "common/textures/texture_table.hpp"

#include <catch2/catch.hpp>

#include "common/textures/texture_hash.hpp"

namespace runstone::test {
namespace {

TextureHash numbered_hash(std::size_t i) {
  return {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i >> 8)};
}

}  // namespace

TEST_CASE("a side shows the picture that it got first", "[textures]") {
  TextureTable table;
  CHECK(table.empty());
  CHECK(table.number(7, Direction::pos_y) == 0);
  const TextureEntry bark{numbered_hash(1), 100, {{7, 0b110011}, {9, kAllTextureSides}}};
  const TextureEntry top{numbered_hash(2), 50, {{7, texture_side(Direction::pos_y)}}};
  REQUIRE(table.add(bark).has_value());
  REQUIRE(table.add(top).has_value());
  CHECK(table.number(7, Direction::neg_x) == 1);
  CHECK(table.number(7, Direction::pos_y) == 2);
  CHECK(table.number(7, Direction::neg_y) == 0);
  CHECK(table.number(9, Direction::neg_y) == 1);
  CHECK(table.number(8, Direction::neg_y) == 0);
  CHECK(table.number(65535, Direction::neg_y) == 0);
  CHECK(table.bytes() == 150);

  const auto again = table.add(TextureEntry{numbered_hash(3), 50, {{8, 1}, {9, 1}}});
  REQUIRE_FALSE(again.has_value());
  CHECK(again.error().code == ErrorCode::not_permitted);
  CHECK(again.error().offset == 9);
  CHECK(table.number(8, Direction::neg_x) == 0);
  CHECK(table.entries().size() == 2);
  CHECK(*table.find(numbered_hash(2)) == 1);
  CHECK_FALSE(table.find(numbered_hash(3)).has_value());
}

TEST_CASE("a picture that is known gets further uses", "[textures]") {
  TextureTable table;
  const std::vector<TextureEntry> given = {{numbered_hash(1), 100, {{9, 1}}},
                                           {numbered_hash(2), 100, {{9, 2}}},
                                           {numbered_hash(1), 100, {{3, 63}}}};
  REQUIRE(table.add(given).has_value());
  REQUIRE(table.entries().size() == 2);
  CHECK(table.entries()[0].uses == std::vector<TextureUse>{{9, 1}, {3, 63}});
  CHECK(table.number(3, Direction::pos_z) == 1);
  CHECK(table.bytes() == 200);
  CHECK_FALSE(table.add(TextureEntry{numbered_hash(1), 101, {{4, 1}}}).has_value());
}

TEST_CASE("a server that adds pictures for ever is stopped at 4,096 of them, and at 16 MiB",
          "[textures]") {
  TextureTable table;
  for (std::size_t i = 0; i < kTextureCountMax; ++i)
    REQUIRE(table.add(TextureEntry{numbered_hash(i), 100, {{static_cast<Material>(i + 1), 1}}})
                .has_value());
  const TextureEntry more{numbered_hash(kTextureCountMax), 100, {{60000, 1}}};
  CHECK(table.add(more).error().code == ErrorCode::limit_exceeded);
  CHECK(table.add(TextureEntry{numbered_hash(0), 100, {{60000, 1}}}).has_value());

  TextureTable large;
  std::size_t count = 0;
  while (large.add(TextureEntry{
      numbered_hash(count), kTextureBytesMax, {{static_cast<Material>(count + 1), 1}}}))
    ++count;
  CHECK(count == kTexturesBytesMax / kTextureBytesMax);
  CHECK_FALSE(large.add(TextureEntry{numbered_hash(9000), 0, {{60000, 1}}}).has_value());
}

TEST_CASE("the hash of a picture is BLAKE2b of its bytes", "[textures]") {
  // The hash of no bytes, as RFC 7693 defines it for 32 bytes.
  const TextureHash none = texture_hash({});
  CHECK(none[0] == 0x0e);
  CHECK(none[1] == 0x57);
  CHECK(none[31] == 0xa8);
  const Bytes bytes = {1, 2, 3};
  const TextureEntry entry = texture_entry(bytes, {{1, 1}});
  CHECK(entry.hash == texture_hash(bytes));
  CHECK(entry.bytes == 3);
}

}  // namespace runstone::test
