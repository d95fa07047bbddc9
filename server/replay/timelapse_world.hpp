// TimelapseWorld: the part of a world that a timelapse shows, on its way from one moment of the log to a later
// one. The stage is fixed at the start: every chunk that is edited on the way, with the chunks around it, and for
// some chunks farther out the surface of the world and what was built before. Each chunk is made once; what edits
// touch is kept and follows the log by the same apply_stack() as everywhere.
// Memory: the chunks that are edited on the way, as runs. One thread, which alone uses the store's reader.
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
  /// More would need gigabytes in the program that draws, and minutes a frame.
  static constexpr std::size_t kChunksMax = 1U << 16;

  /// The world after edit `from`, to be followed up to `to`. Requires from <= to. `radius`: chunks of untouched
  /// surface around what is edited, and around the chunks `eyes`, from which is looked. Fails with what the
  /// store says of rows it cannot read, and (bad_request) if the log does not reach so far back, or the stage is
  /// larger than kChunksMax.
  static StoreResult<TimelapseWorld> open(WorldReader& reader, const Generator& generator,
                                          Sequence from, Sequence to, std::uint32_t radius,
                                          std::span<const ChunkCoord> eyes);

  /// Smallest box that holds the geometry of all edits on the way; of all before it, if there are none on the
  /// way; empty if there are none at all.
  const VoxelBox& edited() const { return edited_; }
  /// Box of all chunks on the stage.
  VoxelBox stage() const;
  std::size_t chunk_count() const { return stage_.size(); }

  using Each = std::function<bool(const ChunkKey&, const RunChunk&)>;
  /// Calls `each` for every chunk of the stage that is not all empty, as it is at `from`. Call once, first.
  /// Stops when it returns false.
  StoreResult<void> begin(const Each& each);
  /// Follows the log up to `seq`, and calls `each` for the chunks that look different since.
  StoreResult<void> advance(Sequence seq, const Each& each);

 private:
  using Column = std::pair<std::int32_t, std::int32_t>;  // x, z of its chunks

  TimelapseWorld(WorldReader& reader, const Generator& generator, WorldAt start)
      : reader_(&reader),
        generator_(&generator),
        edge_(reader.meta().chunk_edge),
        start_(std::move(start)) {}
  StoreResult<void> find_edits(Sequence to);
  StoreResult<void> set_stage(std::uint32_t radius, std::span<const ChunkCoord> eyes);
  void put_around(ChunkCoord at);
  void put_on_stage(ChunkCoord at);
  void add_surface(const Column& column);
  Unexpected<StoreError> too_large() const;

  WorldReader* reader_;
  const Generator* generator_;
  std::int32_t edge_;
  WorldAt start_;
  VoxelBox edited_;
  std::set<ChunkKey> stage_;
  std::set<ChunkKey> edited_chunks_;          // on the way; before it, if there are none
  std::map<ChunkKey, ReplayedChunk> moving_;  // edited_chunks_, from begin() on
  Sequence at_ = 0;
  FollowScratch scratch_;
};

}  // namespace runstone
