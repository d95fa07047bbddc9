// Messages that the tests of sessions send, and answers that they wait for.
#pragma once
#include <catch2/catch.hpp>
#include <utility>
#include <vector>

#include "tests/support/net/raw_client.hpp"

namespace runstone::test {

inline EditRequest voxel_edit(ClientSequence seq, VoxelPos at, Material material) {
  return {seq, 0, {SetVoxel{at}, {}, material}};
}

inline Material some_material(ClientSequence seq) { return static_cast<Material>(1 + seq % 3); }

/// Reads until `count` snapshots have arrived. Returns them in order.
inline std::vector<ChunkSnapshot> next_snapshots(RawClient& client, std::size_t count) {
  std::vector<ChunkSnapshot> got;
  while (got.size() < count) {
    auto next = client.next_of<ChunkSnapshot>();
    REQUIRE(next.has_value());
    got.push_back(*std::move(next));
  }
  return got;
}

}  // namespace runstone::test
