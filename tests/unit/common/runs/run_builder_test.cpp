#include "common/runs/run_builder.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("stretches of one material become one run", "[runs][builder]") {
  RunBuilder builder(Extent::cube(8), AxisOrder::yzx);
  builder.append(10, 1);
  builder.append(0, 2);  // appends nothing and must not separate its neighbours
  builder.append(5, 1);
  CHECK(builder.filled() == 15);
  builder.append_to(20, 3);
  builder.append_to(512, kEmpty);
  const RunChunk chunk = builder.finish();
  CHECK(chunk.order == AxisOrder::yzx);
  REQUIRE(chunk.runs.size() == 3);
  CHECK(chunk.runs[0] == Run{15, 1});
  CHECK(chunk.runs[1] == Run{20, 3});
  CHECK(chunk.runs[2] == Run{512, kEmpty});
  CHECK(validate(chunk).has_value());
}

TEST_CASE("a chunk that begins with empty voxels begins with an empty run", "[runs][builder]") {
  RunBuilder builder(Extent::cube(8), AxisOrder::xyz);
  builder.append(1, kEmpty);
  builder.append(511, 4);
  const RunChunk chunk = builder.finish();
  REQUIRE(chunk.runs.size() == 2);
  CHECK(chunk.runs[0] == Run{1, kEmpty});
}

TEST_CASE("a finished builder starts over", "[runs][builder]") {
  RunBuilder builder(Extent::cube(8), AxisOrder::xyz);
  builder.append(512, 4);
  const RunChunk first = builder.finish();
  CHECK(builder.filled() == 0);
  builder.append(512, 5);
  const RunChunk second = builder.finish();
  CHECK(first == uniform_chunk(Extent::cube(8), 4));
  CHECK(second == uniform_chunk(Extent::cube(8), 5));
}

TEST_CASE("the builder uses the form that the volume requires", "[runs][builder]") {
  CHECK(uniform_chunk({71, 71, 13}, 1).runs.is_narrow());        // 65,533 voxels
  CHECK_FALSE(uniform_chunk({32, 32, 64}, 1).runs.is_narrow());  // 65,536 voxels
  CHECK(validate(uniform_chunk({71, 71, 13}, 1)).has_value());
  CHECK(validate(uniform_chunk({32, 32, 64}, 1)).has_value());
  CHECK(validate(uniform_chunk(Extent::cube(128), 1)).has_value());
}
