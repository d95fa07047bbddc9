// Keyframes: they are made where they are due, they change no moment, and damage in them is
// detected.
#include <catch2/catch.hpp>
#include <filesystem>
#include <set>

#include "server/history/keyframe_maker.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

constexpr Sequence kLoggedEdits = 400;
constexpr KeyframePolicy kPolicy{40, 3};

/// Returns a random edit near the chunk at the origin. It touches few chunks, so that keyframes
/// become due.
EditDescriptor small_edit(SplitMix64& rng) {
  for (;;) {
    const EditDescriptor edit = random_edit_near(rng, {}, Extent::cube(kSampleEdge));
    if (touched_chunks(edit, kSampleEdge).size() <= 4) return edit;
  }
}

/// A world of `count` edits around one chunk, in epochs 1 and 2.
struct Logged {
  TempFolder folder;
  std::vector<EditRecord> records;
  std::unique_ptr<Store> store;
  std::unique_ptr<Generator> generator;

  explicit Logged(std::uint64_t seed, Sequence count = kLoggedEdits) {
    SplitMix64 rng(seed);
    WorldMeta meta = sample_meta();
    meta.generator.name = "flat";
    store = *create_world(folder.path(), meta);
    generator = *make_generator(meta.generator, meta.materials);
    records = sample_records(rng, 1, 1, count);
    for (EditRecord& record : records) {
      record.edit = small_edit(rng);
      if (record.version.seq > 100) record.version.epoch = 2;
    }
    REQUIRE(store->append_history({}, records).has_value());
  }

  KeyframeMaker::Save save() {
    return [this](const KeyframeMaker::Chunks& chunks, const std::optional<Keyframe>& keyframe) {
      return store->save_keyframe(chunks, keyframe);
    };
  }
  void make_keyframes() {
    KeyframeMaker maker(*store, *generator, kPolicy);
    const auto made = maker.make_due(save());
    if (!made) FAIL(made.error().message());
    REQUIRE(maker.made() > 3);
  }
  WorldAt at(Sequence seq) {
    auto world = WorldAt::open(*store, *generator, seq);
    if (!world) FAIL(world.error().message());
    return *std::move(world);
  }
};

/// Returns all edited chunks of a moment.
std::vector<std::pair<ChunkKey, Chunk>> chunks_at(Logged& logged, Sequence seq) {
  WorldAt world = logged.at(seq);
  std::vector<std::pair<ChunkKey, Chunk>> chunks;
  for (const ChunkKey& key : world.edited()) {
    auto chunk = world.chunk(key);
    if (!chunk) FAIL(chunk.error().message());
    REQUIRE(chunk->version == world.version(key));
    chunks.emplace_back(key, *std::move(chunk));
  }
  return chunks;
}

/// Returns the places of keyframes according to the rule of KeyframePolicy.
std::vector<Sequence> due_places(const std::vector<EditRecord>& records,
                                 const KeyframePolicy& policy) {
  std::vector<Sequence> places;
  std::uint64_t edits = 0;
  std::set<ChunkCoord> touched;
  for (const EditRecord& record : records) {
    ++edits;
    for (const ChunkCoord& at : touched_chunks(record.edit, kSampleEdge)) touched.insert(at);
    if (edits < policy.edits_min || edits < policy.edits_per_chunk * touched.size()) continue;
    places.push_back(record.version.seq);
    edits = 0;
    touched.clear();
  }
  return places;
}

std::vector<Sequence> places(Store& store) {
  std::vector<Sequence> found;
  const auto keyframes = store.keyframes();
  if (!keyframes) FAIL(keyframes.error().message());
  for (const Keyframe& keyframe : *keyframes) found.push_back(keyframe.at.version.seq);
  return found;
}

void check(Store& store) {
  const auto checked = store.check();
  if (!checked) FAIL(checked.error().message());
}

}  // namespace

