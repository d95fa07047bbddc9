// Preview messages: what a player is about to do, for the others to see. They are no part of the
// world: they are in no log, and nothing depends on them.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "common/core/ids.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "protocol/codec/brush_stroke.hpp"

namespace runstone {

/// The edits that the sender's next click would make. 0 .. kPreviewEditsMax edits with voxels, with
/// kPreviewBytesMax bytes together; none: nothing is previewed any more.
struct PreviewShare {
  std::vector<EditDescriptor> edits;
  /// The stroke of a brush that the next click would make (feature bit 30). The edits are then a
  /// line with a width along it, for clients that cannot work out the stroke. With a stroke there
  /// is at least one edit.
  std::optional<BrushStroke> stroke = std::nullopt;
  friend bool operator==(const PreviewShare&, const PreviewShare&) = default;
};

/// The edits that the next click of another player would make.
struct PlayerPreview {
  AuthorId author = 0;
  std::vector<EditDescriptor> edits;
  std::optional<BrushStroke> stroke = std::nullopt;
  friend bool operator==(const PlayerPreview&, const PlayerPreview&) = default;
};

/// Returns true if showing the preview of an edit costs its viewers little: it touches at most
/// kPreviewChunksMax chunks, and a paste that is turned has at most kPreviewTurnedVoxelsMax voxels.
/// Requires a valid edit. Cost: O(1).
bool is_light_preview(const EditDescriptor& edit, std::int32_t chunk_edge);

/// Returns true if these edits may be shared: few, short, and each touches few chunks. Cost: that
/// of encoding them.
bool may_be_shared(const std::vector<EditDescriptor>& edits, std::int32_t chunk_edge);

}  // namespace runstone
