// Preview list: the bytes of the edits in a preview message. Internal to the codec.
#pragma once
#include <vector>

#include "common/core/bytes.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "protocol/limits.hpp"

namespace runstone {

/// The longest list: the descriptors and their lengths.
inline constexpr std::size_t kPreviewListBytesMax = kPreviewBytesMax + 2 * kPreviewEditsMax;
static_assert(kPreviewBytesMax < 1 << 14, "a length is a varint of at most two bytes");
static_assert(kPreviewListBytesMax + kPreviewStrokeBytesMax + 64 <= kClientControlBytesMax,
              "every list and every stroke fit their message");

/// Returns the list: of each edit a varint with the length of its descriptor, and the descriptor.
/// Requires valid edits.
Bytes encode_preview(const std::vector<EditDescriptor>& edits);

}  // namespace runstone
