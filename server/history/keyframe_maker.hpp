// KeyframeMaker: finds where keyframes are due and makes them from what the log says; it needs no live world. Who owns the
// writing store saves them. One thread, which alone uses the reader.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "common/generate/generator.hpp"
#include "server/history/world_at.hpp"
#include "server/store/world_reader.hpp"

namespace runstone {

/// A keyframe is due with the first edit that makes both true: a moment then lies near one, and what keyframes hold is at
/// most a chunk for so many edits. The place depends on the log alone.
struct KeyframePolicy {
  std::uint64_t edits_min = 32'768;    // since the keyframe before; 0: none is ever due
  std::uint64_t edits_per_chunk = 16;  // edits since then for each chunk that they touched
};

class KeyframeMaker {
 public:
  using Chunks = std::vector<std::pair<ChunkKey, ChunkPtr>>;
  /// As Store::save_keyframe(); returns when it is done.
  using Save = std::function<StoreResult<void>(Chunks, const std::optional<Keyframe>&)>;
  using Progress = WorldAt::Progress;

  /// Both must outlive the maker.
  KeyframeMaker(WorldReader& reader, const Generator& generator, const KeyframePolicy& policy)
      : reader_(reader), generator_(generator), policy_(policy) {}

  /// Goes on through the log, from the newest keyframe to the log's present end, and makes those that are due. May be called
  /// again when the log has grown: it then reads only what is new. `progress` is called every 1,024 edits read and after
  /// each chunk made. After an error it may be called again too: what was saved stays, and is not made twice.
  StoreResult<void> make_due(const Save& save, const Progress& progress = {});
  /// Makes one at the end of this edit, whether due or not. Requires that there is none.
  StoreResult<void> make_at(Sequence at, const Save& save, const Progress& progress = {});

  /// Made by this object.
  std::uint64_t made() const { return made_; }

 private:
  /// Reads on to the next place where one is due; 0 if the log ends before.
  StoreResult<Sequence> next_due(const Progress& progress);

  WorldReader& reader_;
  const Generator& generator_;
  const KeyframePolicy policy_;
  std::optional<Sequence> read_;  // up to here; nothing before the first call
  std::uint64_t edits_ = 0;       // since the newest keyframe
  std::set<ChunkCoord> touched_;  // by them
  std::uint64_t made_ = 0;
};

}  // namespace runstone
