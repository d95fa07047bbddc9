// CommitEncoder: encodes the edits of a commit once, and makes messages of any of them. A server
// sends each session only the edits that concern it, so one commit may become several messages.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/core/bytes.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

class CommitEncoder {
 public:
  /// Requires a commit within the ranges that decode_message() demands. Keeps no reference to it.
  explicit CommitEncoder(const Commit& commit);
  explicit CommitEncoder(const VeiledCommit& commit);

  Epoch epoch() const { return epoch_; }
  /// Returns the indices of all edits.
  std::span<const std::uint32_t> all() const { return all_; }
  bool is_veiled() const { return is_veiled_; }
  /// Returns the byte list of a Commit or VeiledCommit message with the edits at these indices, as
  /// docs/protocol.md specifies it. Requires ascending indices of edits, at least one. Cost:
  /// O(bytes).
  Bytes list(std::span<const std::uint32_t> edits) const;

 private:
  struct Entry {
    Sequence seq = 0;
    TimeUs ordered_us = 0;
    std::size_t begin = 0, end = 0;  // in bytes_
  };
  CommitEncoder(Epoch epoch, std::size_t count, bool is_veiled);
  /// Adds the entry whose bytes begin at `begin` and end here.
  void add_entry(const OrderedEdit& edit, std::size_t begin);

  Epoch epoch_;
  bool is_veiled_;
  std::vector<std::uint32_t> all_;
  std::vector<Entry> entries_;
  Bytes bytes_;  // of each edit, what does not depend on the edit before
};

/// Returns the Commit or VeiledCommit message with the edits at these indices, as
/// CommitEncoder::list() takes them.
EncodedMessage encode_message(const CommitEncoder& commit, std::span<const std::uint32_t> edits);

}  // namespace runstone