TEST_CASE("keyframes are made where they are due", "[history][keyframe]") {
  Logged logged(1);
  const std::vector<Sequence> due = due_places(logged.records, kPolicy);
  REQUIRE(due.size() > 3);
  CHECK(due.front() > kPolicy.edits_min);  // both conditions of the rule decided a place
  logged.make_keyframes();
  CHECK(places(*logged.store) == due);
  check(*logged.store);
  KeyframeMaker again(*logged.store, *logged.generator, kPolicy);
  REQUIRE(again.make_due(logged.save()).has_value());
  CHECK(again.made() == 0);
  const auto keyframes = *logged.store->keyframes();
  for (const Keyframe& keyframe : keyframes) {
    const EditRecord& record = logged.records[keyframe.at.version.seq - 1];
    CHECK(keyframe.at == LogEnd{record.version, record.time_us});
    Digest digest;
    const auto chunks = chunks_at(logged, keyframe.at.version.seq);
    for (const auto& [key, chunk] : chunks) digest = digest + world_digest_term(key, chunk.digest);
    CHECK(keyframe.chunks == chunks.size());
    CHECK(keyframe.world_digest == digest);
  }
}

TEST_CASE("a log that grows gets the same keyframes as a complete log", "[history][keyframe]") {
  Logged logged(2, 1);
  SplitMix64 rng(3);
  KeyframeMaker maker(*logged.store, *logged.generator, kPolicy);
  for (Sequence next = 2; next < kLoggedEdits; next += 7) {
    auto more = sample_records(rng, 2, next, 7);
    for (EditRecord& record : more) record.edit = small_edit(rng);
    REQUIRE(logged.store->append_history({}, more).has_value());
    logged.records.insert(logged.records.end(), more.begin(), more.end());
    REQUIRE(maker.make_due(logged.save()).has_value());
    const Sequence end = logged.records.size();
    CHECK(maker.read_to() == end);
    CHECK(maker.look_again_at() > end);
    const std::vector<Sequence> made = places(*logged.store);
    const Sequence newest = made.empty() ? 0 : made.back();
    if (end < newest + kPolicy.edits_min)
      CHECK(maker.look_again_at() == newest + kPolicy.edits_min);
    else
      CHECK(maker.look_again_at() <= end + kPolicy.edits_min);
  }
  CHECK(places(*logged.store) == due_places(logged.records, kPolicy));
  CHECK(maker.made() > 3);
  KeyframeMaker none(*logged.store, *logged.generator, {0, 1});
  REQUIRE(none.make_due(logged.save()).has_value());
  CHECK(none.made() == 0);
}

TEST_CASE("a moment is the same with keyframes and without", "[history][keyframe]") {
  Logged logged(4);
  std::map<Sequence, std::vector<std::pair<ChunkKey, Chunk>>> without;
  SplitMix64 rng(5);
  for (int i = 0; i < 12; ++i) {
    const Sequence seq = rng.below(kLoggedEdits + 1);
    without[seq] = chunks_at(logged, seq);
  }
  logged.make_keyframes();
  for (const Sequence seq : places(*logged.store)) CHECK(logged.at(seq).stored_at() == seq);
  const Sequence first = places(*logged.store).front();
  CHECK(logged.at(first - 1).stored_at() == 0);
  CHECK(logged.at(first + 1).stored_at() == first);
  for (const auto& [seq, chunks] : without) {
    CAPTURE(seq);
    CHECK(chunks_at(logged, seq) == chunks);
  }
  WorldAt follower = logged.at(0);  // moves past keyframes without reading them
  REQUIRE(follower.advance(kLoggedEdits).has_value());
  for (const auto& [key, chunk] : chunks_at(logged, kLoggedEdits))
    CHECK(*follower.chunk(key) == chunk);
}

