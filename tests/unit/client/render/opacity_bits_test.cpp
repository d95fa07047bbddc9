#include "client/render/opacity_bits.hpp"

#include <catch2/catch.hpp>

#include "common/core/hash.hpp"

using namespace runstone;

namespace {

MaterialTable stone_and_glass() {
  MaterialTable table;
  REQUIRE(table.add({"stone", {90, 90, 90, 255}, Visibility::opaque, {}}).has_value());
  REQUIRE(table.add({"glass", {40, 80, 255, 128}, Visibility::transparent, {}}).has_value());
  return table;
}

bool bit(const OpacityBits& bits, VoxelIndex i) {
  return bits.words.empty() ? bits.all : (bits.words[i / 32] >> (i % 32) & 1) != 0;
}

}  // namespace

TEST_CASE("a bit is set exactly where the material is opaque", "[render]") {
  const OpaqueMaterials opaque = opaque_materials(stone_and_glass());
  RunChunk chunk = uniform_chunk(Extent::cube(16), kEmpty, AxisOrder::zxy);
  SplitMix64 rng(7);
  for (int step = 0; step < 200; ++step) {
    const VoxelIndex first = rng.below(chunk.volume());
    const std::uint32_t count = 1 + rng.below(std::min(chunk.volume() - first, 90U));
    fill(chunk, first, count, static_cast<Material>(rng.below(4)));  // 3 is not in the table
    const OpacityBits bits = opacity_bits(chunk, opaque);
    CHECK(bits.order == AxisOrder::zxy);
    bool is_equal = true;
    for (VoxelIndex i = 0; i < chunk.volume(); ++i) {
      const Material material = chunk.runs.material(find_run(chunk, i));
      is_equal = is_equal && bit(bits, i) == (material == 1 || material == 3);
    }
    REQUIRE(is_equal);
  }
}

TEST_CASE("a chunk whose bits are equal has no words", "[render]") {
  const OpaqueMaterials opaque = opaque_materials(stone_and_glass());
  const auto of = [&](Material material) {
    return opacity_bits(uniform_chunk(Extent::cube(16), material), opaque);
  };
  CHECK(of(kEmpty).words.empty());
  CHECK_FALSE(of(kEmpty).all);
  CHECK(of(1).words.empty());
  CHECK(of(1).all);
  CHECK_FALSE(of(2).all);
}
