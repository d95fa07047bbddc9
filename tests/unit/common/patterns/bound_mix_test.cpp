#include "common/patterns/bound_mix.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <vector>

#include "common/patterns/pattern_parser.hpp"

namespace runstone::test {
namespace {

BoundMix mix_of(std::string_view text, PatternFrame frame = {}) {
  const auto mix = parse_mix(text);
  REQUIRE(mix);
  auto bound = BoundMix::of(*mix, default_material_table(), frame);
  REQUIRE(bound);
  return *std::move(bound);
}

Material id(std::string_view name) { return *default_material_table().find(name); }

std::map<Material, double> shares(BoundMix& mix, VoxelBox box) {
  std::map<Material, double> out;
  double count = 0;
  for (std::int32_t z = box.min.z; z < box.max.z; ++z) {
    for (std::int32_t y = box.min.y; y < box.max.y; ++y) {
      for (std::int32_t x = box.min.x; x < box.max.x; ++x, ++count) out[mix.at({x, y, z})] += 1;
    }
  }
  for (auto& [material, share] : out) share /= count;
  return out;
}

}  // namespace

TEST_CASE("the parts of a mix are as frequent as their weights", "[patterns]") {
  BoundMix mix = mix_of("70% stone, 20% gravel, 10% (dirt, clay)");
  constexpr double kVoxels = 80.0 * 80 * 80;
  auto found = shares(mix, {{-40, -40, -40}, {40, 40, 40}});
  const std::map<Material, double> wanted = {
      {id("stone"), 0.7}, {id("gravel"), 0.2}, {id("dirt"), 0.05}, {id("clay"), 0.05}};
  REQUIRE(found.size() == wanted.size());
  double chi_square = 0;
  for (const auto& [material, share] : wanted) {
    const double difference = (found[material] - share) * kVoxels;
    chi_square += difference * difference / (share * kVoxels);
  }
  CHECK(chi_square < 16.3);  // 0.1 % of random mixes have more
  BoundMix even = mix_of("stone, gravel, dirt");
  for (const auto& [material, share] : shares(even, {{0, 0, 0}, {64, 64, 64}}))
    CHECK(share == Approx(1.0 / 3).margin(0.005));
}

TEST_CASE("clumps keep the weights, and neighbours tend to be the same", "[patterns]") {
  const auto same_share = [](BoundMix& mix) {
    int same = 0;
    for (std::int32_t i = 0; i < 10'000; ++i)
      same += mix.at({i, 7, 3}) == mix.at({i, 8, 3}) ? 1 : 0;
    return same / 10'000.0;
  };
  BoundMix clumps = mix_of("noise 8: 60% stone, 40% gravel");
  BoundMix single = mix_of("60% stone, 40% gravel");
  CHECK(shares(clumps, {{0, 0, 0}, {160, 160, 160}})[id("stone")] == Approx(0.6).margin(0.02));
  CHECK(same_share(clumps) > 0.75);
  CHECK(same_share(single) < 0.56);
  BoundMix smallest = mix_of("noise 1: 60% stone, 40% gravel");
  CHECK(shares(smallest, {{0, 0, 0}, {40, 40, 40}})[id("stone")] == Approx(0.6).margin(0.01));
}

TEST_CASE("the points that clumps keep change no answer", "[patterns]") {
  ClumpNoise kept(77, 5);
  SplitMix64 rng(5);
  for (int i = 0; i < 20'000; ++i) {
    const VoxelPos at{rng.between(-20, 20), rng.between(-20, 20), rng.between(-20, 20)};
    ClumpNoise fresh(77, 5);
    if (kept.at(at) != fresh.at(at)) FAIL_CHECK(at.x << " " << at.y << " " << at.z);
  }
  // At the border of the world no sum overflows.
  for (const std::int32_t size : {2, 256}) {
    ClumpNoise border(77, size);
    CHECK(border.at({-kWorldLimit, kWorldLimit - 1, -kWorldLimit}) !=
          border.at({kWorldLimit - 1, -kWorldLimit, kWorldLimit - 1}));
  }
}

TEST_CASE("a gradient goes from its first part to its last one", "[patterns]") {
  BoundMix height = mix_of("y 40..90: grass, stone, snow");
  const auto layer = [&](BoundMix& mix, std::int32_t y) {
    return shares(mix, {{0, y, 0}, {60, y + 1, 60}});
  };
  for (const std::int32_t y : {-1000, 39, 40}) CHECK(layer(height, y)[id("grass")] == 1);
  CHECK(layer(height, 65)[id("stone")] == 1);
  for (const std::int32_t y : {90, 91, 1000}) CHECK(layer(height, y)[id("snow")] == 1);
  auto between = layer(height, 50);
  CHECK(between[id("grass")] == Approx(0.6).margin(0.03));
  CHECK(between[id("stone")] == Approx(0.4).margin(0.03));

  const VoxelBox box{{10, 10, 10}, {31, 31, 31}};
  BoundMix distance = mix_of("distance 4..8: grass, stone", {1, middle2_of(box)});
  CHECK(distance.at({20, 20, 20}) == id("grass"));
  CHECK(distance.at({20, 24, 20}) == id("grass"));
  for (const std::int32_t far : {8, 9, 100'000'000})
    CHECK(distance.at({20, 20, 20 + far}) == id("stone"));
  CHECK(middle2_of({{0, 0, 0}, {2, 1, 1}}) == VoxelPos{1, 0, 0});
}

TEST_CASE("a material depends on the place and the seed alone", "[patterns]") {
  constexpr std::string_view kText =
      "noise 6: 50% (y 0..40: grass, stone), 30% (distance 0..30: sand, clay), 20% (dirt, snow)";
  const auto digest = [&](std::uint64_t seed) {
    BoundMix mix = mix_of(kText, {seed, {31, 31, 31}});
    std::uint64_t out = 0;
    for (std::int32_t z = -16; z < 16; ++z) {
      for (std::int32_t y = -16; y < 32; ++y) {
        for (std::int32_t x = -16; x < 16; ++x) out = mix64(out + mix.at({x, y, z}));
      }
    }
    return out;
  };
  // A change of these numbers changes what a repeated stroke does to ground that was mixed before.
  CHECK(digest(1) == 0x553b983f22165f69ULL);
  CHECK(digest(2) == 0x0e4aa87394b8596bULL);
}

TEST_CASE("a column that is read at once has the materials of its voxels", "[patterns]") {
  const MaterialTable& table = default_material_table();
  for (const char* text :
       {"stone", "70% stone, 20% gravel, 10% clay", "stone, gravel",
        "1% stone, 9999% (50% gravel, 50% clay)", "noise 5: 30% stone, 70% gravel",
        "y -20..30: stone, gravel, clay", "distance 3..40: stone, gravel",
        "stone, gravel, clay, dirt, grass, sand, stone, gravel, clay, dirt"}) {
    const auto mix = parse_mix(text);
    CAPTURE(text);
    REQUIRE(mix);
    for (const std::uint64_t seed : {0ULL, 5ULL, ~0ULL}) {
      auto bound = BoundMix::of(*mix, table, {seed, {7, -3, 11}}).value();
      auto again = bound;
      for (const VoxelPos low : {VoxelPos{0, -64, 0}, VoxelPos{-17, -5, 900},
                                 VoxelPos{kWorldLimit - 1, -kWorldLimit, -kWorldLimit}}) {
        std::vector<Material> column(130);
        bound.read_column(low, column);
        for (std::size_t i = 0; i < column.size(); ++i) {
          const VoxelPos at{low.x, low.y + static_cast<std::int32_t>(i), low.z};
          if (column[i] != again.at(at)) FAIL("another material at " << at.y);
        }
      }
    }
  }
}

TEST_CASE("the choices of a mix are pinned, because scripts and previews rely on them",
          "[patterns][golden]") {
  const MaterialTable& table = default_material_table();
  const auto digest_of_mix = [&](const char* text) {
    auto bound = BoundMix::of(parse_mix(text).value(), table, {5, {1, 2, 3}}).value();
    std::uint64_t sum = 0;
    std::vector<Material> column(64);
    for (std::int32_t x = -8; x < 8; ++x) {
      bound.read_column({x, -32, 3 * x}, column);
      for (const Material material : column) sum = mix64(sum ^ material);
    }
    return sum;
  };
  CHECK(digest_of_mix("70% stone, 20% gravel, 10% clay") == 0x3911002caf64a7a0ULL);
  CHECK(digest_of_mix("50% stone, 50% (30% gravel, 70% clay)") == 0x23e126c9832b59a7ULL);
  CHECK(digest_of_mix("noise 8: 60% stone, 40% gravel") == 0x981cf90d6acac63eULL);
}

TEST_CASE("a material that the world lacks is named with its column", "[patterns]") {
  const auto mix = parse_mix("stone, ston");
  REQUIRE(mix);
  const auto bound = BoundMix::of(*mix, default_material_table(), {});
  REQUIRE_FALSE(bound);
  CHECK(bound.error().message() == "column 8: the world has no material \"ston\"");
  CHECK(mix_of("stone").single() == id("stone"));
  CHECK_FALSE(mix_of("stone, dirt").single());
}

}  // namespace runstone::test
