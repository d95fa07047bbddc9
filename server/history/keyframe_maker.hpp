// KeyframeMaker: finds the places in the log where keyframes are due, and makes these keyframes
// from the log. It needs no live world. The owner of the store that is open for writing saves them.
// Threads: one, which alone uses the reader.
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

/// A keyframe is due at the first edit for which both conditions hold. The first bounds the edits
/// between a moment and the keyframe before it. The second bounds the size of keyframes: at most
/// one chunk for so many edits. The place depends on the log alone.
struct KeyframePolicy {
  std::uint64_t edits_min = 32'768;  // since the keyframe before; 0: none is ever due
  // The least number of edits since the keyframe before, for each chunk that they touch.
  std::uint64_t edits_per_chunk = 16;
};

class KeyframeMaker {
 public:
  using Chunks = std::vector<std::pair<ChunkKey, ChunkPtr>>;
  /// Saves as WorldSink::save_keyframe(), and returns when it is done.
  using Save = std::function<StoreResult<void>(Chunks, const std::optional<Keyframe>&)>;
  using Progress = WorldAt::Progress;

  /// Reader and generator must outlive the maker.
  KeyframeMaker(WorldReader& reader, const Generator& generator, const KeyframePolicy& policy)
      : reader_(reader), generator_(generator), policy_(policy) {}

  /// Reads the log from the newest keyframe to its end, and makes the keyframes that are due. It
  /// may be called again when the log has grown: it then reads only the new edits. It may also be
  /// called again after an error: keyframes that were saved are not made twice. `progress` is
  /// called after every 1,024 edits and after each chunk.
  StoreResult<void> make_due(const Save& save, const Progress& progress = {});
  /// Returns the last edit that make_due() read. Requires a successful make_due() before.
  Sequence read_to() const { return *read_; }
  /// Returns the edit at which make_due() is worth the next call: no keyframe is due before if the
  /// edits so far are fewer than `edits_min`. Requires as read_to().
  Sequence look_again_at() const { return *read_ + policy_.edits_min - edits_ % policy_.edits_min; }
  /// Makes a keyframe after this edit, due or not. Requires that there is none.
  StoreResult<void> make_at(Sequence at, const Save& save, const Progress& progress = {});

  /// Returns the number of keyframes that this object has made.
  std::uint64_t made() const { return made_; }

 private:
  /// Reads up to the next edit at which a keyframe is due, and returns its sequence, or 0 if there
  /// is none.
  StoreResult<Sequence> next_due(const Progress& progress);

  WorldReader& reader_;
  const Generator& generator_;
  const KeyframePolicy policy_;
  std::optional<Sequence> read_;  // the last edit that was read; nullopt before the first call
  std::uint64_t edits_ = 0;       // read since the newest keyframe
  std::set<ChunkCoord> touched_;  // by these edits
  std::uint64_t made_ = 0;
};

}  // namespace runstone
