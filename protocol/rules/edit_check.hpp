// Edit check: decides whether an edit may be ordered. The server decides by it; a client calls it
// before it shows and sends an edit, so that both give the same answer. No check visits the voxels
// of the geometry, so an oversized edit costs little.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/edits/descriptor/height_limits.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

struct EditLimits {
  std::int32_t chunk_edge = 32;
  std::size_t material_count = 1;        // ids below it are known
  HeightLimits heights;                  // for every voxel of the geometry
  std::uint64_t volume_max = 1'000'000;  // voxels of the geometry
  std::uint64_t touched_chunks_max = kTouchedChunksMax;
};

/// Checks a player's edit, which must have voxels. Returns nullopt if it is allowed, otherwise the
/// first reason of: bad_edit, unknown_material (the materials of mask and clipboard included),
/// outside_world, too_large.
std::optional<RejectReason> check_edit(const EditDescriptor& edit, const EditLimits& limits);

/// Returns words for the player about a reason of check_edit(): they name the limit, its value, and
/// what to do. They are empty for a reason that has none.
std::string refusal_words(RejectReason reason, const EditDescriptor& edit,
                          const EditLimits& limits);

/// Checks an edit that the server makes: to restore voxels, to change rights or to add materials.
/// The limits of height and volume do not apply, because they may have been wider when the voxels
/// were edited. The limit of touched chunks applies.
std::optional<RejectReason> check_server_edit(const EditDescriptor& edit, const EditLimits& limits);

/// Returns true if every voxel of the geometry's bounding box is at most `reach` voxels away:
/// measured from `from` to the centre of the farthest voxel.
bool within_reach(const EditDescriptor& edit, const WorldPos& from, double reach);

}  // namespace runstone
