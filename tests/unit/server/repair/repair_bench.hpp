// RepairBench: a world of three authors with snapshots, a keyframe and a change of rights, its
// damage, and its repair.
#pragma once
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "server/history/keyframe_maker.hpp"
#include "server/history/world_at.hpp"
#include "server/repair/repair_program.hpp"
#include "server/store/store.hpp"
#include "server/store/world_folder.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {

inline constexpr TimeUs kRepairTimeUs = 1'795'000'000'000'000;  // 2026-11-18
inline constexpr Sequence kRepairEdits = 300, kRepairCheckpoint = 200, kRepairBackup = 150;

/// The voxels of a world: the digest of each edited chunk.
using ChunkDigests = std::map<ChunkKey, Digest>;

class RepairBench {
 public:
  /// Makes the world, and a copy of it as it was after kRepairBackup edits. `compacted` edits are
  /// in the base. If `is_open`, the copy that is repaired was made while a program wrote the world:
  /// its newest edits are in the write-ahead log alone.
  explicit RepairBench(std::uint64_t seed = 1, Sequence compacted = 0, bool is_open = false) {
    SplitMix64 rng(seed);
    auto made = create_world(source_, sample_meta());
    REQUIRE(made.has_value());
    std::unique_ptr<Store> store = *std::move(made);
    generator_ = *generator_of(*store);
    REQUIRE(store->raise_epoch().has_value());
    std::vector<PlayerRow> players = {sample_player(1), sample_player(2), sample_player(3)};
    for (Sequence seq = 1; seq <= kRepairEdits; ++seq) {
      EditRecord record = sample_record(rng, store->epoch(), seq);
      record.op.author = static_cast<AuthorId>(1 + rng.below(3));
      if (seq == 40) {
        record.cause = Cause::rights;
        record.subject = 0;
        record.edit = rights_edit(GrantRole{players_key(1), kModeratorRole});
      } else if (seq == 60) {
        record.cause = Cause::materials;
        record.subject = 0;
        MaterialRow row{"bench stone", {9, 9, 9, 255}, {}};
        row.visibility = Visibility::opaque;
        record.edit = materials_edit(
            {static_cast<Material>(sample_meta().materials.size()), {std::move(row)}});
      } else if (seq == 70) {
        record.edit = {
            SetVoxel{{0, 0, 0}}, {}, static_cast<Material>(sample_meta().materials.size())};
      }
      REQUIRE(store->append(players, std::vector{record}).has_value());
      players.clear();
      if (seq == kRepairBackup) {
        compact(*store, compacted);
        copy_world(backup);
      }
      if (seq == kRepairCheckpoint) save_snapshots(*store, seq);
    }
    records = records_of(*store);
    digests_ = digests_of(*store);
    if (is_open) copy_world(world);
    store.reset();
    if (!is_open) copy_world(world);
  }

  std::string world_file() const { return world + "/world.sqlite"; }
  /// Returns the error, or an empty string. What the program printed is then in `printed`.
  std::string repair_to(const std::string& place, const std::string& from = "",
                        bool in_place = false) {
    std::ostringstream out;
    const auto done = repair({world, place, from, in_place, false}, kRepairTimeUs, out);
    printed = out.str();
    return done ? "" : done.error();
  }
  static std::unique_ptr<Store> opened(const std::string& folder) {
    auto opened = open_world(folder, StoreAccess::read_only);
    if (!opened) FAIL(opened.error().message());
    return *std::move(opened);
  }
  static std::map<Sequence, EditRecord> records_of(Store& store) {
    std::map<Sequence, EditRecord> out;
    const auto read = store.read_log(1, kSequenceMax, [&](const EditRecord& record) {
      out.emplace(record.version.seq, record);
      return true;
    });
    REQUIRE(read.has_value());
    return out;
  }
  /// Returns true if a world shows the same voxels as the undamaged one.
  bool has_same_ground(Store& store) const {
    auto end = WorldAt::open(store, *generator_, *store.last_sequence());
    REQUIRE(end.has_value());
    return std::ranges::all_of(digests_, [&](const auto& row) {
      const auto chunk = end->chunk(row.first);
      return chunk && chunk->digest == row.second;
    });
  }
  /// Overwrites bytes of a file.
  static void overwrite(const std::string& file, std::uint64_t at, const std::string& bytes) {
    std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
    stream.seekp(static_cast<std::streamoff>(at));
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  static void flip_bit(const std::string& file, std::uint64_t bit) {
    std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
    stream.seekg(static_cast<std::streamoff>(bit / 8));
    const int byte = stream.get();
    stream.seekp(static_cast<std::streamoff>(bit / 8));
    stream.put(static_cast<char>(byte ^ (1 << bit % 8)));
  }

  TempFolder folder;
  const std::string world = folder / "world", to = folder / "new", backup = folder / "backup";
  std::map<Sequence, EditRecord> records;  // of the undamaged world
  std::string printed;

 private:
  ChunkDigests digests_of(Store& store) const {
    auto end = WorldAt::open(store, *generator_, *store.last_sequence());
    REQUIRE(end.has_value());
    ChunkDigests out;
    for (const ChunkKey& key : end->edited()) out[key] = end->chunk(key)->digest;
    return out;
  }
  static PublicKey players_key(AuthorId author) { return sample_player(author).key; }
  void copy_world(const std::string& target) const {
    std::filesystem::create_directory(target);
    for (const char* name : {"world.sqlite", "world.sqlite-wal", "world.durable"}) {
      std::error_code ignored;  // a closed world has no write-ahead log
      std::filesystem::copy_file(source_ + "/" + name, target + "/" + name, ignored);
    }
  }
  void compact(Store& store, Sequence at) const {
    if (at == 0) return;
    KeyframeMaker maker(store, *generator_, {});
    const auto made =
        maker.make_at(at, [&](const auto& chunks, const std::optional<Keyframe>& keyframe) {
          return store.save_keyframe(chunks, keyframe);
        });
    REQUIRE(made.has_value());
    REQUIRE(store.compact(at).has_value());
  }
  void save_snapshots(Store& store, Sequence at) const {
    auto past = WorldAt::open(store, *generator_, at);
    REQUIRE(past.has_value());
    std::vector<std::pair<ChunkKey, ChunkPtr>> chunks;
    for (const ChunkKey& key : past->edited())
      chunks.emplace_back(key, std::make_shared<const Chunk>(*past->chunk(key)));
    REQUIRE(store.save_snapshots(chunks, at).has_value());
  }

  const std::string source_ = folder / "source";
  std::unique_ptr<Generator> generator_;
  ChunkDigests digests_;  // of the undamaged world
};

}  // namespace runstone::test
