// TimelapseWorld: the part of a world that a timelapse shows, at successive moments of the log. The
// set of chunks that are drawn, the stage, is fixed at the start. It has every chunk that the edits
// of the timelapse touch, the chunks around it, and for some chunks farther out the surface of the
// world and what was built there before. Each chunk is made once. Chunks that edits touch are kept
// and follow the log by the same apply_stack() as everywhere. Memory: the chunks that the edits
// touch, as runs. Thread: one, which is the only user of the store's reader.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "common/edits/apply/replayed_chunk.hpp"
#include "common/generate/generator.hpp"
#include "server/history/world_at.hpp"
#include "server/store/world_reader.hpp"

namespace runstone {

class TimelapseWorld {
 public:
  /// The maximum number of chunks on the stage. More would need gigabytes in the program that
  /// draws, and minutes for each frame.
  static constexpr std::size_t kChunksMax = 1U << 16;

  /// Opens the world after edit `from`, to be advanced up to `to`. `eyes` are the chunks in which
  /// the camera stands. `radius` is the number of chunks of untouched surface around the edited
  /// chunks and around `eyes`. Requires from <= to. Fails with the store's error if a row cannot be
  /// read, and with bad_request if the log does not reach back to `from` or the stage has more than
  /// kChunksMax chunks.
  static StoreResult<TimelapseWorld> open(WorldReader& reader, const Generator& generator,
                                          Sequence from, Sequence to, std::uint32_t radius,
                                          std::span<const ChunkCoord> eyes);

  /// Returns the smallest box around all edits between `from` and `to`. If there are none, returns
  /// a box around all chunks edited before; it is empty if there are none either.
  const VoxelBox& edited() const { return edited_; }
  /// Returns the box of all chunks on the stage.
  VoxelBox stage() const;
  std::size_t chunk_count() const { return stage_.size(); }

  using Each = std::function<bool(const ChunkKey&, const RunChunk&)>;
  /// Calls `each` for every chunk of the stage that is not empty, as it is after `from`. Call it
  /// once, first. Stops when `each` returns false.
  StoreResult<void> begin(const Each& each);
  /// Applies the log up to `seq`, and calls `each` for the chunks whose voxels changed.
  StoreResult<void> advance(Sequence seq, const Each& each);

 private:
  using Column = std::pair<std::int32_t, std::int32_t>;  // x, z of chunks

  TimelapseWorld(WorldReader& reader, const Generator& generator, WorldAt start)
      : reader_(&reader),
        generator_(&generator),
        edge_(reader.meta().chunk_edge),
        start_(std::move(start)) {}
  StoreResult<void> find_edits(Sequence to);
  StoreResult<void> set_stage(std::uint32_t radius, std::span<const ChunkCoord> eyes);
  void add_around(ChunkCoord at);
  void add_to_stage(ChunkCoord at);
  void add_surface(const Column& column);
  Unexpected<StoreError> too_large() const;

  WorldReader* reader_;
  const Generator* generator_;
  std::int32_t edge_;
  WorldAt start_;
  VoxelBox edited_;
  std::set<ChunkKey> stage_;
  std::set<ChunkKey> edited_chunks_;            // between from and to; if there are none, before
  std::map<ChunkKey, ReplayedChunk> replayed_;  // edited_chunks_, after begin()
  Sequence at_ = 0;
  ReplayScratch scratch_;
};

}  // namespace runstone
