#include "protocol/codec/ordered_edit_reader.hpp"

#include "common/core/assert.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "protocol/codec/patch_list.hpp"
#include "protocol/limits.hpp"

namespace runstone {

Result<void> OrderedEditReader::next(OrderedEdit& edit, std::vector<ChunkCoord>& touched) {
  RUNSTONE_ASSERT(!at_end());
  take_fields(edit);
  take_descriptor(take_descriptor_size(), edit);
  take_previous(edit);
  if (!in_.ok()) return failure(in_.error());
  touched.clear();
  if (chunk_edge_ == 0) return {};
  return compare_with_geometry(edit, touched);
}

Result<void> OrderedEditReader::next(VeiledEdit& edit, std::vector<ChunkCoord>& touched) {
  RUNSTONE_ASSERT(!at_end() && chunk_edge_ != 0);
  take_fields(edit.ordered);
  // A descriptor has at least one byte.
  const std::uint64_t size = take_descriptor_size();
  edit.has_edit = size != 0;
  if (edit.has_edit) take_descriptor(size, edit.ordered);
  take_previous(edit.ordered);
  if (!edit.has_edit && in_.ok() && !edit.ordered.previous.empty())
    in_.reject(ErrorCode::bad_value, "an entry without an edit lists previous sequences");
  const std::uint64_t count = in_.varint_max(kVeilPatchesMax, "an edit has too many patches");
  KeyReader keys(chunk_edge_);
  edit.patches.clear();
  for (std::uint64_t i = 0; in_.ok() && i < count; ++i)
    edit.patches.push_back(take_patch(in_, keys, edit.ordered.seq, edit.has_edit, chunk_edge_));
  if (!in_.ok()) return failure(in_.error());
  touched.clear();
  return edit.has_edit ? compare_with_geometry(edit.ordered, touched) : Result<void>{};
}

void OrderedEditReader::take_fields(OrderedEdit& edit) {
  take_sequence_and_time(edit);
  edit.op.author =
      static_cast<AuthorId>(in_.varint_max(0xffff'ffff, "author of an edit exceeds 32 bits"));
  edit.op.instance = in_.u64();
  edit.op.seq = in_.varint();
  const std::uint8_t cause = in_.u8();
  if (in_.ok() && (cause > kCauseMax || !changes_voxels(static_cast<Cause>(cause))))
    in_.reject(ErrorCode::bad_value, "commit cause is unknown");
  edit.cause = static_cast<Cause>(cause);
  edit.subject = in_.varint_max(edit.seq - 1, "commit subject is not an earlier edit");
  // The difference is subtracted: a click lies before the edit's order.
  edit.submitted_us = edit.ordered_us - in_.svarint_in(edit.ordered_us - kWireTimeUsMax,
                                                       edit.ordered_us + kWireTimeUsMax,
                                                       "commit time is out of range");
}

Result<void> OrderedEditReader::compare_with_geometry(const OrderedEdit& edit,
                                                      std::vector<ChunkCoord>& touched) {
  // The bound comes before the list: a hostile box may touch millions of chunks. Servers reject by
  // the same bound.
  if (touched_chunks_bound(edit.edit, static_cast<std::uint16_t>(chunk_edge_)) > kTouchedChunksMax)
    return fail(ErrorCode::limit_exceeded, "edit touches too many chunks");
  touched_chunks(edit.edit, static_cast<std::uint16_t>(chunk_edge_), touched);
  if (touched.size() != edit.previous.size())
    return fail(ErrorCode::bad_value,
                "commit does not list one previous sequence per touched chunk");
  return {};
}

void OrderedEditReader::take_sequence_and_time(OrderedEdit& edit) {
  const std::uint64_t step = in_.varint_max(kSequenceMax - seq_, "commit sequence is out of range");
  if (in_.ok() && step == 0) in_.reject(ErrorCode::bad_value, "commit sequences do not ascend");
  edit.seq = seq_ += step;
  edit.ordered_us = ordered_us_ += in_.svarint_in(
      -kWireTimeUsMax - ordered_us_, kWireTimeUsMax - ordered_us_, "commit time is out of range");
}

std::uint64_t OrderedEditReader::take_descriptor_size() {
  return in_.varint_max(kDescriptorBytesMax, "descriptor is too long");
}

void OrderedEditReader::take_descriptor(std::uint64_t size, OrderedEdit& edit) {
  const ByteView bytes = in_.bytes(static_cast<std::size_t>(size));
  if (!in_.ok()) return;
  auto descriptor = decode_voxel_edit(bytes);
  if (descriptor) {
    edit.edit = *std::move(descriptor);
  } else {
    in_.reject(descriptor.error().code, descriptor.error().what);
  }
}

void OrderedEditReader::take_previous(OrderedEdit& edit) {
  edit.previous.clear();
  const std::uint64_t count = in_.varint_max(kTouchedChunksMax, "edit touches too many chunks");
  for (std::uint64_t i = 0; in_.ok() && i < count; ++i) {
    const std::uint64_t back = in_.varint_max(seq_, "previous sequence lies before the log");
    if (in_.ok() && back == 0) in_.reject(ErrorCode::bad_value, "an edit cannot precede itself");
    edit.previous.push_back(seq_ - back);
  }
}

}  // namespace runstone
