#include "common/formats/minecraft_level.hpp"

#include <catch2/catch.hpp>

#include "tests/support/formats/schematic_bytes.hpp"

namespace runstone::test {
namespace {

NbtBytes old_level() {
  NbtBytes out;
  out.open("").open("Data").text("LevelName", "x").i32("SpawnX", -7).i32("SpawnY", 64);
  out.list("things", 10, 1).i32("SpawnX", 9).close().i32("SpawnZ", 300).close().close();
  return out;
}

NbtBytes new_level(const std::vector<std::int32_t>& pos, std::string_view dimension) {
  NbtBytes out;
  out.open("").open("Data").open("spawn").ints("pos", pos).text("dimension", dimension);
  out.close().close().close();
  return out;
}

std::optional<VoxelPos> spawn_in(const Bytes& file) {
  const auto spawn = read_minecraft_spawn(file);
  REQUIRE(spawn.has_value());
  return *spawn;
}

}  // namespace

TEST_CASE("level.dat says where players arrive, in the form of either age", "[formats]") {
  CHECK(spawn_in(gzip_of(old_level().get())) == VoxelPos{-7, 64, 300});
  CHECK(spawn_in(old_level().get()) == VoxelPos{-7, 64, 300});
  CHECK(spawn_in(gzip_of(new_level({1, -2, 3}, "minecraft:overworld").get())) ==
        VoxelPos{1, -2, 3});
  CHECK_FALSE(spawn_in(new_level({1, 2, 3}, "minecraft:the_nether").get()).has_value());
  CHECK_FALSE(spawn_in(new_level({1, 2}, "minecraft:overworld").get()).has_value());
  CHECK_FALSE(spawn_in(new_level({2'000'000'000, 2, 3}, "minecraft:overworld").get()).has_value());
  NbtBytes none;
  none.open("").open("Data").i32("SpawnX", 3).close().close();
  CHECK_FALSE(spawn_in(none.get()).has_value());
}

TEST_CASE("a level.dat that is cut or damaged is refused", "[formats]") {
  const Bytes plain = old_level().get(), packed = gzip_of(plain);
  const auto accepted = [](const Bytes& whole) {
    std::size_t count = 0;
    for (std::size_t length = 0; length < whole.size(); ++length) {
      if (read_minecraft_spawn(ByteView(whole).first(length))) ++count;
    }
    return count;
  };
  CHECK(accepted(plain) == 0);
  // The end of a gzip stream is its checksum, which is not read if the values are complete.
  CHECK(accepted(packed) <= 8);
  CHECK_FALSE(read_minecraft_spawn(Bytes(500, 0x5a)).has_value());
}

}  // namespace runstone::test
