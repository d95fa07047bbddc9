#include "common/rlog/rlog_writer.hpp"

#include <utility>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

// A block is closed at this size, so that one more record of the largest kind keeps it below its
// bound.
constexpr std::size_t kBlockBytes = std::size_t{1} << 20;
static_assert(kBlockBytes * 2 + kRecordDescriptorBytesMax < kRlogRawBytesMax);

}  // namespace

RlogWriter::RlogWriter(RlogSink sink, RlogOptions options)
    : sink_(std::move(sink)), options_(options) {
  RUNSTONE_ASSERT(options.edits_per_block >= 1 && options.edits_per_block <= kRlogCountMax);
}

Unexpected<RlogError> RlogWriter::failure_at(ErrorCode code, const char* what, Sequence seq) const {
  return {{Error{code, what, 0}, seq, position_}};
}

RlogResult<void> RlogWriter::write_block(RlogBlock block, ByteView raw) {
  if (raw.size() > kRlogRawBytesMax) {
    return failure_at(ErrorCode::limit_exceeded, "is longer than a block may be", block.first);
  }
  pack_rlog_payload(raw, options_.zstd_level, packed_);
  block.raw_bytes = static_cast<std::uint32_t>(raw.size());
  block.stored_bytes = static_cast<std::uint32_t>(packed_.size());
  block.position = position_;
  block.payload_checksum = rlog_payload_checksum(packed_);
  bytes_.clear();
  write_header(block, checksum_, bytes_);
  bytes_.insert(bytes_.end(), packed_.begin(), packed_.end());
  if (!sink_(bytes_)) return failure_at(ErrorCode::io_failed, "cannot be written", block.first);
  checksum_ = block.header_checksum;
  position_ += bytes_.size();
  return {};
}

RlogResult<void> RlogWriter::begin(const RlogWorld& world, std::span<const RlogPlayer> players) {
  RUNSTONE_ASSERT(position_ == 0 && world.head.seq < kSequenceMax);
  next_ = world.head.seq + 1;
  epoch_ = world.head.epoch;
  last_us_ = world.head_us;
  Bytes head(kRlogMark.begin(), kRlogMark.end());
  ByteWriter(head).u32(kRlogVersion);
  if (!sink_(head)) return failure_at(ErrorCode::io_failed, "cannot be written", next_);
  position_ = head.size();
  RlogBlock block;
  block.kind = RlogKind::world;
  block.first = next_;
  block.first_us = block.last_us = last_us_;
  if (auto written = write_block(block, encode_rlog_world(world)); !written) return written;
  block.kind = RlogKind::players;
  Bytes raw;
  for (std::size_t i = 0; i < players.size(); ++i) {
    RUNSTONE_ASSERT(i == 0 || players[i].author > players[i - 1].author);
    encode_rlog_player(players[i], raw);
    ++block.count;
    if (raw.size() < kBlockBytes && block.count < kRlogCountMax && i + 1 < players.size()) continue;
    if (auto written = write_block(block, raw); !written) return written;
    block.count = 0;
    raw.clear();
  }
  return {};
}

RlogResult<void> RlogWriter::add(const EditRecord& record) {
  const auto bad = [&](const char* what) {
    return failure_at(ErrorCode::bad_value, what, record.version.seq);
  };
  if (const auto numbers = validate_fields(record); !numbers) return bad(numbers.error().what);
  if (record.log != 0) return bad("belongs to another log");
  if (record.version.seq != next_) return bad("does not continue the log");
  if (record.version.epoch < epoch_) return bad("epoch falls");
  const bool begins_era = corrects_time(record);
  // The first edit of a log has no predecessor whose time could be later.
  if (record.time_us < last_us_ && !begins_era && !(is_first_ && next_ == 1))
    return bad("time falls");
  if (begins_era) {
    if (auto written = write_edits(); !written) return written;
  }
  edits_.add(record);
  ++next_;
  epoch_ = record.version.epoch;
  last_us_ = record.time_us;
  is_first_ = false;
  if (edits_.count() == options_.edits_per_block || edits_.bytes() >= kBlockBytes)
    return write_edits();
  return {};
}

RlogResult<void> RlogWriter::write_edits() {
  if (edits_.count() == 0) return {};
  RlogBlock block;
  const Bytes raw = edits_.take(block);
  return write_block(block, raw);
}

RlogResult<void> RlogWriter::finish() {
  if (auto written = write_edits(); !written) return written;
  if (next_ > kSequenceMax)
    return failure_at(ErrorCode::limit_exceeded, "is the last edit there can be", next_ - 1);
  RlogBlock block;
  block.kind = RlogKind::end;
  block.first = next_;
  block.first_us = block.last_us = last_us_;
  return write_block(block, {});
}

}  // namespace runstone
