#include "protocol/codec/commit_encoder.hpp"

#include <numeric>

#include "common/core/assert.hpp"
#include "protocol/codec/patch_list.hpp"
#include "protocol/limits.hpp"

namespace runstone {
namespace {

/// Writes the fields of an entry that do not depend on the edit before.
void put_independent_fields(const OrderedEdit& edit, bool has_descriptor, ByteWriter& out) {
  RUNSTONE_ASSERT(edit.subject < edit.seq && edit.previous.size() <= kTouchedChunksMax);
  out.varint(edit.op.author);
  out.u64(edit.op.instance);
  out.varint(edit.op.seq);
  out.u8(static_cast<std::uint8_t>(edit.cause));
  out.varint(edit.subject);
  out.svarint(edit.ordered_us - edit.submitted_us);
  const Bytes descriptor = has_descriptor ? encode(edit.edit) : Bytes{};
  out.varint(descriptor.size());
  out.bytes(descriptor);
  out.varint(edit.previous.size());
  for (const Sequence previous : edit.previous) {
    RUNSTONE_ASSERT(previous < edit.seq);
    out.varint(edit.seq - previous);
  }
}

}  // namespace

CommitEncoder::CommitEncoder(Epoch epoch, std::size_t count, bool is_veiled)
    : epoch_(epoch), is_veiled_(is_veiled), all_(count) {
  RUNSTONE_ASSERT(count != 0 && count <= kCommitEditsMax);
  std::iota(all_.begin(), all_.end(), 0U);
  entries_.reserve(count);
}

CommitEncoder::CommitEncoder(const Commit& commit)
    : CommitEncoder(commit.epoch, commit.edits.size(), false) {
  ByteWriter out(bytes_);
  for (const OrderedEdit& edit : commit.edits) {
    const std::size_t begin = bytes_.size();
    put_independent_fields(edit, true, out);
    add_entry(edit, begin);
  }
}

CommitEncoder::CommitEncoder(const VeiledCommit& commit)
    : CommitEncoder(commit.epoch, commit.edits.size(), true) {
  ByteWriter out(bytes_);
  for (const VeiledEdit& edit : commit.edits) {
    RUNSTONE_ASSERT(edit.has_edit || edit.ordered.previous.empty());
    const std::size_t begin = bytes_.size();
    put_independent_fields(edit.ordered, edit.has_edit, out);
    out.varint(edit.patches.size());
    put_patches(out, edit.patches, edit.ordered.seq);
    add_entry(edit.ordered, begin);
  }
}

void CommitEncoder::add_entry(const OrderedEdit& edit, std::size_t begin) {
  RUNSTONE_ASSERT(edit.seq > (entries_.empty() ? 0 : entries_.back().seq));
  RUNSTONE_ASSERT(edit.seq <= kSequenceMax);
  entries_.push_back({edit.seq, edit.ordered_us, begin, bytes_.size()});
}

Bytes CommitEncoder::list(std::span<const std::uint32_t> edits) const {
  RUNSTONE_ASSERT(!edits.empty());
  Bytes bytes;
  ByteWriter out(bytes);
  Sequence seq = 0;
  TimeUs ordered_us = 0;
  for (const std::uint32_t i : edits) {
    const Entry& entry = entries_[i];
    RUNSTONE_ASSERT(entry.seq > seq);
    out.varint(entry.seq - seq);
    out.svarint(entry.ordered_us - ordered_us);
    out.bytes(ByteView(bytes_).subspan(entry.begin, entry.end - entry.begin));
    seq = entry.seq;
    ordered_us = entry.ordered_us;
  }
  return bytes;
}

}  // namespace runstone
