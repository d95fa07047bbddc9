#include "common/collision/merged_boxes.hpp"

#include <catch2/catch.hpp>

namespace runstone::test {
namespace {

constexpr Material kRock = 1, kSoil = 2, kPool = 3;

std::vector<MergedBox> boxes_of(const RunChunk& chunk, const MaterialSet& solid = {}) {
  std::vector<MergedBox> out;
  REQUIRE(merge_boxes(chunk, solid, kMergedBoxesMax, out).has_value());
  return out;
}

void set_one(RunChunk& chunk, LocalPos at, Material material) {
  fill(chunk, index_of(at, chunk.extent, chunk.order), 1, material);
}

}  // namespace

TEST_CASE("a full chunk is one box and an empty chunk none", "[collision]") {
  for (const AxisOrder order : kAxisOrders) {
    const Extent extent{8, 20, 128};
    CHECK(boxes_of(uniform_chunk(extent, kRock, order)) ==
          std::vector<MergedBox>{{{0, 0, 0}, {8, 20, 128}}});
    CHECK(boxes_of(uniform_chunk(extent, kEmpty, order)).empty());
  }
}

TEST_CASE("solid materials that touch become one box, others stay outside", "[collision]") {
  RunChunk chunk = uniform_chunk(Extent::cube(16), kEmpty, AxisOrder::xzy);
  fill(chunk, 0, 3 * 256, kRock);        // y 0 .. 2
  fill(chunk, 3 * 256, 2 * 256, kSoil);  // y 3 and 4
  fill(chunk, 5 * 256, 1 * 256, kPool);  // y 5
  const MaterialSet solid({false, true, true, false}, true);
  CHECK(boxes_of(chunk, solid) == std::vector<MergedBox>{{{0, 0, 0}, {16, 5, 16}}});
  CHECK(boxes_of(chunk) == std::vector<MergedBox>{{{0, 0, 0}, {16, 6, 16}}});
}

TEST_CASE("a hole splits a slab into boxes around it", "[collision]") {
  RunChunk chunk = uniform_chunk(Extent::cube(8), kRock, AxisOrder::xyz);
  set_one(chunk, {3, 4, 0}, kEmpty);
  // In layer z = 0: the lines before the hole, both sides of the hole, the lines behind it.
  CHECK(boxes_of(chunk) == std::vector<MergedBox>{{{0, 0, 0}, {8, 4, 1}},
                                                  {{0, 4, 0}, {3, 5, 1}},
                                                  {{4, 4, 0}, {8, 5, 1}},
                                                  {{0, 5, 0}, {8, 8, 1}},
                                                  {{0, 0, 1}, {8, 8, 8}}});
}

TEST_CASE("equal rectangles merge only over layers that follow each other", "[collision]") {
  RunChunk chunk = uniform_chunk(Extent::cube(8), kEmpty, AxisOrder::xyz);
  for (const std::uint8_t z : {std::uint8_t{1}, std::uint8_t{2}, std::uint8_t{4}})
    set_one(chunk, {5, 5, z}, kRock);
  CHECK(boxes_of(chunk) == std::vector<MergedBox>{{{5, 5, 1}, {6, 6, 3}}, {{5, 5, 4}, {6, 6, 5}}});
}

TEST_CASE("merging stops when there are more boxes than allowed", "[collision]") {
  RunChunk chunk = uniform_chunk(Extent::cube(8), kEmpty, AxisOrder::xyz);
  for (const std::uint8_t x : {std::uint8_t{0}, std::uint8_t{2}, std::uint8_t{4}})
    set_one(chunk, {x, 0, 0}, kRock);
  std::vector<MergedBox> out{{}, {}};
  CHECK(merge_boxes(chunk, {}, 3, out).has_value());
  CHECK(out.size() == 3);
  const auto refused = merge_boxes(chunk, {}, 2, out);
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error().code == ErrorCode::limit_exceeded);
  CHECK(out.empty());
  CHECK(merge_boxes(uniform_chunk(Extent::cube(8), kEmpty), {}, 0, out).has_value());
}

}  // namespace runstone::test
