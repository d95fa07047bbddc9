// PasteSource: the edits that paste a build of any size, made one after another. Each is a legal
// descriptor, and no two of them touch the same voxel. Together they set exactly the touched cells
// of the build.
//
// A build that fits one descriptor is one paste. A larger one is cut along the borders of the chunks
// of the world, so no chunk is touched by edits that are far apart in the order. The pieces are blocks
// of up to kPasteBlockEdge voxels, or one chunk if that is larger, from below to above. A block with
// more cells or bytes than a descriptor may have is cut further: between chunks, and then inside one.
// A block of one material is a box. One thread. No clock.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "common/builds/build.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone {

inline constexpr std::int32_t kPasteBlockEdge = 64;

/// The limits of one edit.
struct PasteLimits {
  std::int32_t chunk_edge = 32;
  std::uint64_t volume_max = 1'000'000;                  // voxels
  std::size_t clipboard_bytes_max = kClipboardBytesMax;  // at most kClipboardBytesMax
  std::uint64_t chunks_max = 4096;                       // of the bounding box
  friend bool operator==(const PasteLimits&, const PasteLimits&) = default;
};

/// The effect of the empty cells of a build when it is pasted.
enum class EmptyCells : std::uint8_t {
  pasted,   // they clear voxels
  skipped,  // as untouched cells
};

class PasteSource {
 public:
  /// `at` is the corner of the build in the world. Requires a build whose box lies in the world there.
  PasteSource(BuildPtr build, VoxelPos at, Mask mask, EmptyCells empty, const PasteLimits& limits);

  /// Returns the next edit, or nullopt after the last one. Cost: that of cells_in() for a block and of
  /// the runs of its cells, also for the blocks without a touched cell that it skips.
  std::optional<EditDescriptor> next();
  /// Starts again with the first edit.
  void restart();

  /// Returns the box of the build in the world.
  const VoxelBox& box() const { return box_; }
  /// Returns the number of cells of the build, touched or not, and of those that lie before the next
  /// edit. Their quotient is the progress.
  std::uint64_t cells() const { return build_->volume(); }
  std::uint64_t cells_done() const { return cells_done_; }

 private:
  /// Returns the edit of a part of the build. Returns nullopt if it has no touched cell, and also if
  /// one edit cannot hold it; then its two halves lie on the stack.
  std::optional<EditDescriptor> edit_of(const VoxelBox& part);
  void split(const VoxelBox& part);
  bool next_block();

  BuildPtr build_;
  VoxelBox box_;
  Mask mask_;
  std::uint16_t skipped_ = 0;  // the cell number that counts as untouched; 0: none
  PasteLimits limits_;
  std::int32_t block_edge_ = 0;
  std::optional<ChunkCoord> block_;  // that next_block() returned last, in the grid of blocks
  std::vector<VoxelBox> parts_;      // that wait, the next one last
  std::uint64_t cells_done_ = 0;
};

/// Returns the paste of a whole build as one descriptor's clipboard, or null if one descriptor cannot
/// hold it. Cost: O(1) if a side is longer than kSideMax, otherwise that of cells_in().
std::shared_ptr<const Clipboard> whole_clipboard(const Build& build, EmptyCells empty,
                                                 const PasteLimits& limits);

/// Returns a clipboard as a build.
BuildPtr build_of(const Clipboard& clipboard);

}  // namespace runstone