TEST_CASE("an interrupted keyframe does no harm and is made again", "[history][keyframe]") {
  Logged logged(6);
  const auto at_end = chunks_at(logged, kLoggedEdits);
  KeyframeMaker maker(*logged.store, *logged.generator, kPolicy);
  const std::vector<Sequence> due = due_places(logged.records, kPolicy);
  int chunks_left = 13;  // a keyframe has nearly thirty chunks
  KeyframeMaker::Chunks part;
  const auto broken =
      maker.make_due([&](const KeyframeMaker::Chunks& chunks, const std::optional<Keyframe>&) {
        for (const auto& chunk : chunks) {
          if (chunks_left-- > 0) part.push_back(chunk);
        }
        if (auto saved = logged.store->save_keyframe(part, std::nullopt); !saved) return saved;
        return StoreResult<void>(failure(StoreError{StoreError::Kind::full, "w", "", "disk full"}));
      });
  REQUIRE_FALSE(broken.has_value());
  CHECK(broken.error().message() == "w: disk full");
  CHECK(raw_sql(logged.store->file(), "SELECT count(*) FROM keyframe_chunk") == "13");
  CHECK(places(*logged.store).empty());
  check(*logged.store);
  CHECK(chunks_at(logged, kLoggedEdits) == at_end);
  // Rows beside the first keyframe are older than it, or belong to it.
  KeyframeMaker other(*logged.store, *logged.generator, kPolicy);
  REQUIRE(other.make_at(due.front() + 20, logged.save()).has_value());
  check(*logged.store);
  CHECK(chunks_at(logged, kLoggedEdits) == at_end);
  REQUIRE(maker.make_due(logged.save()).has_value());
  CHECK(maker.made() > 2);
  check(*logged.store);
  CHECK(chunks_at(logged, kLoggedEdits) == at_end);
}

TEST_CASE("making keyframes can be cancelled between chunks", "[history][keyframe]") {
  Logged logged(7);
  KeyframeMaker maker(*logged.store, *logged.generator, kPolicy);
  int steps = 0;
  const auto cancelled =
      maker.make_due(logged.save(), [&](Sequence, Sequence) { return ++steps < 40; });
  REQUIRE_FALSE(cancelled.has_value());
  CHECK(cancelled.error().kind == StoreError::Kind::cancelled);
  CHECK(steps == 40);
  REQUIRE(maker.make_due(logged.save()).has_value());
  CHECK(places(*logged.store) == due_places(logged.records, kPolicy));
}

TEST_CASE("a store takes no keyframe that its chunks do not prove", "[history][keyframe]") {
  Logged logged(8);
  const Sequence seq = 120;
  KeyframeMaker::Chunks chunks;
  std::optional<Keyframe> keyframe;
  KeyframeMaker maker(*logged.store, *logged.generator, kPolicy);
  REQUIRE(
      maker
          .make_at(seq,
                   [&](const KeyframeMaker::Chunks& slice, const std::optional<Keyframe>& made) {
                     chunks.insert(chunks.end(), slice.begin(), slice.end());
                     keyframe = made;
                     return StoreResult<void>();
                   })
          .has_value());
  REQUIRE(keyframe);
  const auto refused = [&](const KeyframeMaker::Chunks& rows, Keyframe with) {
    const auto saved = logged.store->save_keyframe(rows, with);
    REQUIRE_FALSE(saved.has_value());
    CHECK(saved.error().kind == StoreError::Kind::bad_request);
    CHECK(raw_sql(logged.store->file(), "SELECT count(*) FROM keyframe_chunk") ==
          "0");  // nothing of it is stored
    return saved.error().where;
  };
  KeyframeMaker::Chunks fewer(chunks.begin() + 1, chunks.end());
  CHECK(refused(fewer, *keyframe) == "keyframe seq=120");
  Keyframe other = *keyframe;
  other.world_digest.lane[1] ^= 1;
  CHECK(refused(chunks, other) == "keyframe seq=120");
  other = *keyframe;
  other.at.time_us += 1;
  CHECK(refused(chunks, other) == "keyframe seq=120");
  other = *keyframe;
  other.at.version.seq = kLoggedEdits + 1;
  CHECK(refused(chunks, other) == "keyframe seq=401");
  Chunk future = *chunks.front().second;
  future.version = {2, kLoggedEdits + 1};
  CHECK(refused({{chunks.front().first, std::make_shared<const Chunk>(future)}}, *keyframe)
            .starts_with("keyframe_chunk chunk="));
  REQUIRE(logged.store->save_keyframe(chunks, keyframe).has_value());
  check(*logged.store);
  // A row that is stored already stays. Another row under its key is damage.
  REQUIRE(logged.store->save_keyframe(chunks, std::nullopt).has_value());
  SplitMix64 rng(9);
  const auto& [key, chunk] = chunks.front();
  const auto differs = logged.store->save_keyframe(
      std::vector<std::pair<ChunkKey, ChunkPtr>>{{key, sample_chunk(rng, chunk->version)}},
      std::nullopt);
  REQUIRE_FALSE(differs.has_value());
  CHECK(differs.error().kind == StoreError::Kind::corrupt);
}

