#include <catch2/catch.hpp>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/edits/descriptor/ordered_shape.hpp"
#include "tests/support/edits/edit_oracle.hpp"

namespace runstone::test {
namespace {

EditDescriptor voxel(VoxelPos at) { return {SetVoxel{at}, {}, 1}; }
EditDescriptor box(VoxelPos min, VoxelPos max) { return {FillBox{{min, max}}, {}, 1}; }
EditDescriptor sphere(VoxelPos centre, std::uint16_t radius) {
  return {FillSphere{centre, radius}, {}, 1};
}

std::vector<IndexSpan> spans_of(const EditDescriptor& edit, Extent extent = Extent::cube(8),
                                AxisOrder order = AxisOrder::xyz) {
  std::vector<IndexSpan> out;
  append_spans(edit, {}, extent, order, out);
  return out;
}

using Spans = std::vector<IndexSpan>;

}  // namespace

TEST_CASE("bounding boxes hold the geometry tightly", "[edits]") {
  CHECK(bounding_box(voxel({-1, 2, 3})) == VoxelBox{{-1, 2, 3}, {0, 3, 4}});
  CHECK(bounding_box(box({0, -5, 1}, {2, 5, 9})) == VoxelBox{{0, -5, 1}, {2, 5, 9}});
  CHECK(bounding_box(sphere({10, 20, -30}, 4)) == VoxelBox{{6, 16, -34}, {15, 25, -25}});
}

TEST_CASE("small geometries have the voxel counts that were counted by hand", "[edits]") {
  CHECK(counted_voxels(voxel({5, 5, 5})) == 1);
  CHECK(counted_voxels(box({0, 0, 0}, {2, 3, 4})) == 24);
  CHECK(counted_voxels(box({0, 0, 0}, {4096, 4096, 4096})) == 1ULL << 36);
  CHECK(counted_voxels(sphere({0, 0, 0}, 0)) == 1);
  // The centre, 6 faces and 12 edges. The 8 corners lie at 3 > 1 + 1.
  CHECK(counted_voxels(sphere({0, 0, 0}, 1)) == 19);
}

TEST_CASE("a stroke is the spheres along its line", "[edits]") {
  const auto stroke = [](std::vector<VoxelPos> points, std::uint16_t radius) {
    return EditDescriptor{FillStroke{std::move(points), radius}, {}, 1};
  };
  CHECK(bounding_box(stroke({{0, 9, 0}, {5, 2, -7}, {1, 1, 1}}, 2)) ==
        VoxelBox{{-2, -1, -9}, {8, 12, 4}});
  // Along x with radius 1: a bar of 3 x 3, and at each end the face of a sphere, which is a plus.
  const EditDescriptor bar = stroke({{2, 3, 3}, {5, 3, 3}}, 1);
  Spans middle;
  for (const IndexSpan& span : spans_of(bar)) {
    if (span.first >= 3 * 64 && span.last <= 4 * 64) middle.push_back(span);
  }
  CHECK(middle == Spans{{17 + 192, 23 + 192}, {25 + 192, 31 + 192}, {33 + 192, 39 + 192}});
  CHECK(touches(bar, {{1, 3, 3}, {2, 4, 4}}));
  CHECK(touches(bar, {{1, 2, 3}, {2, 3, 4}}));        // 1 + 1 <= 1 + 1
  CHECK_FALSE(touches(bar, {{1, 2, 2}, {2, 3, 3}}));  // 3 > 1 + 1
  CHECK(touches(bar, {{2, 2, 2}, {3, 3, 3}}));        // beside the end, not in front of it
  CHECK_FALSE(touches(bar, {{0, 0, 0}, {8, 2, 8}}));
  CHECK(counted_voxels(bar) == 6 * 9);  // as its box
  CHECK(counted_voxels(stroke({{0, 0, 0}, {9, 9, 9}}, 1)) == 2 * 9 * (9 + 3));
  CHECK(counted_voxels(stroke({{0, 0, 0}, {9, 9, 9}, {0, 0, 0}}, 1)) == 2 * 2 * 9 * (9 + 3));
  // A bend in a corner chunk of the bounding box, which neither segment reaches.
  const EditDescriptor bend = stroke({{8, 8, 8}, {40, 8, 8}, {40, 40, 8}}, 3);
  CHECK(touched_chunks(bend, 16) ==
        std::vector<ChunkCoord>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}});
  CHECK(touched_chunks_bound(bend, 16) == 6);
}

