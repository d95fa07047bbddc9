#include "common/rlog/rlog_edits.hpp"

#include <algorithm>
#include <set>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

enum Column : std::size_t {
  kClient,
  kEpoch,
  kClientSeq,
  kTime,
  kCause,
  kSubject,
  kLength,
  kDescriptor
};
static_assert(kDescriptor + 1 == kRlogColumns);

/// Returns the difference from the client's next expected sequence, modulo 2^64, so that it cannot
/// overflow. A client counts by one, so it is mostly 0.
std::int64_t step_of(ClientSequence before, ClientSequence now) {
  return static_cast<std::int64_t>(now - (before + 1));
}

}  // namespace

std::size_t RlogEditsWriter::bytes() const {
  std::size_t sum = 0;
  for (const Bytes& column : columns_) sum += column.size();
  return sum;
}

void RlogEditsWriter::add(const EditRecord& record) {
  RUNSTONE_ASSERT(validate_fields(record).has_value() && record.log == 0);
  if (count_ == 0) {
    first_ = record.version.seq;
    first_us_ = last_us_ = record.time_us;
  }
  RUNSTONE_ASSERT(count_ == 0 || !corrects_time(record));
  RUNSTONE_ASSERT(record.version.seq == first_ + count_ && record.version.epoch >= epoch_ &&
                  record.time_us >= last_us_ && count_ < kRlogCountMax);
  const RlogClient client{record.op.author, record.op.instance};
  const auto [known, is_new] =
      index_.try_emplace(client, static_cast<std::uint32_t>(clients_.size()));
  if (is_new) clients_.emplace_back(client, 0);
  ClientSequence& before = clients_[known->second].second;
  const Bytes descriptor = encode(record.edit);
  ByteWriter(columns_[kClient]).varint(known->second);
  ByteWriter(columns_[kEpoch]).varint(record.version.epoch - epoch_);
  ByteWriter(columns_[kClientSeq]).svarint(step_of(before, record.op.seq));
  ByteWriter(columns_[kTime])
      .varint(static_cast<std::uint64_t>(record.time_us) - static_cast<std::uint64_t>(last_us_));
  ByteWriter(columns_[kCause]).u8(static_cast<std::uint8_t>(record.cause));
  ByteWriter(columns_[kSubject])
      .varint(record.subject == 0 ? 0 : record.version.seq - record.subject);
  ByteWriter(columns_[kLength]).varint(descriptor.size());
  ByteWriter(columns_[kDescriptor]).bytes(descriptor);
  before = record.op.seq;
  epoch_ = record.version.epoch;
  last_us_ = record.time_us;
  ++count_;
}

Bytes RlogEditsWriter::take(RlogBlock& block) {
  RUNSTONE_ASSERT(count_ > 0);
  block.kind = RlogKind::edits;
  block.count = count_;
  block.first = first_;
  block.first_us = first_us_;
  block.last_us = last_us_;
  Bytes out;
  ByteWriter w(out);
  w.varint(clients_.size());
  for (const auto& [client, last] : clients_) {
    w.varint(client.first);
    w.u64(client.second);
  }
  for (const Bytes& column : columns_) w.varint(column.size());
  for (Bytes& column : columns_) {
    w.bytes(column);
    column.clear();
  }
  index_.clear();
  clients_.clear();
  count_ = 0;
  epoch_ = 0;
  return out;
}

Result<RlogEditsReader> RlogEditsReader::open(ByteView payload, const RlogBlock& block,
                                              Epoch epoch) {
  RlogEditsReader out(block, epoch);
  ByteReader r(payload);
  const std::uint64_t clients = r.varint_max(block.count, "more clients than edits");
  std::set<RlogClient> known;
  for (std::uint64_t i = 0; i < clients && r.ok(); ++i) {
    const auto author = static_cast<AuthorId>(r.varint_max(kRlogU32Max, "author exceeds 32 bits"));
    const RlogClient client{author, r.u64()};
    if (!known.insert(client).second) r.reject(ErrorCode::not_canonical, "a client is named twice");
    out.clients_.emplace_back(client, 0);
  }
  std::array<std::size_t, kRlogColumns> lengths{};
  for (std::size_t& length : lengths) {
    length =
        static_cast<std::size_t>(r.varint_max(kRlogRawBytesMax, "column is longer than a block"));
  }
  for (std::size_t i = 0; i < kRlogColumns; ++i) {
    out.begins_[i] = r.offset();
    out.columns_.emplace_back(r.bytes(lengths[i]));
  }
  if (const auto done = r.finish(); !done) return failure(done.error());
  return out;
}

