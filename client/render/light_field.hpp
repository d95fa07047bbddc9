// LightField: the light of every voxel in a box around the eye: the light of the sky and of lamps
// that reaches it. Light from the sky falls straight down through what is not opaque, and from
// there it spreads as that of lamps does (LightFlood). So rooms and caves are dark, and light comes
// in through doors and windows.
//   - The runs of each chunk are kept as runs of light codes, so that the box can move without
//     getting chunks again.
//   - A change marks a box of voxels, and update() computes the light anew as far from it as light
//     reaches.
//   - The levels stand in a ring: a voxel lies at its coordinates modulo the size of the box. So a
//     move changes only the voxels that come into the box.
// The field holds light, not materials, and its size does not depend on the world. Places without a
// chunk are open. Pure. Thread: one thread at a time.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "client/render/light_chunk.hpp"
#include "client/render/light_flood.hpp"
#include "common/core/coords.hpp"

namespace runstone {

class LightField {
 public:
  /// The box moves by this many voxels as soon as the eye is farther than that from its middle.
  static constexpr std::int32_t kStep = 16;

  /// A box of `width` x `height` x `width` voxels. Requires multiples of 2 * kStep.
  LightField(std::int32_t width, std::int32_t height);

  /// Replaces the light codes of a chunk. Chunks whose edge differs from that of the others are
  /// ignored. Cost: O(runs + voxels inside the box).
  void set(ChunkCoord at, std::int32_t edge, LightChunk chunk);
  void remove(ChunkCoord at);

  /// Moves the box to the eye and computes light. Small changes come first. If `all` is false, no
  /// change is begun after `kWorkMax` voxels; the rest is left for the next call. Appends the boxes
  /// whose levels changed.
  void update(VoxelPos eye, bool all, std::vector<VoxelBox>& changed);
  static constexpr std::int64_t kWorkMax = 150'000;

  /// Returns the box. It is empty before the first update().
  const VoxelBox& box() const { return box_; }
  std::int32_t width() const { return width_; }
  std::int32_t height() const { return height_; }
  /// Returns the levels in the order x, y, z of the ring.
  const std::vector<LightLevels>& ring() const { return levels_; }
  /// Requires a place inside the box.
  LightLevels levels_at(VoxelPos at) const { return levels_[index(at)]; }
  std::size_t byte_size() const;

 private:
  /// Walks along x through a row of the ring.
  struct RowCursor {
    std::size_t row, column, width;
    std::size_t index() const { return row + column; }
    void next() { column = column + 1 == width ? 0 : column + 1; }
  };
  RowCursor cursor(std::int32_t x, std::int32_t y, std::int32_t z) const;
  std::size_t index(VoxelPos at) const;
  void move_to(VoxelPos eye);
  /// Sets the codes of a chunk inside a part of the box, and returns the box of those that differ.
  VoxelBox fill(ChunkCoord at, const LightChunk* chunk, const VoxelBox& part);
  void fill_from_chunks(const VoxelBox& part);
  /// Marks the top of the box below a chunk that reaches above it.
  void mark_below(ChunkCoord at);
  void mark(VoxelBox dirty);
  /// Returns the chunks of a column of chunks that reach above the box.
  std::vector<std::pair<std::int32_t, const LightChunk*>> chunks_above(std::int32_t chunk_x,
                                                                       std::int32_t chunk_z) const;
  /// Computes the light that falls straight down in the columns of a dirty box. Returns the least y
  /// where it changed, or that of the box.
  std::int32_t let_fall(const VoxelBox& dirty);
  /// Computes the light in a part of the box, and returns the box of the levels that changed.
  VoxelBox relight(const VoxelBox& part);

  const std::int32_t width_, height_;
  std::int32_t edge_ = 0;  // of the chunks, voxels
  std::map<ChunkCoord, LightChunk> chunks_;
  std::map<std::int32_t, std::size_t> heights_;  // number of chunks by y, in chunks
  std::size_t chunk_bytes_ = 0;
  VoxelBox box_;
  std::vector<LightCode> codes_;
  std::vector<std::uint8_t> falling_;  // sky level of light that falls straight down
  std::vector<LightLevels> levels_;
  std::vector<VoxelBox> dirty_;
  LightFlood flood_;
};

}  // namespace runstone
