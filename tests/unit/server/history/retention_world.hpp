// A small world for tests of retention: an hour between two edits, changes of rights and new
// materials among them, snapshots up to the end, and keyframes.
#pragma once
#include <catch2/catch.hpp>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "server/history/keyframe_maker.hpp"
#include "server/history/world_at.hpp"
#include "server/store/sqlite_backend.hpp"
#include "server/store/world_folder.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {

inline constexpr Sequence kRetentionEdits = 120;
inline constexpr TimeUs kRetentionHour = 3'600'000'000, kRetentionStart = 1'700'000'000'000'000;
/// The time of an edit of the world.
inline TimeUs retention_time(Sequence seq) {
  return kRetentionStart + static_cast<TimeUs>(seq) * kRetentionHour;
}

using MomentChunks = std::map<ChunkKey, Chunk>;

inline std::unique_ptr<Store> opened_retention_world(const std::string& folder, StoreAccess access,
                                                     const SqliteOptions& options = {}) {
  auto store = open_sqlite_world(folder, access, options);
  if (!store) FAIL(store.error().message());
  return *std::move(store);
}

inline std::unique_ptr<Generator> retention_generator(const Store& store) {
  return *make_generator(store.meta().generator, store.meta().materials);
}

/// Returns all edited chunks of a moment.
inline MomentChunks moment_chunks(Store& store, Sequence at) {
  const auto generator = retention_generator(store);
  auto world = WorldAt::open(store, *generator, at);
  if (!world) FAIL(world.error().message());
  MomentChunks chunks;
  for (const ChunkKey& key : world->edited()) {
    auto chunk = world->chunk(key);
    if (!chunk) FAIL(chunk.error().message());
    chunks.emplace(key, *std::move(chunk));
  }
  return chunks;
}

/// Returns the records of the world. Edit 15 adds a material, and every 17th changes rights.
inline std::vector<EditRecord> retention_records(SplitMix64& rng, const MaterialTable& materials,
                                                 Epoch epoch, Sequence first, std::size_t count) {
  auto records = sample_records(rng, epoch, first, count);
  for (EditRecord& record : records) {
    const Sequence seq = record.version.seq;
    record.time_us = retention_time(seq);
    if (record.cause == Cause::player) record.subject = 0;
    if (seq == 15) {
      AddedMaterials added{static_cast<Material>(materials.size()), {}};
      added.rows.push_back({"lime", {1, 2, 3, 255}, Visibility::opaque});
      record.cause = Cause::materials;
      record.edit = materials_edit(std::move(added));
    } else if (seq % 17 == 0) {
      record.cause = Cause::rights;
      record.edit = sample_rights_edit(rng);
    } else {
      do {
        record.edit = random_edit_near(rng, {}, Extent::cube(kSampleEdge));
      } while (touched_chunks(record.edit, kSampleEdge).size() > 4);
      continue;
    }
    record.subject = 0;
  }
  return records;
}

inline void make_keyframe_at(Store& store, Sequence at) {
  const auto generator = retention_generator(store);
  KeyframeMaker maker(store, *generator, {});
  const auto made = maker.make_at(
      at, [&](const KeyframeMaker::Chunks& chunks, const std::optional<Keyframe>& keyframe) {
        return store.save_keyframe(chunks, keyframe);
      });
  if (!made) FAIL(made.error().message());
}

/// Makes a closed world of kRetentionEdits edits, with a snapshot of each chunk and the checkpoint
/// at the end.
inline void make_retention_world(const std::string& folder, SplitMix64& rng,
                                 const std::vector<Sequence>& keyframes,
                                 const SqliteOptions& options = {}) {
  WorldMeta meta = sample_meta();
  meta.generator.name = "flat";
  auto created = create_sqlite_world(folder, meta, options);
  REQUIRE(created.has_value());
  Store& store = **created;
  REQUIRE(store.raise_epoch().has_value());
  const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
  const auto records = retention_records(rng, meta.materials, 1, 1, kRetentionEdits);
  REQUIRE(store.append(players, records).has_value());
  for (const Sequence at : keyframes) make_keyframe_at(store, at);
  std::vector<std::pair<ChunkKey, ChunkPtr>> snapshots;
  for (const auto& [key, chunk] : moment_chunks(store, kRetentionEdits))
    snapshots.emplace_back(key, std::make_shared<const Chunk>(chunk));
  REQUIRE(store.save_snapshots(snapshots, kRetentionEdits).has_value());
}

}  // namespace runstone::test
