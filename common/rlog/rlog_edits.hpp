// RlogEdits: the payload of a block of edits: records as columns, numbers as differences from what stands
// before them, so that zstd finds little left to say about a builder's next voxel. A block needs no other
// block: readers begin at any.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/edits/descriptor/edit_record.hpp"
#include "common/rlog/rlog_block.hpp"

namespace runstone {

/// client, epoch, client sequence, time, cause, subject, descriptor length, descriptor.
inline constexpr std::size_t kRlogColumns = 8;
using RlogClient = std::pair<AuthorId, ClientInstance>;

/// Collects one block.
class RlogEditsWriter {
 public:
  /// Requires a valid record that continues the one before: next sequence, neither epoch nor time falls.
  void add(const EditRecord& record);
  std::uint32_t count() const { return count_; }
  /// Bytes of the columns so far.
  std::size_t bytes() const;
  /// The payload; `block` gets kind, count, first sequence and times. Empties the writer. Requires count() > 0.
  Bytes take(RlogBlock& block);

 private:
  std::map<RlogClient, std::uint32_t> index_;  // into clients_
  std::vector<std::pair<RlogClient, ClientSequence>>
      clients_;  // in order of appearance; last client sequence
  std::array<Bytes, kRlogColumns> columns_;
  std::uint32_t count_ = 0;
  Sequence first_ = 0;
  Epoch epoch_ = 0;
  TimeUs first_us_ = 0, last_us_ = 0;
};

/// Reads one block record by record, so that what stands before a bad record can be had. Every byte is
/// hostile; the offset of an error is a byte of the payload.
class RlogEditsReader {
 public:
  /// The payload must outlive the reader. `epoch` is that of the last edit known before the block.
  static Result<RlogEditsReader> open(ByteView payload, const RlogBlock& block, Epoch epoch);
  /// The next record. Call block.count times, until one fails.
  Result<EditRecord> next();
  /// After the last record: whether the block held what it announced and nothing else.
  Result<void> finish();

 private:
  RlogEditsReader(const RlogBlock& block, Epoch epoch)
      : block_(block), seq_(block.first), epoch_(epoch), time_us_(block.first_us) {}
  Unexpected<Error> failure(std::size_t column) const;

  RlogBlock block_;
  std::vector<std::pair<RlogClient, ClientSequence>> clients_;
  std::vector<ByteReader> columns_;
  std::array<std::uint64_t, kRlogColumns> begins_{};  // of the columns in the payload
  std::size_t clients_seen_ = 0;
  Sequence seq_;
  Epoch epoch_;
  TimeUs time_us_;
};

}  // namespace runstone
