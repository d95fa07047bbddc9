// The edits from one version of a chunk to another, against a plain walk over all records.
#include "server/history/missing_edits.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

constexpr Sequence kKeptEdits = 200;
constexpr std::size_t kPlenty = std::size_t{1} << 20;

struct Log {
  TempFolder folder;
  std::vector<EditRecord> records;  // record i has sequence i + 1; epoch 2 from the middle on
  std::unique_ptr<Store> store;

  Log() {
    SplitMix64 rng(5);
    store = *create_world(folder.path(), sample_meta());
    records = sample_records(rng, 1, 1, kKeptEdits);
    for (EditRecord& record : records) {
      if (record.version.seq > kKeptEdits / 2) record.version.epoch = 2;
    }
    REQUIRE(store->raise_epoch().has_value());
    REQUIRE(store->raise_epoch().has_value());
    REQUIRE(store->append_history({}, records).has_value());
  }
  /// Returns the records that touch a chunk by geometry.
  std::vector<EditRecord> of(const ChunkKey& key) const {
    std::vector<EditRecord> out;
    for (const EditRecord& record : records) {
      const auto chunks = touched_chunks(record.edit, kSampleEdge);
      if (std::find(chunks.begin(), chunks.end(), key.at) != chunks.end()) out.push_back(record);
    }
    return out;
  }
  std::optional<ChunkEdits> missing(const ChunkKey& key, const Version& newest, const Version& from,
                                    std::size_t bytes_max = kPlenty) {
    Chunk chunk{uniform_chunk(Extent::cube(kSampleEdge), kEmpty), newest, {{7, 8}}};
    auto found = missing_edits(*store, key, chunk, from, bytes_max);
    if (!found) FAIL(found.error().message());
    return *std::move(found);
  }
};

}  // namespace

TEST_CASE("the edits between two versions of a chunk are all that touch it, in order",
          "[history]") {
  Log log;
  std::size_t looked = 0;
  for (const ChunkKey key :
       {ChunkKey{0, {0, 0, 0}}, ChunkKey{0, {-1, 0, 1}}, ChunkKey{0, {1, 1, -1}}}) {
    const auto all = log.of(key);
    REQUIRE(all.size() >= 4);
    const Version newest = all.back().version;
    for (std::size_t kept = 0; kept + 1 < all.size(); ++kept, ++looked) {
      const auto update = log.missing(key, newest, all[kept].version);
      REQUIRE(update.has_value());
      CHECK(update->from == all[kept].version.seq);
      CHECK(update->to == newest);
      CHECK(update->digest == Digest{{7, 8}});
      REQUIRE(update->edits.size() == all.size() - kept - 1);
      for (std::size_t i = 0; i < update->edits.size(); ++i) {
        CHECK(update->edits[i].seq == all[kept + 1 + i].version.seq);
        CHECK(update->edits[i].edit == all[kept + 1 + i].edit);
      }
    }
    const auto from_base = log.missing(key, newest, {});
    REQUIRE(from_base.has_value());
    CHECK(from_base->edits.size() == all.size());
  }
  CHECK(looked > 10);
}

TEST_CASE("a version that is not in the log, or too far behind, gets no edits", "[history]") {
  Log log;
  const ChunkKey key{0, {0, 0, 0}};
  const auto all = log.of(key);
  const Version newest = all.back().version, kept = all[all.size() / 2].version;
  REQUIRE(log.missing(key, newest, kept).has_value());
  CHECK_FALSE(
      log.missing(key, newest, {kept.epoch + 5, kept.seq}).has_value());  // of another epoch
  for (const EditRecord& record : log.records) {  // an edit of the log, but not of this chunk
    const bool is_here = touches(record.edit, box_of(key.at, kSampleEdge));
    if (is_here || record.version.seq >= newest.seq) continue;
    CHECK_FALSE(log.missing(key, newest, record.version).has_value());
  }
  CHECK_FALSE(
      log.missing(key, newest, kept, 4).has_value());  // a snapshot of four bytes is shorter
  // The log ends before the version of the chunk, so a snapshot is the only complete answer.
  CHECK_FALSE(log.missing(key, {newest.epoch, kKeptEdits + 1}, kept).has_value());
}
