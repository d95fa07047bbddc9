// ReplicaBench: a replica, and the authority that plays its server.
#pragma once
#include <catch2/catch.hpp>

#include "client/replica/replica.hpp"
#include "tests/support/codec/authority_model.hpp"
#include "tests/support/codec/chunks_message.hpp"

namespace runstone::test {

struct ReplicaBench {
  static constexpr std::int32_t kEdge = 16;
  static constexpr ClientInstance kInstance = 77;
  static constexpr AuthorId kMe = 5;
  static constexpr ChunkKey kHere{0, {0, 0, 0}};
  static constexpr ChunkKey kRight{0, {1, 0, 0}};
  static constexpr Arrival kNow{1000, 1100, 1200};

  static OperationId other(ClientSequence seq) { return {9, 1, seq}; }
  static OperationId mine(ClientSequence seq) { return {kMe, kInstance, seq}; }
  static EditDescriptor set(VoxelPos at, Material material) { return {SetVoxel{at}, {}, material}; }
  static EditDescriptor box(VoxelPos min, VoxelPos max, Material material, Mask mask = {}) {
    return {FillBox{{min, max}}, mask, material};
  }

  ReplicaBench() {
    replica.set_view({1, {0, 0, 0}, 2, 2});
    static_cast<void>(replica.open(parameters()));
  }
  SessionParameters parameters(ClientSequence resolved = 0, Sequence durable = 0) const {
    return {kEdge, kMe, kInstance, world.epoch(), durable, world.head(), resolved};
  }
  void load(const ChunkKey& key) {
    replica.receive(chunks_of(world.snapshot(key.at)), kNow);
    static_cast<void>(replica.drain_changes());
  }
  void take(const Commit& commit) { REQUIRE(replica.receive(commit, kNow).has_value()); }
  ClientSequence predict(const EditDescriptor& edit) {
    const auto seq = replica.predict(edit, 500, 600);
    REQUIRE(seq.has_value());
    return *seq;
  }
  void require_in_step(const ChunkKey& key) {
    const ChunkPtr held = replica.confirmed(key);
    REQUIRE(held != nullptr);
    CHECK(held->version == world.chunk(key.at).version);
    CHECK(held->digest == world.chunk(key.at).digest);
    CHECK(digest_of(held->voxels) == world.chunk(key.at).digest);
  }
  AuthorityModel world{kEdge, 3};
  Replica replica;
};

}  // namespace runstone::test
