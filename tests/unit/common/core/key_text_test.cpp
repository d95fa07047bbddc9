#include "common/core/key_text.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("positions, chunk keys and versions are spelt as in log lines", "[core]") {
  CHECK(text_of(VoxelPos{1, 0, -3}) == "1 0 -3");
  CHECK(text_of(ChunkKey{0, {1, 0, -3}}) == "1,0,-3");
  CHECK(text_of(ChunkKey{2, {1, 0, -3}}) == "1,0,-3 lod=2");
  CHECK(text_of(Version{4294967295, 9120}) == "4294967295:9120");
}
