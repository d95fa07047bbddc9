// RlogReader: reads an .rlog. Every byte is untrusted: lengths, counts and times are bounded before
// use, and memory is that of one block. Reading stops at the first bad block or record. The error
// names its sequence and file position, and every record delivered before it is valid. Thread: one.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "common/rlog/rlog_block.hpp"
#include "common/rlog/rlog_edits.hpp"
#include "common/rlog/rlog_world.hpp"

namespace runstone {

/// Reads up to out.size() bytes of the file at `position` and returns their number, which is
/// smaller only at the end of the file. Returns nullopt if the file cannot be read.
using RlogSource =
    std::function<std::optional<std::size_t>(std::uint64_t position, std::span<std::uint8_t> out)>;

class RlogReader {
 public:
  /// Reads mark, world and players.
  static RlogResult<RlogReader> open(RlogSource source);

  const RlogWorld& world() const { return world_; }
  const std::vector<RlogPlayer>& players() const { return players_; }

  /// Returns the header of the next block of edits; its payload is not read. Returns nullopt behind
  /// the last one; then the end mark must follow, and no byte after it. Skipping a block costs one
  /// read of 64 bytes.
  RlogResult<std::optional<RlogBlock>> next_block();
  /// Calls `each` for the edits of the block that next_block() returned last, in order. Stops if
  /// `each` returns false, and then returns false.
  RlogResult<bool> read_block(const std::function<bool(const EditRecord&)>& each);

  /// Calls next_block() and read_block() for all remaining edits from sequence `from` on. Only the
  /// headers of the blocks before it are checked. Stops if `each` returns false; otherwise returns at
  /// the valid end of the file.
  RlogResult<void> read(Sequence from, const std::function<bool(const EditRecord&)>& each);

 private:
  explicit RlogReader(RlogSource source) : source_(std::move(source)) {}
  RlogResult<void> read_head();
  RlogResult<RlogBlock> read_any_header();
  RlogResult<void> read_payload(const RlogBlock& block);
  Unexpected<RlogError> failure_at(const Error& error, Sequence seq, std::uint64_t position) const {
    return {{error, seq, position}};
  }

  RlogSource source_;
  RlogWorld world_;
  std::vector<RlogPlayer> players_;
  std::optional<RlogBlock> current_;  // its payload may be read
  bool does_time_fall_ = false;       // from the block before to the current one
  Bytes stored_, raw_;
  std::uint64_t position_ = 0, checksum_ = 0;
  Sequence next_ = 0;  // 0: before the world block
  Epoch epoch_ = 0;    // of the last edit read
  TimeUs last_us_ = 0;
};

}  // namespace runstone
