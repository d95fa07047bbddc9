// RlogEdits: the payload of a block of edits: records as columns, and numbers as differences from
// their predecessors, so that zstd packs them well. A block depends on no other block: readers may
// begin at any block.
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

/// The columns are client, epoch, client sequence, time, cause, subject, descriptor length,
/// descriptor.
inline constexpr std::size_t kRlogColumns = 8;
using RlogClient = std::pair<AuthorId, ClientInstance>;

/// Collects the edits of one block.
class RlogEditsWriter {
 public:
  /// Requires a valid record that continues the previous one: the next sequence; epoch and time do
  /// not fall. A record that corrects_time() must be the first of its block.
  void add(const EditRecord& record);
  std::uint32_t count() const { return count_; }
  /// Returns the bytes of the columns so far.
  std::size_t bytes() const;
  /// Returns the payload and empties the writer. `block` gets kind, count, first sequence and
  /// times. Requires count() > 0.
  Bytes take(RlogBlock& block);

 private:
  std::map<RlogClient, std::uint32_t> index_;  // into clients_
  // The clients in order of appearance, with the last client sequence of each.
  std::vector<std::pair<RlogClient, ClientSequence>> clients_;
  std::array<Bytes, kRlogColumns> columns_;
  std::uint32_t count_ = 0;
  Sequence first_ = 0;
  Epoch epoch_ = 0;
  TimeUs first_us_ = 0, last_us_ = 0;
};

/// Reads one block record by record, so that the records before a bad one can be used. Every byte
/// is untrusted. The offset of an error is a byte of the payload.
class RlogEditsReader {
 public:
  /// The payload must outlive the reader. `epoch` is that of the last edit known before the block.
  static Result<RlogEditsReader> open(ByteView payload, const RlogBlock& block, Epoch epoch);
  /// Returns the next record. Call it block.count times, or until it fails.
  Result<EditRecord> next();
  /// Call it after the last record. Fails if the block held more than the header announced.
  Result<void> finish();

 private:
  RlogEditsReader(const RlogBlock& block, Epoch epoch)
      : block_(block), seq_(block.first), epoch_(epoch), time_us_(block.first_us) {}
  Unexpected<Error> column_failure(std::size_t column) const;

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
