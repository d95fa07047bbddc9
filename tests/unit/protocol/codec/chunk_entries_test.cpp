#include "protocol/codec/chunk_entries.hpp"

#include <catch2/catch.hpp>

#include "common/runs/run_builder.hpp"
#include "tests/support/codec/random_message.hpp"

namespace runstone::test {
namespace {

/// Returns the entries of both forms that a server would make of these chunks.
std::vector<ChunkEntry> entries_of(const Chunks& message, ChunkEncoding encoding) {
  std::vector<ChunkEntry> entries;
  for (const ChunkAnswer& answer : message.chunks) {
    const auto* snapshot = std::get_if<ChunkSnapshot>(&answer);
    entries.push_back(snapshot != nullptr
                          ? encode_snapshot(snapshot->key, snapshot->chunk, encoding)
                          : encode_chunk_edits(std::get<ChunkEdits>(answer)));
  }
  return entries;
}

}  // namespace

TEST_CASE("joined entries are the message of their chunks, in every encoding", "[protocol]") {
  SplitMix64 rng{Catch::rngSeed()};
  for (int step = 0; step < 20; ++step) {
    CAPTURE(Catch::rngSeed(), step);
    const auto message = random_message<Chunks>(rng);
    for (const ChunkEncoding encoding :
         {ChunkEncoding::raw, ChunkEncoding::packed, ChunkEncoding::coded}) {
      const auto decoded = decode(join_entries(message.view, entries_of(message, encoding)));
      REQUIRE(decoded.has_value());
      CHECK(*decoded == Message(message));
    }
  }
}

TEST_CASE("an entry knows its key and its runs, and its bytes do not depend on its place",
          "[protocol]") {
  RunBuilder builder(Extent::cube(kMessageEdge), AxisOrder::xyz);
  builder.append_to(3, 1);
  builder.append_to(4096, 0);
  const RunChunk voxels = builder.finish();
  const Chunk chunk{voxels, {3, 500}, digest_of(voxels)};
  const ChunkKey here{0, {1, -2, 3}}, there{0, {7, 0, 0}};
  const ChunkEntry entry = encode_snapshot(here, chunk, ChunkEncoding::coded);
  CHECK(entry.key == here);
  CHECK(entry.runs == 2);
  CHECK(*entry.bytes == *encode_snapshot(there, chunk, ChunkEncoding::coded).bytes);

  ChunkEdits edits;
  edits.key = there;
  edits.to = {3, 500};
  edits.edits = {{500, {SetVoxel{{1, 2, 3}}, {}, 1}}};
  const ChunkEntry lacking = encode_chunk_edits(edits);
  CHECK(lacking.key == there);
  CHECK(lacking.runs == 0);

  // One entry serves messages of different views and companies.
  const auto alone = decode(join_entries(1, std::vector<ChunkEntry>{entry}));
  const auto both = decode(join_entries(9, std::vector<ChunkEntry>{entry, lacking}));
  REQUIRE(alone.has_value());
  REQUIRE(both.has_value());
  CHECK(*alone == Message(Chunks{1, {ChunkSnapshot{here, chunk}}}));
  CHECK(*both == Message(Chunks{9, {ChunkSnapshot{here, chunk}, edits}}));
}

TEST_CASE("a chunk in company costs no envelope", "[protocol]") {
  const RunChunk voxels = uniform_chunk(Extent::cube(kMessageEdge), 1);
  const Chunk chunk{voxels, {3, 500}, digest_of(voxels)};
  std::vector<ChunkEntry> entries;
  for (std::int32_t z = 0; z < 100; ++z)
    entries.push_back(encode_snapshot({0, {0, 0, z}}, chunk, ChunkEncoding::coded));
  const std::size_t bytes = join_entries(1, entries).bytes->size();
  // A key of three bytes, and the envelope of a message once, padding included.
  CHECK(bytes <= 100 * (entries[0].bytes->size() + 3) + 48);
}

}  // namespace runstone::test
