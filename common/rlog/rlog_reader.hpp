// RlogReader: reads an .rlog. Every byte is hostile: lengths, counts and times are bounded before they are
// used, and memory is that of one block. Reading stops at the first block or record that is wrong; the error
// names its sequence and file position, and every record handed over before it stands. One thread.
#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "common/rlog/rlog_block.hpp"
#include "common/rlog/rlog_edits.hpp"
#include "common/rlog/rlog_world.hpp"

namespace runstone {

/// Reads up to out.size() bytes of the file at `position` and returns how many there were (fewer only at the
/// end); nothing when the file cannot be read.
using RlogSource =
    std::function<std::optional<std::size_t>(std::uint64_t position, std::span<std::uint8_t> out)>;

/// The first edit wanted: not before this sequence and not before this time.
struct RlogFrom {
  Sequence seq = 1;
  TimeUs time_us = std::numeric_limits<TimeUs>::min();  // UTC
};

class RlogReader {
 public:
  /// Reads mark, world and players.
  static RlogResult<RlogReader> open(RlogSource source);

  const RlogWorld& world() const { return world_; }
  const std::vector<RlogPlayer>& players() const { return players_; }

  /// Header of the next block of edits, its payload unread; nothing behind the last one, where the end mark
  /// must stand and nothing after it. Hopping over a block costs one read of 64 bytes.
  RlogResult<std::optional<RlogBlock>> next_block();
  /// Calls `each` for the edits of the block that next_block() returned last, in order; stops when it returns
  /// false, which is reported.
  RlogResult<bool> read_block(const std::function<bool(const EditRecord&)>& each);

  /// Both, for every edit from `from` on that lies ahead; hops over the blocks before it (only their headers
  /// are checked). Stops when `each` returns false; otherwise returns at the sound end of the file.
  RlogResult<void> read(const RlogFrom& from, const std::function<bool(const EditRecord&)>& each);

 private:
  explicit RlogReader(RlogSource source) : source_(std::move(source)) {}
  RlogResult<void> read_head();
  RlogResult<RlogBlock> read_any_header();
  RlogResult<void> read_payload(const RlogBlock& block);
  Unexpected<RlogError> failure(const Error& error, Sequence seq, std::uint64_t position) const {
    return {{error, seq, position}};
  }

  RlogSource source_;
  RlogWorld world_;
  std::vector<RlogPlayer> players_;
  std::optional<RlogBlock> current_;  // its payload may be read
  Bytes stored_, raw_;
  std::uint64_t position_ = 0, checksum_ = 0;
  Sequence next_ = 0;  // 0: before the world block
  Epoch epoch_ = 0;    // of the last edit read
  TimeUs last_us_ = 0;
};

}  // namespace runstone
