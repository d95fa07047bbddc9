// Edit check: whether an edit may enter the order at all. Bounds come first that cost O(1), so that an
// oversized edit costs nothing.
#pragma once
#include <cstdint>
#include <optional>

#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/edits/descriptor/height_limits.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

struct EditLimits {
  std::int32_t chunk_edge = 32;
  std::size_t material_count = 1;        // ids below are known
  HeightLimits heights;                  // of every voxel of the geometry
  std::uint64_t volume_max = 1'000'000;  // voxels of the geometry
  std::uint64_t touched_chunks_max = kTouchedChunksMax;
};

/// Nothing if the edit is allowed; else why not: bad_edit, unknown_material (the mask's and a clipboard's
/// too), outside_world or too_large.
std::optional<RejectReason> check_edit(const EditDescriptor& edit, const EditLimits& limits);

/// The same for the server's own edits, which put back what was there before: neither heights nor volume limit
/// them, for both may have been wider once. What a commit can carry still does.
std::optional<RejectReason> check_server_edit(const EditDescriptor& edit, const EditLimits& limits);

/// What an edit costs of its session's rate: a token for each chunk that it may touch, kTouchedChunksMax at most, and for a
/// clipboard one more per KiB that it has begun.
std::uint64_t edit_tokens(const EditDescriptor& edit, std::uint16_t chunk_edge);

/// Whether the geometry's bounding box comes within `reach` voxels of `from`.
bool within_reach(const EditDescriptor& edit, const WorldPos& from, double reach);

}  // namespace runstone
