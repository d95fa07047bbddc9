#include <catch2/catch.hpp>
#include <string>

#include "common/runs/reorder.hpp"
#include "protocol/chunks/chunk_codec.hpp"
#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/runs/random_chunk.hpp"
#include "tests/unit/bindings/c/owned_handle.hpp"

namespace runstone::test {
namespace {

Owned<runstone_chunk> filled(std::uint32_t edge, std::uint16_t material) {
  return owned<runstone_chunk>([&](runstone_chunk** out) {
    return runstone_chunk_create_filled(edge, edge, edge, material, out);
  });
}

}  // namespace

TEST_CASE("a chunk goes through the C interface as runs and as an array", "[c_interface]") {
  SplitMix64 rng{31};
  for (int round = 0; round < 40; ++round) {
    CAPTURE(round);
    const RunChunk chunk = random_chunk(rng, 40, 1 + rng.below(6));
    const DenseChunk dense = DenseChunk::of(chunk);
    const auto handle = handle_of(chunk);
    REQUIRE(same_runs(handle.get(), chunk));

    const auto order = static_cast<std::uint32_t>(random_order(rng));
    const auto voxels = fetched<std::uint16_t>([&](auto* out, std::size_t room, std::size_t* n) {
      return runstone_chunk_to_array(handle.get(), order, out, room, n);
    });
    REQUIRE(voxels.size() == chunk.volume());
    bool is_equal = true;
    for (std::uint32_t i = 0; i < voxels.size(); ++i) {
      const VoxelPos at = dense_pos(chunk.extent, static_cast<AxisOrder>(order), i);
      is_equal = is_equal && voxels[i] == dense.at(at.x, at.y, at.z);
    }
    CHECK(is_equal);

    const auto again = owned<runstone_chunk>([&](runstone_chunk** out) {
      return runstone_chunk_create_from_array(chunk.extent.x, chunk.extent.y, chunk.extent.z, order,
                                              voxels.data(), voxels.size(), out);
    });
    CHECK(same_runs(again.get(), reorder(chunk, static_cast<AxisOrder>(order))));
    std::uint32_t equal = 0;
    CHECK(runstone_chunk_equal(handle.get(), again.get(), &equal) == RUNSTONE_OK);
    CHECK(equal == 1);

    REQUIRE(runstone_chunk_reorder(again.get(), RUNSTONE_ORDER_CHEAPEST) == RUNSTONE_OK);
    CHECK(same_runs(again.get(), in_cheapest_order(reorder(chunk, static_cast<AxisOrder>(order)))));
    std::uint64_t digest[2] = {};
    REQUIRE(runstone_chunk_digest(again.get(), digest) == RUNSTONE_OK);
    CHECK(Digest{{digest[0], digest[1]}} == dense.digest());
  }
}

TEST_CASE("a voxel is read and filled through the C interface", "[c_interface]") {
  const auto chunk = filled(16, 3);
  REQUIRE(runstone_chunk_fill(chunk.get(), 16 * 16 + 5, 1, 9) == RUNSTONE_OK);
  std::uint16_t material = 0;
  CHECK(runstone_chunk_get(chunk.get(), 5, 0, 1, &material) == RUNSTONE_OK);
  CHECK(material == 9);
  CHECK(runstone_chunk_get(chunk.get(), 16, 0, 0, &material) == RUNSTONE_BAD_ARGUMENT);
  CHECK(runstone_chunk_get(chunk.get(), 0, 256, 0, &material) == RUNSTONE_BAD_ARGUMENT);
  CHECK(material == 9);
  CHECK(runstone_chunk_fill(chunk.get(), 0, 0, 1) == RUNSTONE_BAD_ARGUMENT);
  CHECK(runstone_chunk_fill(chunk.get(), 4095, 2, 1) == RUNSTONE_BAD_ARGUMENT);
  CHECK(runstone_chunk_fill(chunk.get(), 4096, 1, 1) == RUNSTONE_BAD_ARGUMENT);
  CHECK(runstone_chunk_fill(chunk.get(), 1, 0xffffffff, 1) == RUNSTONE_BAD_ARGUMENT);
  runstone_chunk_info info{};
  info.struct_size = sizeof info;
  REQUIRE(runstone_chunk_get_info(chunk.get(), &info) == RUNSTONE_OK);
  CHECK(info.runs == 3);
  CHECK(info.volume == 4096);
  CHECK(info.is_uniform == 0);
  info.struct_size = sizeof info - 1;
  CHECK(runstone_chunk_get_info(chunk.get(), &info) == RUNSTONE_BAD_ARGUMENT);
}

TEST_CASE("a clone and its original change apart from each other", "[c_interface]") {
  const auto chunk = filled(16, 3);
  const auto clone = owned<runstone_chunk>(
      [&](runstone_chunk** out) { return runstone_chunk_clone(chunk.get(), out); });
  REQUIRE(runstone_chunk_fill(clone.get(), 0, 1, 4) == RUNSTONE_OK);
  std::uint32_t equal = 1;
  CHECK(runstone_chunk_equal(chunk.get(), clone.get(), &equal) == RUNSTONE_OK);
  CHECK(equal == 0);
  CHECK(same_runs(chunk.get(), uniform_chunk(Extent::cube(16), 3)));
}

TEST_CASE("sides of 4 and 256 voxels and wrong counts are refused", "[c_interface]") {
  auto* const poison = reinterpret_cast<runstone_chunk*>(std::uintptr_t{16});
  const std::vector<std::uint16_t> voxels(512, 1);
  const std::uint32_t end = 512;
  for (const std::uint32_t side : {0U, 4U, 7U, 129U, 256U, 264U, 0xffffffffU}) {
    CAPTURE(side);
    runstone_chunk* out = poison;
    CHECK(runstone_chunk_create_filled(side, 8, 8, 1, &out) == RUNSTONE_BAD_ARGUMENT);
    CHECK(out == nullptr);
    CHECK(runstone_chunk_create_from_array(8, side, 8, 0, voxels.data(), 512, &out) ==
          RUNSTONE_BAD_ARGUMENT);
    CHECK(runstone_chunk_create_from_runs(8, 8, side, 0, &end, voxels.data(), 1, &out) ==
          RUNSTONE_BAD_ARGUMENT);
    runstone_space* space = nullptr;
    CHECK(runstone_space_create(side, &space) == RUNSTONE_BAD_ARGUMENT);
    const std::uint32_t sides[3] = {8, 8, side};
    CHECK(runstone_chunk_decode(nullptr, 0, sides, &out) == RUNSTONE_BAD_ARGUMENT);
  }
  runstone_chunk* out = poison;
  CHECK(runstone_chunk_create_from_array(8, 8, 8, 0, voxels.data(), 511, &out) ==
        RUNSTONE_BAD_ARGUMENT);
  CHECK(runstone_chunk_create_from_array(8, 8, 8, 6, voxels.data(), 512, &out) ==
        RUNSTONE_BAD_ARGUMENT);
  CHECK(out == nullptr);
}

TEST_CASE("runs that are not canonical are refused", "[c_interface]") {
  const auto status_of = [](std::vector<std::uint32_t> ends, std::vector<std::uint16_t> materials) {
    runstone_chunk* out = nullptr;
    const runstone_status status = runstone_chunk_create_from_runs(
        8, 8, 8, 0, ends.data(), materials.data(), ends.size(), &out);
    CHECK((out != nullptr) == (status == RUNSTONE_OK));
    runstone_chunk_free(out);
    return status;
  };
  CHECK(status_of({100, 512}, {1, 2}) == RUNSTONE_OK);
  CHECK(status_of({100, 512}, {1, 1}) == RUNSTONE_BROKEN_INVARIANT);
  CHECK(status_of({100, 511}, {1, 2}) == RUNSTONE_BROKEN_INVARIANT);
  CHECK(status_of({100, 100, 512}, {1, 2, 3}) == RUNSTONE_BROKEN_INVARIANT);
  CHECK(status_of({100, 513}, {1, 2}) == RUNSTONE_BROKEN_INVARIANT);
  CHECK(status_of({100, 65536 + 512}, {1, 2}) == RUNSTONE_BROKEN_INVARIANT);
  CHECK(status_of({0, 512}, {1, 2}) == RUNSTONE_BROKEN_INVARIANT);
}

TEST_CASE("buffers that are too small are not written", "[c_interface]") {
  const auto chunk = filled(8, 3);
  std::vector<std::uint16_t> out(511, 77);
  std::size_t count = 0;
  CHECK(runstone_chunk_to_array(chunk.get(), 0, out.data(), out.size(), &count) ==
        RUNSTONE_BUFFER_TOO_SMALL);
  CHECK(count == 512);
  CHECK(out == std::vector<std::uint16_t>(511, 77));
  CHECK(runstone_chunk_to_array(chunk.get(), 0, nullptr, 512, &count) == RUNSTONE_BAD_ARGUMENT);
  CHECK(runstone_chunk_to_array(chunk.get(), 6, out.data(), 0, &count) == RUNSTONE_BAD_ARGUMENT);
  CHECK(runstone_chunk_to_array(chunk.get(), 0, out.data(), 0, nullptr) == RUNSTONE_BAD_ARGUMENT);
}

TEST_CASE("chunk bytes of the C interface are those of the codec", "[c_interface]") {
  SplitMix64 rng{7};
  for (int round = 0; round < 30; ++round) {
    CAPTURE(round);
    const RunChunk chunk = random_chunk(rng, 24, 1 + rng.below(6));
    const auto handle = handle_of(chunk);
    for (const auto encoding : {ChunkEncoding::raw, ChunkEncoding::packed, ChunkEncoding::coded}) {
      const auto bytes = fetched<std::uint8_t>([&](auto* out, std::size_t room, std::size_t* n) {
        return runstone_chunk_encode(handle.get(), static_cast<std::uint32_t>(encoding), out, room,
                                     n);
      });
      CHECK(bytes == encode_chunk(chunk, encoding));
      const std::uint32_t sides[3] = {chunk.extent.x, chunk.extent.y, chunk.extent.z};
      const auto decoded = owned<runstone_chunk>([&](runstone_chunk** out) {
        return runstone_chunk_decode(bytes.data(), bytes.size(), sides, out);
      });
      CHECK(same_runs(decoded.get(), chunk));
      const std::uint32_t others[3] = {chunk.extent.x, chunk.extent.y, chunk.extent.z ^ 1U};
      runstone_chunk* out = nullptr;
      CHECK(runstone_chunk_decode(bytes.data(), bytes.size(), others, &out) == RUNSTONE_BAD_VALUE);
      CHECK(out == nullptr);
    }
    std::size_t count = 0;
    CHECK(runstone_chunk_encode(handle.get(), 4, nullptr, 0, &count) == RUNSTONE_BAD_ARGUMENT);
    CHECK(runstone_chunk_encode(handle.get(), 257, nullptr, 0, &count) == RUNSTONE_BAD_ARGUMENT);
  }
}

TEST_CASE("truncated chunk bytes are refused as the codec refuses them", "[c_interface]") {
  SplitMix64 rng{9};
  const RunChunk chunk = random_chunk(rng, {8, 9, 10}, AxisOrder::zxy, 4, ChunkShape::boxes);
  for (const auto encoding : {ChunkEncoding::raw, ChunkEncoding::packed, ChunkEncoding::coded}) {
    const Bytes bytes = encode_chunk(chunk, encoding);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      runstone_chunk* out = nullptr;
      const auto expected = decode_chunk(ByteView(bytes).first(size));
      REQUIRE_FALSE(expected.has_value());
      CHECK(runstone_chunk_decode(bytes.data(), size, nullptr, &out) ==
            static_cast<int>(expected.error().code) + 1);
      CHECK(out == nullptr);
      CHECK(std::string(runstone_last_error()).starts_with("bytes: "));
    }
  }
}

}  // namespace runstone::test
