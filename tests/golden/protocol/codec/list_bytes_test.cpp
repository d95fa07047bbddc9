#include <catch2/catch.hpp>

#include "common/runs/run_builder.hpp"
#include "common/veil/veil.hpp"
#include "protocol/codec/chunk_entries.hpp"
#include "protocol/codec/chunk_lists.hpp"
#include "protocol/codec/commit_encoder.hpp"
#include "protocol/codec/key_list.hpp"
#include "protocol/codec/ordered_edit_reader.hpp"
#include "protocol/codec/uniform_list.hpp"
#include "tests/support/core/hex.hpp"
#include "tests/support/core/page_example.hpp"

// The byte lists have the bytes of the examples in docs/protocol.md, which were computed from the
// page by another program. A change here is a new protocol version.
namespace runstone::test {
namespace {

constexpr std::int32_t kEdge = 16;
constexpr Digest kDigest{{0x1d097e98f4fc2824ULL, 0x07cd14195a2e2b9aULL}};

template <class List>
void check_read(const Result<List>& read, const List& expected) {
  if (!read) FAIL(read.error().what);
  CHECK(*read == expected);
}

}  // namespace

TEST_CASE("the protocol page has no block of bytes that is not tested", "[protocol][golden]") {
  // Tested in this folder. A new block on the page needs a test and its name here.
  CHECK(page_example_names() ==
        std::vector<std::string>{
            "frame-header", "view-frame", "transcript", "signatures", "password", "device-code",
            "chunk-keys", "cached-chunks", "chunks-not-modified", "digest-check", "uniform-chunks",
            "chunks", "commit", "veiled-commit", "raw-chunk", "packed-chunk", "coded-chunk"});
}

TEST_CASE("a list of chunks has the bytes of the protocol page", "[protocol][golden]") {
  RunBuilder builder(Extent::cube(kEdge), AxisOrder::yxz);
  builder.append_to(3, 1);
  builder.append_to(200, 0);
  builder.append_to(4096, 300);
  const RunChunk voxels = builder.finish();
  const ChunkSnapshot snapshot{{0, {1, -2, 2}}, {voxels, {3, 500}, digest_of(voxels)}};
  ChunkEdits edits{{0, {1, -2, 3}}, 480, {3, 500}, kDigest, {}};
  edits.edits.push_back({499, {SetVoxel{{17, -31, 50}}, {}, 300}});
  edits.edits.push_back({500, {FillSphere{{20, -30, 50}, 3}, {MaskKind::only_solid, 0}, 7}});
  const std::vector<ChunkEntry> entries = {
      encode_snapshot(snapshot.key, snapshot.chunk, ChunkEncoding::raw), encode_chunk_edits(edits)};
  const std::string bytes = page_example("chunks");
  CHECK(to_hex(list_of(entries)) == bytes);
  check_read(decode_answers(from_hex(bytes), 0, kEdge, kEdge),
             std::vector<ChunkAnswer>{snapshot, edits});
}

TEST_CASE("uniform chunks have the bytes of the protocol page", "[protocol][golden]") {
  const std::vector<UniformChunk> chunks = {
      {{0, {1, -2, 3}}, 0, {}}, {{0, {1, -2, 4}}, 0, {}}, {{0, {2, 5, 3}}, 7, {3, 500}}};
  const std::string bytes = page_example("uniform-chunks");
  CHECK(to_hex(encode_uniform(chunks)) == bytes);
  check_read(decode_uniform(from_hex(bytes), 0, kEdge), chunks);
}

TEST_CASE("cached and unmodified chunks have the bytes of the protocol page",
          "[protocol][golden]") {
  const std::vector<CachedChunk> cached = {{{0, {-3, 0, 7}}, {}, 0x0123456789abcdefULL},
                                           {{0, {1, -2, 3}}, {3, 500}, 1},
                                           {{0, {1, -2, 4}}, {2, 70}, 0}};
  const std::string cached_bytes = page_example("cached-chunks");
  CHECK(to_hex(encode_cached_chunks(cached)) == cached_bytes);
  check_read(decode_cached_chunks(from_hex(cached_bytes), 0, kEdge), cached);

  const std::vector<UnmodifiedChunk> unmodified = {
      {{0, {-3, 0, 7}}, 0}, {{0, {1, -2, 3}}, 500}, {{0, {1, -2, 4}}, 70}};
  const std::string unmodified_bytes = page_example("chunks-not-modified");
  CHECK(to_hex(encode_unmodified(unmodified)) == unmodified_bytes);
  check_read(decode_unmodified(from_hex(unmodified_bytes), 0, kEdge), unmodified);
}

TEST_CASE("lists of keys and of digests have the bytes of the protocol page",
          "[protocol][golden]") {
  const std::vector<ChunkKey> keys = {{0, {-3, 0, 7}}, {0, {1, -2, 3}}, {0, {1, -2, 4}}};
  const std::string key_bytes = page_example("chunk-keys");
  CHECK(to_hex(encode_keys(keys)) == key_bytes);
  check_read(decode_keys(from_hex(key_bytes), 3, kEdge), keys);

  const std::vector<DigestCheckEntry> entries = {{{0, {1, -2, 3}}, {3, 500}, kDigest},
                                                 {{0, {1, -2, 4}}, {}, {}}};
  const std::string digest_bytes = page_example("digest-check");
  CHECK(to_hex(encode_digest_checks(entries)) == digest_bytes);
  check_read(decode_digest_checks(from_hex(digest_bytes), kEdge), entries);
}

TEST_CASE("the edits of a commit have the bytes of the protocol page", "[protocol][golden]") {
  Commit commit;
  commit.epoch = 3;
  commit.edits.push_back({500,
                          {2, 0x1122334455667788ULL, 9},
                          Cause::player,
                          1'700'000,
                          1'700'250,
                          {SetVoxel{{1, -2, 3}}, {}, 300},
                          {499},
                          0});
  commit.edits.push_back({503,
                          {0, 0, 0},
                          Cause::rollback,
                          1'700'250,
                          1'700'250,
                          {FillSphere{{16, 8, 8}, 3}, {MaskKind::only_solid, 0}, 7},
                          {0, 370},
                          480});
  const std::string hex = page_example("commit");
  const CommitEncoder encoder(commit);
  CHECK(to_hex(encoder.list(encoder.all())) == hex);
  const Bytes bytes = from_hex(hex);
  OrderedEditReader reader(bytes, kEdge);
  OrderedEdit edit;
  std::vector<ChunkCoord> touched;
  for (std::size_t i = 0; i < commit.edits.size(); ++i) {
    REQUIRE(reader.next(edit, touched).has_value());
    CHECK(edit == commit.edits[i]);
  }
  CHECK(touched == std::vector<ChunkCoord>{{0, 0, 0}, {1, 0, 0}});
  CHECK(reader.at_end());
}

TEST_CASE("a veiled commit has the bytes of the protocol page", "[protocol][veil][golden]") {
  VeiledCommit commit{3, {{}, {}}};
  VeiledEdit& seen = commit.edits[0];
  seen.ordered = {500,       {2, 0x1122334455667788, 9},      Cause::player, 1'700'000,
                  1'700'250, {SetVoxel{{1, -2, 3}}, {}, 300}, {499},         0};
  seen.has_edit = true;
  seen.patches = {{{0, -1, 0}, 500, {Extent::cube(kEdge), kVeilOrder, {{5, 1, 7}}}}};
  VeiledEdit& hidden = commit.edits[1];
  hidden.ordered.seq = 501;
  hidden.ordered.op = {2, 0x1122334455667788, 10};
  hidden.ordered.submitted_us = hidden.ordered.ordered_us = 1'700'250;
  const std::string hex = page_example("veiled-commit");
  const CommitEncoder encoder(commit);
  CHECK(to_hex(encoder.list(encoder.all())) == hex);
  const Bytes bytes = from_hex(hex);
  OrderedEditReader reader(bytes, kEdge);
  std::vector<ChunkCoord> touched;
  for (const VeiledEdit& expected : commit.edits) {
    VeiledEdit edit;
    REQUIRE(reader.next(edit, touched).has_value());
    CHECK(edit == expected);
  }
  CHECK(reader.at_end());
}

}  // namespace runstone::test
