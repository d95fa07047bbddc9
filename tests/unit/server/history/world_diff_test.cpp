// The differences between two moments and their authors, against a count voxel by voxel.
#include "server/history/world_diff.hpp"

#include <catch2/catch.hpp>
#include <map>

#include "tests/support/core/temp_folder.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

struct Counted {
  std::map<AuthorId, std::uint64_t> voxels, edits;
  std::map<ChunkKey, std::uint64_t> chunks;
  std::uint64_t sum = 0;
};

/// Counts by a walk over every voxel of every chunk that an edit may touch: the author of the last
/// change, if it differs.
Counted count_densely(const std::vector<EditRecord>& records, const Generator& generator,
                      Sequence from, Sequence to) {
  Counted counted;
  std::set<ChunkKey> keys;
  for (Sequence i = from; i < to; ++i) {
    ++counted.edits[records[i].op.author];
    for (const ChunkCoord& at : touched_chunks(records[i].edit, kSampleEdge)) keys.insert({0, at});
  }
  for (const ChunkKey& key : keys) {
    const VoxelPos origin = origin_of(key.at, kSampleEdge);
    DenseChunk chunk = DenseChunk::of(generator.generate(origin, Extent::cube(kSampleEdge)));
    for (Sequence i = 0; i < from; ++i) oracle_apply(chunk, origin, {&records[i].edit, 1});
    const DenseChunk before = chunk;
    std::vector<AuthorId> last(16 * 16 * 16, 0);
    for (Sequence i = from; i < to; ++i) {
      const DenseChunk previous = chunk;
      oracle_apply(chunk, origin, {&records[i].edit, 1});
      for (int v = 0; v < 16 * 16 * 16; ++v) {
        const int x = v % 16, y = v / 16 % 16, z = v / 256;
        if (chunk.at(x, y, z) != previous.at(x, y, z))
          last[static_cast<std::size_t>(v)] = records[i].op.author;
      }
    }
    for (int v = 0; v < 16 * 16 * 16; ++v) {
      const int x = v % 16, y = v / 16 % 16, z = v / 256;
      if (chunk.at(x, y, z) == before.at(x, y, z)) continue;
      ++counted.voxels[last[static_cast<std::size_t>(v)]];
      ++counted.chunks[key];
      ++counted.sum;
    }
  }
  return counted;
}

}  // namespace

TEST_CASE("a difference of two moments is that of their voxels, each with its last writer",
          "[history][diff]") {
  SplitMix64 rng(GENERATE(1U, 2U));
  const TempFolder folder;
  WorldMeta meta = sample_meta();
  meta.generator.name = "flat";
  auto store = *create_world(folder.path(), meta);
  const auto generator = *make_generator(meta.generator, meta.materials);
  REQUIRE(store->raise_epoch().has_value());
  auto records = sample_records(rng, 1, 1, 60);
  for (EditRecord& record : records) {
    do {
      record.edit = random_edit_near(rng, {}, Extent::cube(kSampleEdge));
    } while (touched_chunks(record.edit, kSampleEdge).size() > 4);
    record.op.author = rng.below(5);
  }
  // Two authors change a voxel in turn. The last change counts, not the last edit that touched the
  // voxel.
  const auto last_five = std::span(records).last(5);
  for (std::size_t i = 0; i < 5; ++i) {
    last_five[i].edit = {FillBox{{{0, 0, 0}, {8, 8, 8}}}, {}, static_cast<Material>(i < 3 ? i : 2)};
    last_five[i].op.author = static_cast<AuthorId>(10 + i);
  }
  REQUIRE(store->append({}, records).has_value());
  for (const auto& [from, to] :
       {std::pair<Sequence, Sequence>{0, 60}, {0, 30}, {25, 60}, {55, 60}, {20, 21}, {40, 40}}) {
    CAPTURE(from, to);
    const Counted counted = count_densely(records, *generator, from, to);
    const auto diff = diff_world(*store, *generator, from, to);
    if (!diff) FAIL(diff.error().message());
    CHECK(diff->from == from);
    CHECK(diff->to == to);
    CHECK(diff->edits == to - from);
    CHECK(diff->voxels == counted.sum);
    std::map<ChunkKey, std::uint64_t> chunks;
    for (const auto& part : diff->chunks) chunks[part.key] = part.voxels;
    CHECK(chunks == counted.chunks);
    CHECK(std::is_sorted(diff->chunks.begin(), diff->chunks.end(),
                         [](const auto& a, const auto& b) { return a.voxels > b.voxels; }));
    std::map<AuthorId, std::uint64_t> voxels, edits;
    for (const auto& part : diff->authors) {
      edits[part.author] = part.edits;
      if (part.voxels > 0) voxels[part.author] = part.voxels;
    }
    CHECK(voxels == counted.voxels);
    CHECK(edits == counted.edits);
    CHECK(voxels.count(13) + voxels.count(14) == 0);  // they changed nothing
  }
  CHECK(diff_world(*store, *generator, 3, 2).error().what == "seq=3 is behind seq=2");
  CHECK(diff_world(*store, *generator, 3, 61).error().what == "ends at seq=60");
  CHECK(diff_world(*store, *generator, 0, 60, [](Sequence, Sequence) { return false; })
            .error()
            .kind == StoreError::Kind::cancelled);
}
