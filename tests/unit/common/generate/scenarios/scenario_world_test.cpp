#include "common/generate/scenarios/scenario_world.hpp"

#include <catch2/catch.hpp>

#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/runs/random_chunk.hpp"
#include "tests/support/scenarios/scenario_oracle.hpp"

namespace runstone::test {
namespace {

constexpr Material kSolid = 7;

TEST_CASE("a scenario's world repeats its model three times along each axis, for any box",
          "[generate][scenarios]") {
  SplitMix64 rng(Catch::rngSeed());
  for (const unsigned number : {1u, 2u, 8u, 9u, 14u, 17u, 20u, 23u, 30u}) {
    for (const unsigned edge : {8u, 32u}) {
      const ScenarioWorld world(*scenario_model(number, edge), kSolid);
      const DenseChunk model = scenario_dense(number, edge);
      const int n = static_cast<int>(edge);
      for (int round = 0; round < 6; ++round) {
        const Extent extent = random_extent(rng, 40);
        const VoxelPos origin{rng.between(-n - 30, 2 * n + 10), rng.between(-n - 30, 2 * n + 10),
                              rng.between(-n - 30, 2 * n + 10)};
        const RunChunk chunk = world.generate(origin, extent);
        REQUIRE(validate(chunk).has_value());
        const DenseChunk dense = DenseChunk::of(chunk);
        int wrong = 0;
        for (int z = 0; z < extent.z; ++z) {
          for (int y = 0; y < extent.y; ++y) {
            for (int x = 0; x < extent.x; ++x) {
              const VoxelPos p{origin.x + x, origin.y + y, origin.z + z};
              const bool solid = world.bounds().contains(p) &&
                                 model.at((p.x + n) % n, (p.y + n) % n, (p.z + n) % n) != 0;
              wrong += dense.at(x, y, z) != (solid ? kSolid : kEmpty) ? 1 : 0;
            }
          }
        }
        CAPTURE(Catch::rngSeed(), number, edge, round);
        REQUIRE(wrong == 0);
      }
    }
  }
}

TEST_CASE("a player stands on the highest voxel of a scenario's world", "[generate][scenarios]") {
  const ScenarioWorld ball(*scenario_model(7, 32), kSolid);  // radius 8 around 16 16 16
  CHECK(ball.surface_y(16, 16) == 32 + 24);
  CHECK(ball.surface_y(-16, 48) == 32 + 24);
  CHECK(ball.surface_y(16, 9) ==
        32 + 20);  // 7 beside the middle: the last voxel with 3 * 3 + 7 * 7 < 64 above it
  CHECK(ball.surface_y(0, 0) == ball.y_min());
  CHECK(ball.surface_y(64, 16) == ball.y_min());
  const ScenarioWorld full(*scenario_model(1, 128), kSolid);
  CHECK(full.surface_y(0, 0) == full.y_max());
  CHECK(full.y_min() == -128);
  CHECK(full.y_max() == 256);
}

TEST_CASE("a pin makes a scenario's world or fails with the reason", "[generate][scenarios]") {
  const auto made = [](const char* parameters) {
    MaterialTable materials;
    for (const char* name : {"dirt", "stone"}) {
      MaterialInfo info;
      info.name = name;
      REQUIRE(materials.add(info).has_value());
    }
    return make_generator({"scenario", 1, 0, parameters}, materials);
  };
  const auto code = [&](const char* parameters) {
    const auto world = made(parameters);
    REQUIRE_FALSE(world.has_value());
    return world.error().code;
  };
  const auto world = made("number = 7\nedge = 16\n");
  REQUIRE(world.has_value());
  CHECK((*world)->generate({-16, 0, 16}, Extent::cube(16)) ==
        scenario_chunk(*scenario_model(7, 16), 2));
  CHECK(made("").has_value());
  CHECK(made("material = \"dirt\"").has_value());
  CHECK(code("material = \"cheese\"") == ErrorCode::not_found);
  CHECK(code("number = 5") == ErrorCode::not_found);
  for (const char* bad : {"number = 0", "number = 38", "number = -1", "edge = 0", "edge = 24",
                          "edge = 256", "height = 3", "number = \"7\"", "number ="}) {
    CAPTURE(bad);
    CHECK(code(bad) == ErrorCode::bad_value);
  }
  const ScenarioParameters odd{14, 64, "dirt"};
  CHECK(to_toml(odd) == "number = 14\nedge = 64\nmaterial = \"dirt\"\n");
  const auto read = parse_scenario_parameters(to_toml(odd));
  REQUIRE(read.has_value());
  CHECK(*read == odd);
}

TEST_CASE("outside a scenario's world is one empty run", "[generate][scenarios]") {
  const ScenarioWorld full(*scenario_model(1, 32), kSolid);
  CHECK(full.generate({64, 0, 0}, Extent::cube(32)) == uniform_chunk(Extent::cube(32), kEmpty));
  CHECK(full.generate({0, -64, 0}, Extent::cube(32)) == uniform_chunk(Extent::cube(32), kEmpty));
  CHECK(full.generate({0, 0, 0}, Extent::cube(32)).is_uniform());
}

}  // namespace
}  // namespace runstone::test
