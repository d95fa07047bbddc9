// FoldMaker: makes the next fold of a world's log: its oldest edits, and the chunks after these
// edits. The owner of the store that is open for writing moves the fold into the base
// (WorldSink::fold_log()). Each fold begins at the head of the log, so the world is whole after
// each fold.
// Thread: one, which alone uses the reader.
#pragma once
#include <chrono>
#include <cstddef>
#include <optional>

#include "common/edits/apply/replayed_chunk.hpp"
#include "common/generate/generator.hpp"
#include "server/store/log_fold.hpp"
#include "server/store/world_reader.hpp"

namespace runstone {

/// The size of one fold. It has at least one edit, however many chunks that edit touches.
struct FoldSize {
  Sequence edits_max = 256;
  std::size_t chunks_max = 32;
};

/// The target for the time of the log writer that a fold takes. Only the size of the fold controls
/// it.
inline constexpr std::chrono::milliseconds kFoldTimeMax{20};

/// Returns the size of the next fold, if one of size `now` took the log writer `taken`.
FoldSize next_fold_size(const FoldSize& now, std::chrono::microseconds taken);

class FoldMaker {
 public:
  /// Reader and generator must outlive the maker.
  FoldMaker(WorldReader& reader, const Generator& generator)
      : reader_(reader), generator_(generator) {}

  /// Returns the fold of the oldest edits up to `until`, or nullopt if the log has none of them.
  StoreResult<std::optional<LogFold>> next(Sequence until, const FoldSize& size);

 private:
  StoreResult<std::optional<LogFold>> read(Sequence until, const FoldSize& size);

  WorldReader& reader_;
  const Generator& generator_;
  ReplayScratch scratch_;
};

}  // namespace runstone