TEST_CASE("the check names damage in keyframes, and no moment contains it",
          "[history][keyframe][damage]") {
  Logged logged(10);
  logged.make_keyframes();
  const Sequence first = places(*logged.store).front();
  const auto at_first = chunks_at(logged, first), at_end = chunks_at(logged, kLoggedEdits);
  logged.store.reset();
  const std::string place = "keyframe seq=" + std::to_string(first);
  struct Damage {
    std::string sql, where;
  };
  const std::string chunk = " WHERE rowid = 5";
  std::vector<Damage> damages = {
      {"DELETE FROM keyframe_chunk" + chunk, place},
      {"UPDATE keyframe_chunk SET x = x + 100" + chunk, ""},
      {"UPDATE keyframe_chunk SET lod = 1" + chunk, ""},
      {"UPDATE keyframe_chunk SET seq = seq + 1" + chunk, ""},
      {"UPDATE keyframe_chunk SET data = substr(data, 2)" + chunk, ""},
      {"UPDATE keyframe SET seq = seq + 1 WHERE seq = " + std::to_string(first),
       "keyframe seq=" + std::to_string(first + 1)}};
  for (const char* column : {"epoch", "digest0", "digest1", "checksum"}) {
    damages.push_back(
        {std::string("UPDATE keyframe_chunk SET ") + column + " = " + column + " + 1" + chunk, ""});
    damages.push_back({std::string("UPDATE keyframe SET ") + column + " = " + column +
                           " + 1 WHERE seq = " + std::to_string(first),
                       place});
  }
  for (const char* column : {"time_us", "chunks"}) {
    damages.push_back({std::string("UPDATE keyframe SET ") + column + " = " + column +
                           " + 1 WHERE seq = " + std::to_string(first),
                       place});
  }
  for (const Damage& damage : damages) {
    CAPTURE(damage.sql);
    const TempFolder copy;
    std::filesystem::copy(logged.folder.path(), copy.path(),
                          std::filesystem::copy_options::recursive |
                              std::filesystem::copy_options::overwrite_existing);
    REQUIRE(raw_sql(copy / "world.sqlite", damage.sql + "; SELECT changes()") == "1");
    auto store = *open_world(copy.path(), StoreAccess::read_only);
    const auto checked = store->check();
    REQUIRE_FALSE(checked.has_value());
    CHECK(checked.error().kind == StoreError::Kind::corrupt);
    const std::string where = checked.error().where;
    CHECK((damage.where.empty() ? where.starts_with("keyframe") : where == damage.where));
    // A moment cannot be opened, or a chunk cannot be read, or all chunks are right.
    bool is_noticed = false;
    for (const auto& [seq, chunks] :
         {std::pair(first, &at_first), std::pair(kLoggedEdits, &at_end)}) {
      auto world = WorldAt::open(*store, *logged.generator, seq);
      if (!world) CHECK(world.error().kind == StoreError::Kind::corrupt);
      is_noticed |= !world;
      for (const auto& [key, expected] : *chunks) {
        if (!world) break;
        const auto read = world->chunk(key);
        is_noticed |= !read;
        if (read) CHECK(*read == expected);
      }
    }
    CHECK(is_noticed);
  }
}
