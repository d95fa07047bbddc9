// Requires that two meshes are the same quads in the same order.
#pragma once
#include <catch2/catch.hpp>

#include "common/mesh/chunk_mesh.hpp"

namespace runstone::test {

inline void require_equal(const QuadLayers& a, const QuadLayers& b) {
  REQUIRE(a.quads == b.quads);
  REQUIRE(a.first == b.first);
}

}  // namespace runstone::test
