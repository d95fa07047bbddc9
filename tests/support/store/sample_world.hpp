// A small world for tests of store, log writer, replay and server: meta, records and chunks that
// differ in every field, from a seed.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/core/hash.hpp"
#include "common/edits/descriptor/edit_record.hpp"
#include "common/runs/chunk.hpp"
#include "server/store/store.hpp"
#include "tests/support/core/random_look.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {

inline constexpr std::uint16_t kSampleEdge = 16;

inline WorldMeta sample_meta() {
  WorldMeta meta;
  for (std::size_t i = 0; i < meta.world_id.size(); ++i)
    meta.world_id[i] = static_cast<std::uint8_t>(i + 1);
  for (std::size_t i = 0; i < meta.server_key_seed.size(); ++i) {
    meta.server_key_seed[i] = static_cast<std::uint8_t>(200 - i);
  }
  meta.chunk_edge = kSampleEdge;
  // The seed is beyond the signed range of a database integer.
  meta.generator = {"empty", 1, 0x9000000000000001ULL, ""};
  meta.materials = default_material_table();
  meta.spawn = {0.5, 70.25, -3.0};
  return meta;
}

inline PlayerRow sample_player(AuthorId author) {
  PlayerRow row{author, {}, "builder " + std::to_string(author)};
  for (std::size_t i = 0; i < row.key.size(); ++i)
    row.key[i] = static_cast<std::uint8_t>(author * 31 + i);
  return row;
}

/// Returns an edit near the origin: voxels, boxes, strokes, spheres and pastes, some masked, so
/// that edits overlap and depend on order.
inline EditDescriptor sample_edit(SplitMix64& rng) {
  EditDescriptor edit;
  const VoxelPos at{rng.between(-40, 40), rng.between(-20, 40), rng.between(-40, 40)};
  switch (rng.below(5)) {
    case 0:
      edit.shape = SetVoxel{at};
      break;
    case 3:
      edit.shape = Paste{at, random_clipboard(rng, 20, 5), random_orientation(rng)};
      break;
    case 1: {
      const VoxelPos max{at.x + rng.between(1, 20), at.y + rng.between(1, 20),
                         at.z + rng.between(1, 20)};
      edit.shape = FillBox{{at, max}};
      break;
    }
    case 2:
      edit.shape = random_stroke(rng, at);
      break;
    default:
      edit.shape = FillSphere{at, static_cast<std::uint16_t>(rng.below(12))};
      break;
  }
  edit.mask.kind = static_cast<MaskKind>(rng.below(4));
  if (edit.mask.kind == MaskKind::only_material)
    edit.mask.material = static_cast<Material>(1 + rng.below(4));
  if (!std::holds_alternative<Paste>(edit.shape))
    edit.material = static_cast<Material>(rng.below(5));
  return edit;
}

/// Returns a change of rights, with and without a place.
inline EditDescriptor sample_rights_edit(SplitMix64& rng) {
  const PublicKey key = sample_player(static_cast<AuthorId>(1 + rng.below(2))).key;
  if (rng.below(2) == 0) return rights_edit(GrantRole{key, kModeratorRole});
  ProtectedBox box;
  box.name = "box" + std::to_string(rng.below(4));
  const VoxelPos at{rng.between(-40, 40), rng.between(-20, 40), rng.between(-40, 40)};
  box.box = {at, {at.x + 10, at.y + 20, at.z + 30}};
  box.owner = key;
  return rights_edit(Protect{std::move(box)});
}

/// Returns materials with random names, and with ids that need not be the next ones of a world.
inline EditDescriptor sample_materials_edit(SplitMix64& rng) {
  AddedMaterials added;
  added.first = static_cast<Material>(1 + rng.below(1000));
  for (std::uint32_t i = 0; i <= rng.below(3); ++i) {
    MaterialRow row{"m" + std::to_string(i) + "_" + std::to_string(rng.below(100)), {}, {}};
    row.visibility = static_cast<Visibility>(rng.below(3));
    for (std::uint8_t& channel : row.colour) channel = static_cast<std::uint8_t>(rng.next());
    if (row.visibility == Visibility::opaque) row.colour[3] = 255;
    if (rng.below(2) == 0) row.look = random_look(rng);
    added.rows.push_back(row);
  }
  return materials_edit(std::move(added));
}

/// The number of causes whose edits have voxels: 0 .. kVoxelCauses - 1.
inline constexpr auto kVoxelCauses = static_cast<std::uint32_t>(Cause::rights);

/// Returns record `seq` of two players with two client processes each. Client sequences and times
/// rise with `seq`.
inline EditRecord sample_record(SplitMix64& rng, Epoch epoch, Sequence seq) {
  EditRecord record;
  record.version = {epoch, seq};
  const auto author = static_cast<AuthorId>(1 + rng.below(2));
  record.op = {author, 0xf000000000000000ULL + rng.below(2), seq};
  record.time_us = 1'700'000'000'000'000 + static_cast<TimeUs>(seq) * 1000;
  record.cause = static_cast<Cause>(rng.below(kVoxelCauses));
  record.edit = sample_edit(rng);
  if (record.cause == Cause::rollback || record.cause == Cause::undo ||
      record.cause == Cause::redo) {
    record.subject = seq / 2;
  }
  return record;
}

inline std::vector<EditRecord> sample_records(SplitMix64& rng, Epoch epoch, Sequence first,
                                              std::size_t count) {
  std::vector<EditRecord> records;
  for (std::size_t i = 0; i < count; ++i) records.push_back(sample_record(rng, epoch, first + i));
  return records;
}

inline ChunkPtr sample_chunk(SplitMix64& rng, Version version) {
  Chunk chunk;
  chunk.voxels = random_chunk(rng, Extent::cube(kSampleEdge), random_order(rng), 5);
  chunk.version = version;
  chunk.digest = digest_of(chunk.voxels);
  return std::make_shared<const Chunk>(std::move(chunk));
}

}  // namespace runstone::test