TEST_CASE("a sphere touches a box when its nearest voxel does", "[edits]") {
  const EditDescriptor ball = sphere({0, 0, 0}, 10);  // |d|^2 <= 110
  CHECK(touches(ball, {{10, 0, 0}, {11, 1, 1}}));
  CHECK(touches(ball, {{10, 3, 1}, {20, 20, 20}}));        // 100 + 9 + 1
  CHECK_FALSE(touches(ball, {{10, 3, 2}, {20, 20, 20}}));  // 100 + 9 + 4
  CHECK_FALSE(touches(ball, {{11, 0, 0}, {12, 1, 1}}));
  CHECK(touches(ball, {{-100, -100, -100}, {100, 100, 100}}));
  CHECK_FALSE(touches(ball, {{0, 0, 0}, {0, 5, 5}}));  // an empty box has no voxel
  CHECK_FALSE(touches(ball, {{INT32_MIN, INT32_MIN, INT32_MIN}, {INT32_MIN + 1, 0, 0}}));
}

TEST_CASE("touched chunks ascend by x, then y, then z, over negative coordinates too", "[edits]") {
  CHECK(touched_chunks(voxel({-1, 0, 16}), 16) == std::vector<ChunkCoord>{{-1, 0, 1}});
  CHECK(touched_chunks(box({-1, -1, -1}, {1, 1, 1}), 32) == std::vector<ChunkCoord>{{-1, -1, -1},
                                                                                    {-1, -1, 0},
                                                                                    {-1, 0, -1},
                                                                                    {-1, 0, 0},
                                                                                    {0, -1, -1},
                                                                                    {0, -1, 0},
                                                                                    {0, 0, -1},
                                                                                    {0, 0, 0}});
  // A sphere's bounding box has corners that the sphere does not reach.
  const EditDescriptor ball = sphere({16, 16, 16}, 17);
  CHECK(touched_chunks_bound(ball, 16) == 64);
  CHECK(touched_chunks(ball, 16).size() < 64);
}

TEST_CASE("a sphere of radius 50 lies in some fifty chunks of edge 32", "[edits]") {
  const auto chunks = touched_chunks(sphere({80, 80, 80}, 50), 32).size();
  CHECK(chunks >= 32);
  CHECK(chunks <= 64);
}

TEST_CASE("spans of boxes join whole lines and whole layers", "[edits]") {
  CHECK(spans_of(voxel({1, 2, 3})) == Spans{{1 + 16 + 192, 2 + 16 + 192}});
  CHECK(spans_of(box({2, 1, 0}, {4, 3, 1})) == Spans{{10, 12}, {18, 20}});
  CHECK(spans_of(box({0, 1, 0}, {8, 3, 2})) == Spans{{8, 24}, {72, 88}});
  CHECK(spans_of(box({0, 0, 1}, {8, 8, 4})) == Spans{{64, 256}});
  CHECK(spans_of(box({-5, -5, -5}, {50, 50, 50})) == Spans{{0, 512}});
  CHECK(spans_of(box({8, 0, 0}, {9, 8, 8})).empty());
}

TEST_CASE("spans follow the axis order", "[edits]") {
  const Extent extent{8, 9, 10};
  const EditDescriptor row = box({1, 2, 3}, {2, 3, 6});  // three voxels along z
  CHECK(spans_of(row, extent, AxisOrder::zyx) == Spans{{3 + 20 + 90, 6 + 20 + 90}});
  CHECK(spans_of(row, extent, AxisOrder::xyz).size() == 3);
}

TEST_CASE("a sphere's rows join where one ends a line and the next begins it", "[edits]") {
  // Radius 8 around a centre near a corner covers whole lines in the middle: they form one span.
  const Spans spans = spans_of(sphere({4, 4, 4}, 8));
  for (std::size_t i = 1; i < spans.size(); ++i) CHECK(spans[i - 1].last < spans[i].first);
  CHECK(spans_of(sphere({4, 4, 4}, 200)) == Spans{{0, 512}});
}

TEST_CASE("spans are appended behind existing ones and never joined with them", "[edits]") {
  Spans spans = {{0, 9}};
  append_spans(voxel({1, 1, 0}), {}, Extent::cube(8), AxisOrder::xyz, spans);
  CHECK(spans == Spans{{0, 9}, {9, 10}});
}

TEST_CASE("the integer square root is exact around every square", "[edits]") {
  CHECK(isqrt(0) == 0);
  for (std::uint32_t root = 1; root < 65536; ++root) {
    const std::uint32_t square = root * root;
    REQUIRE(isqrt(square) == root);
    REQUIRE(isqrt(square - 1) == root - 1);
  }
  CHECK(isqrt(0xffffffffu) == 65535);
}

}  // namespace runstone::test
