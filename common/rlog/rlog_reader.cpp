#include "common/rlog/rlog_reader.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

Error unreadable() { return {ErrorCode::io_failed, "cannot be read", 0}; }

}  // namespace

RlogResult<RlogReader> RlogReader::open(RlogSource source) {
  RlogReader reader(std::move(source));
  if (const auto head = reader.read_head(); !head) return failure(head.error());
  return reader;
}

RlogResult<RlogBlock> RlogReader::read_any_header() {
  const Sequence seq = std::max<Sequence>(next_, 1);
  std::array<std::uint8_t, kRlogHeaderBytes> bytes{};
  const auto got = source_(position_, bytes);
  if (!got) return failure_at(unreadable(), seq, position_);
  if (*got == 0)
    return failure_at({ErrorCode::truncated, "file ends without its end block", 0}, seq, position_);
  const auto block = read_header(ByteView(bytes).first(*got), checksum_);
  if (!block) return failure_at(block.error(), seq, position_);
  const auto bad = [&](const char* what) {
    return failure_at({ErrorCode::broken_invariant, what, 0}, seq, position_);
  };
  if (block->position != position_) return bad("block stands at another place than it says");
  if (next_ != 0 && block->first != next_) return bad("block does not continue the sequence");
  // read_block() checks that a block of edits may begin with an earlier time.
  if (next_ > 1 && block->first_us < last_us_ && block->kind != RlogKind::edits)
    return bad("time falls from block to block");
  if (next_ != 0 && block->kind != RlogKind::edits && block->first_us != last_us_) {
    return bad("time of a block without edits is not that of the edit before it");
  }
  return *block;
}

RlogResult<void> RlogReader::read_payload(const RlogBlock& block) {
  stored_.resize(block.stored_bytes);
  const std::uint64_t at = block.position + kRlogHeaderBytes;
  const auto got = source_(at, stored_);
  if (!got) return failure_at(unreadable(), block.first, block.position);
  if (*got < stored_.size()) {
    return failure_at({ErrorCode::truncated, "file ends inside a block", 0}, block.first,
                      block.position);
  }
  if (rlog_payload_checksum(stored_) != block.payload_checksum) {
    return failure_at({ErrorCode::bad_checksum, "checksum of the block is wrong", 0}, block.first,
                      block.position);
  }
  const auto unpacked = unpack_rlog_payload(stored_, block.raw_bytes, raw_);
  if (!unpacked) return failure_at(unpacked.error(), block.first, block.position);
  return {};
}

RlogResult<void> RlogReader::read_head() {
  std::array<std::uint8_t, kRlogFileHeadBytes> head{};
  const auto got = source_(0, head);
  if (!got) return failure_at(unreadable(), 1, 0);
  if (!std::equal(kRlogMark.begin(), kRlogMark.end(), head.begin())) {
    return failure_at({ErrorCode::bad_value, "is not an .rlog file", 0}, 1, 0);
  }
  if (*got < head.size())
    return failure_at({ErrorCode::truncated, "file ends inside its mark", 0}, 1, 0);
  if (ByteReader(ByteView(head).subspan(kRlogMark.size())).u32() != kRlogVersion) {
    return failure_at(
        {ErrorCode::bad_version, "is an .rlog of another version than this program knows", 0}, 1,
        0);
  }
  position_ = head.size();
  const auto first = read_any_header();
  if (!first) return failure(first.error());
  if (first->kind != RlogKind::world) {
    return failure_at({ErrorCode::broken_invariant, "the first block is not the world", 0}, 1,
                      position_);
  }
  if (const auto read = read_payload(*first); !read) return read;
  auto world = decode_rlog_world(raw_);
  if (!world) return failure_at(world.error(), first->first, position_);
  world_ = *std::move(world);
  world_.head.seq = first->first - 1;
  world_.head_us = first->first_us;
  next_ = first->first;
  epoch_ = world_.head.epoch;
  last_us_ = first->last_us;
  for (std::optional<RlogBlock> block = *first;;) {
    position_ += kRlogHeaderBytes + block->stored_bytes;
    checksum_ = block->header_checksum;
    auto header = read_any_header();
    // An error behind the players is reported again when the caller reads the next block.
    if (!header || header->kind != RlogKind::players) return {};
    block = *header;
    if (const auto read = read_payload(*block); !read) return read;
    const AuthorId before = players_.empty() ? 0 : players_.back().author;
    if (const auto players = decode_rlog_players(raw_, block->count, before, players_); !players) {
      return failure_at(players.error(), next_, position_);
    }
  }
}

RlogResult<std::optional<RlogBlock>> RlogReader::next_block() {
  current_.reset();
  const auto header = read_any_header();
  if (!header) return failure(header.error());
  if (header->kind == RlogKind::end) {
    std::array<std::uint8_t, 1> more{};
    const std::uint64_t behind = position_ + kRlogHeaderBytes;
    const auto got = source_(behind, more);
    if (!got) return failure_at(unreadable(), next_, behind);
    if (*got != 0)
      return failure_at({ErrorCode::trailing_bytes, "something follows the end block", 0}, next_,
                        behind);
    return std::optional<RlogBlock>{};
  }
  if (header->kind != RlogKind::edits) {
    return failure_at({ErrorCode::broken_invariant, "world or players stand among the edits", 0},
                      next_, position_);
  }
  current_ = *header;
  // The first edit of a log has no predecessor whose time could be later.
  does_time_fall_ = next_ > 1 && header->first_us < last_us_;
  position_ += kRlogHeaderBytes + header->stored_bytes;
  checksum_ = header->header_checksum;
  next_ = header->first + header->count;
  last_us_ = header->last_us;
  return current_;
}

RlogResult<bool> RlogReader::read_block(const std::function<bool(const EditRecord&)>& each) {
  RUNSTONE_ASSERT(current_.has_value());
  const RlogBlock block = *current_;
  if (const auto read = read_payload(block); !read) return failure(read.error());
  auto edits = RlogEditsReader::open(raw_, block, epoch_);
  if (!edits) return failure_at(edits.error(), block.first, block.position);
  for (std::uint32_t i = 0; i < block.count; ++i) {
    const auto record = edits->next();
    if (!record) return failure_at(record.error(), block.first + i, block.position);
    if (i == 0 && does_time_fall_ && !corrects_time(*record)) {
      return failure_at({ErrorCode::broken_invariant, "time falls from block to block", 0},
                        block.first, block.position);
    }
    epoch_ = record->version.epoch;
    if (!each(*record)) return false;
  }
  if (const auto done = edits->finish(); !done)
    return failure_at(done.error(), next_, block.position);
  return true;
}

RlogResult<void> RlogReader::read(Sequence from,
                                  const std::function<bool(const EditRecord&)>& each) {
  for (;;) {
    const auto block = next_block();
    if (!block) return failure(block.error());
    if (!block->has_value()) return {};
    if (next_ <= from) continue;
    const auto read = read_block(
        [&](const EditRecord& record) { return record.version.seq < from || each(record); });
    if (!read) return failure(read.error());
    if (!*read) return {};
  }
}

}  // namespace runstone
