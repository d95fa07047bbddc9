// RlogWriter: writes a log as an .rlog, front to back, with one block in memory. The sink gets the
// file's bytes in order. Until finish(), these bytes are a truncated file. Thread: one.
#pragma once
#include <cstdint>
#include <functional>
#include <span>

#include "common/rlog/rlog_block.hpp"
#include "common/rlog/rlog_edits.hpp"
#include "common/rlog/rlog_world.hpp"

namespace runstone {

/// Takes the next bytes of the file. Returns false if they cannot be written, which ends the
/// writing.
using RlogSink = std::function<bool(ByteView)>;

struct RlogOptions {
  int zstd_level = 9;  // 1 .. 19; 0: blocks are not compressed
  /// Larger blocks pack better; a damaged byte costs its block and all later ones. 1 ..
  /// kRlogCountMax.
  std::uint32_t edits_per_block = 4096;
};

class RlogWriter {
 public:
  explicit RlogWriter(RlogSink sink, RlogOptions options = {});

  /// Writes mark, world and players (ascending by author). Call it once, first.
  RlogResult<void> begin(const RlogWorld& world, std::span<const RlogPlayer> players);
  /// Adds the next edit. Fails with bad_value if it does not continue the log: a sequence that is
  /// not the next one, a log other than 0, an epoch or a time that falls, or numbers that no record
  /// can have.
  RlogResult<void> add(const EditRecord& record);
  /// Writes the remaining edits and the end mark. Call it once, last.
  RlogResult<void> finish();

  std::uint64_t bytes() const { return position_; }  // given to the sink

 private:
  RlogResult<void> write_block(RlogBlock block, ByteView raw);
  RlogResult<void> write_edits();
  Unexpected<RlogError> failure_at(ErrorCode code, const char* what, Sequence seq) const;

  RlogSink sink_;
  RlogOptions options_;
  RlogEditsWriter edits_;
  Bytes packed_, bytes_;
  std::uint64_t position_ = 0, checksum_ = 0;
  Sequence next_ = 1;
  Epoch epoch_ = 0;
  TimeUs last_us_ = 0;
  bool is_first_ = true;  // no edit yet
};

}  // namespace runstone
