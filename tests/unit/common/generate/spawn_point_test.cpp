#include "common/generate/spawn_point.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <functional>

using namespace runstone;

namespace {

constexpr Material kRock = 1, kSea = 2;

MaterialTable table() {
  MaterialTable table;
  REQUIRE(table.add({"rock", {1, 2, 3, 255}, Visibility::opaque, std::nullopt}).has_value());
  REQUIRE(table.add({"sea", {1, 2, 3, 99}, Visibility::transparent, std::nullopt}).has_value());
  return table;
}

/// Columns of one material up to y = 9, chosen by x and z.
class ColumnGenerator final : public Generator {
 public:
  explicit ColumnGenerator(std::function<Material(std::int32_t, std::int32_t)> top)
      : top_(std::move(top)) {}
  RunChunk generate(VoxelPos origin, Extent extent) const override {
    return uniform_chunk(extent, top_(origin.x, origin.z));
  }
  std::int32_t y_min() const override { return 0; }
  std::int32_t y_max() const override { return 10; }
  std::int32_t surface_y(std::int32_t, std::int32_t) const override { return 10; }

 private:
  std::function<Material(std::int32_t, std::int32_t)> top_;
};

}  // namespace

TEST_CASE("players enter at the origin unless the sea covers it", "[generate][spawn]") {
  CHECK(spawn_point(ColumnGenerator([](auto, auto) { return kRock; }), table()) ==
        VoxelPos{0, 12, 0});
  CHECK(spawn_point(ColumnGenerator([](auto, auto) { return kEmpty; }), table()) ==
        VoxelPos{0, 12, 0});
}

TEST_CASE("players enter on the nearest land that is wider than one column", "[generate][spawn]") {
  const auto islet_and_coast = [](std::int32_t x, std::int32_t z) {
    const bool is_islet = x == 16 && z == 0;
    return is_islet || z >= 100 ? kRock : kSea;
  };
  CHECK(spawn_point(ColumnGenerator(islet_and_coast), table()) == VoxelPos{0, 12, 112});
  const auto west = [](std::int32_t x, std::int32_t) { return x <= -40 ? kRock : kSea; };
  CHECK(spawn_point(ColumnGenerator(west), table()) == VoxelPos{-48, 12, 0});
}

TEST_CASE("players of a world without land enter over the sea", "[generate][spawn]") {
  const auto far_land = [](std::int32_t x, std::int32_t) {
    return std::abs(x) > 1024 ? kRock : kSea;
  };
  CHECK(spawn_point(ColumnGenerator(far_land), table()) == VoxelPos{0, 12, 0});
}

TEST_CASE("players enter the built-in terrain on land", "[generate][spawn]") {
  const MaterialTable& materials = default_material_table();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    const auto generator = make_generator({"terrain", 1, seed, ""}, materials);
    REQUIRE(generator.has_value());
    const VoxelPos at = spawn_point(**generator, materials);
    const VoxelPos ground{at.x, at.y - 3, at.z};
    const RunChunk top = (*generator)->generate(ground, Extent::cube(1));
    CHECK(materials[material_at(top, {0, 0, 0})].visibility == Visibility::opaque);
    CHECK((*generator)->generate(at, Extent::cube(1)).is_uniform());
    CHECK(material_at((*generator)->generate(at, Extent::cube(1)), {0, 0, 0}) == kEmpty);
  }
}
