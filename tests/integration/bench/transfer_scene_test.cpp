// The four forms of a scene end in the same faces, in whatever pieces the stream arrives.
#include "bench/network/transfer_scene.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/support/mesh/mesh_scene.hpp"

using namespace runstone;
using namespace runstone::bench;

namespace {

TransferScene scene_of(SplitMix64& rng) {
  TransferScene out;
  out.name = "random";
  out.edge = 16;
  out.visibility = std::make_shared<const VisibilityTable>(test::mesh_visibility());
  for (const ChunkCoord at :
       {ChunkCoord{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {5, 0, 0}}) {
    out.chunks[at] = test::scene_of_extent(rng, Extent::cube(16), AxisOrder::yxz).chunk;
  }
  return out;
}

}  // namespace

TEST_CASE("a scene has the same faces in every form and in pieces of any size", "[testbed]") {
  SplitMix64 rng(Catch::rngSeed() + 3);
  const TransferScene scene = scene_of(rng);
  // Every chunk alone, compared with the oracle.
  std::uint64_t expected = 0;
  for (const auto& [at, chunk] : scene.chunks) {
    test::MeshScene alone{chunk, {}};
    for (unsigned d = 0; d < kDirectionCount; ++d) {
      const auto beside = scene.chunks.find(neighbour(at, static_cast<Direction>(d)));
      if (beside != scene.chunks.end()) alone.neighbours[d] = beside->second;
    }
    expected += test::expected_faces(alone).size();
  }
  REQUIRE(expected > 0);
  for (const Transfer transfer : kTransfers) {
    CAPTURE(name_of(transfer));
    const Bytes stream = encode_scene(scene, transfer);
    for (const std::size_t piece : {std::size_t{7}, std::size_t{1000}, stream.size()}) {
      SceneReceiver receiver(scene, transfer);
      for (std::size_t at = 0; at < stream.size(); at += piece) {
        REQUIRE_FALSE(receiver.complete());
        REQUIRE(receiver.feed(ByteView(stream).subspan(at, std::min(piece, stream.size() - at))));
      }
      REQUIRE(receiver.complete());
      CHECK(receiver.times().faces == expected);
    }
  }
}

TEST_CASE("bytes that are no scene are rejected", "[testbed]") {
  SplitMix64 rng(5);
  const TransferScene scene = scene_of(rng);
  const Bytes junk(100'000, 0xff);
  for (const Transfer transfer : kTransfers) {
    CAPTURE(name_of(transfer));
    SceneReceiver receiver(scene, transfer);
    CHECK_FALSE(receiver.feed(junk));
  }
}