Unexpected<Error> RlogEditsReader::column_failure(std::size_t column) const {
  const Error& error = columns_[column].error();
  return fail(error.code, error.what, begins_[column] + error.offset);
}

Result<EditRecord> RlogEditsReader::next() {
  const auto& at = [this](Column column) -> ByteReader& { return columns_[column]; };
  EditRecord record;
  const std::uint64_t client = at(kClient).varint();
  // Clients are listed in the order in which they first occur, so a new client has the next index.
  if (at(kClient).ok() && (client > clients_seen_ || client >= clients_.size())) {
    at(kClient).reject(ErrorCode::bad_value, "client is not named, or not in order of appearance");
  }
  const std::uint64_t epoch_step = at(kEpoch).varint();
  // The first step counts from 0, so that the block does not depend on another.
  const bool is_first = seq_ == block_.first;
  const std::uint64_t epoch = (is_first ? 0 : epoch_) + std::min(epoch_step, kRlogU32Max);
  if (at(kEpoch).ok() && (epoch > kRlogU32Max || epoch_step > kRlogU32Max)) {
    at(kEpoch).reject(ErrorCode::bad_value, "epoch exceeds 32 bits");
  }
  if (at(kEpoch).ok() && epoch < epoch_) at(kEpoch).reject(ErrorCode::bad_value, "epoch falls");
  const std::int64_t client_step = at(kClientSeq).svarint();
  const std::uint64_t time_step = at(kTime).varint();
  const auto time_us = static_cast<TimeUs>(static_cast<std::uint64_t>(time_us_) + time_step);
  if (at(kTime).ok() &&
      (time_us < time_us_ || time_us > block_.last_us || (is_first && time_step != 0))) {
    at(kTime).reject(ErrorCode::bad_value, "time is not within the block's");
  }
  const std::uint8_t cause = at(kCause).u8();
  if (cause > kCauseMax) at(kCause).reject(ErrorCode::bad_value, "unknown cause");
  const std::uint64_t back = at(kSubject).varint_max(seq_ - 1, "subject is not an earlier edit");
  const std::uint64_t length =
      at(kLength).varint_max(kRecordDescriptorBytesMax, "descriptor too long");
  for (std::size_t i = 0; i < kDescriptor; ++i) {
    if (!columns_[i].ok()) return column_failure(i);
  }
  const std::size_t descriptor_at = at(kDescriptor).offset();
  const ByteView descriptor = at(kDescriptor).bytes(static_cast<std::size_t>(length));
  if (!at(kDescriptor).ok()) return column_failure(kDescriptor);
  auto edit = decode_descriptor(descriptor);
  if (!edit) {
    return fail(edit.error().code, edit.error().what,
                begins_[kDescriptor] + descriptor_at + edit.error().offset);
  }
  auto& [who, last] = clients_[static_cast<std::size_t>(client)];
  record.version = {static_cast<Epoch>(epoch), seq_};
  record.op = {who.first, who.second, last + 1 + static_cast<std::uint64_t>(client_step)};
  record.time_us = time_us;
  record.cause = static_cast<Cause>(cause);
  record.edit = *std::move(edit);
  record.subject = back == 0 ? 0 : seq_ - back;
  if (const auto numbers = validate_fields(record); !numbers) return failure(numbers.error());
  if (!is_first && corrects_time(record)) {
    return fail(ErrorCode::not_canonical, "a correction of the time is not the first of its block",
                begins_[kDescriptor] + descriptor_at);
  }
  clients_seen_ = std::max(clients_seen_, static_cast<std::size_t>(client) + 1);
  last = record.op.seq;
  epoch_ = record.version.epoch;
  time_us_ = time_us;
  ++seq_;
  return record;
}

Result<void> RlogEditsReader::finish() {
  RUNSTONE_ASSERT(seq_ == block_.first + block_.count);
  for (std::size_t i = 0; i < kRlogColumns; ++i) {
    if (!columns_[i].finish()) return column_failure(i);
  }
  if (clients_seen_ != clients_.size())
    return fail(ErrorCode::not_canonical, "a client is named for no edit");
  if (time_us_ != block_.last_us)
    return fail(ErrorCode::bad_value, "the last time is not the header's");
  return {};
}

}  // namespace runstone
