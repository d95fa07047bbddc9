// Clipboard copies: many copies of the clipboard as one action.
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "client/tools/tool.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// The copies of one action, at most.
inline constexpr std::size_t kCopiesMax = 1024;

struct CopySpot {
  VoxelPos middle;            // of the lowest layer
  std::uint8_t quarters = 0;  // quarter turns, 0 .. 3
};

/// Fails with words for the player if there is no clipboard, or if it is too large for many copies.
Result<void, std::string> check_copied(const ToolClipboard& clipboard);

/// Returns the pastes of the copies, in order, which change no voxel where a copy is empty. Copies
/// that reach outside the world are left out. Fails with words for the player if none is left, or
/// if a turned clipboard takes too much memory. Requires check_copied().
ToolEdits copies_of_clipboard(const ToolInput& input, std::span<const CopySpot> spots, Mask mask);

}  // namespace runstone
