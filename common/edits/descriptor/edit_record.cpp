#include "common/edits/descriptor/edit_record.hpp"

#include <limits>
#include <utility>
#include <variant>

#include "common/edits/descriptor/edit_geometry.hpp"

namespace runstone {

Result<void> validate_fields(const EditRecord& record) {
  const Sequence seq = record.version.seq;
  if (seq == 0) return fail(ErrorCode::bad_value, "sequence 0 is the base, not an edit");
  if (seq > kSequenceMax) return fail(ErrorCode::bad_value, "sequence exceeds 63 bits");
  if (record.op.seq > kSequenceMax)
    return fail(ErrorCode::bad_value, "client sequence exceeds 63 bits");
  if (record.subject >= seq) return fail(ErrorCode::bad_value, "subject is not an earlier edit");
  if ((record.cause == Cause::rights) != (rights_change_of(record.edit) != nullptr) ||
      (record.cause == Cause::materials) != changes_materials(record.edit) ||
      (record.cause == Cause::library) != (library_change_of(record.edit) != nullptr) ||
      (record.cause == Cause::textures) != (given_texture_of(record.edit) != nullptr) ||
      (record.cause == Cause::clock) != (world_time_of(record.edit) != nullptr) ||
      (record.cause == Cause::gap) != (gap_of(record.edit) != nullptr))
    return fail(ErrorCode::bad_value, "the cause is not that of the edit");
  return {};
}

bool corrects_time(const EditRecord& record) {
  if (const GapEdit* gap = gap_of(record.edit)) return gap->begins_era;
  const RightsChange* change = rights_change_of(record.edit);
  return change != nullptr && std::holds_alternative<CorrectTime>(*change);
}

bool grants_for_some_time(const EditRecord& record) {
  const RightsChange* change = rights_change_of(record.edit);
  return change != nullptr && is_timed_grant(*change);
}

Bytes encode_record(const EditRecord& record) {
  RUNSTONE_ASSERT(validate_fields(record).has_value());
  RUNSTONE_ASSERT(static_cast<std::uint8_t>(record.cause) <= kCauseMax);
  Bytes out;
  ByteWriter w(out);
  w.u8(kEditRecordVersion);
  w.varint(record.log);
  w.varint(record.version.epoch);
  w.varint(record.version.seq);
  w.varint(record.op.author);
  w.u64(record.op.instance);
  w.varint(record.op.seq);
  w.svarint(record.time_us);
  w.u8(static_cast<std::uint8_t>(record.cause));
  w.varint(record.subject);
  const VoxelBox box = bounding_box(record.edit);
  w.svarint(box.min.x);
  w.svarint(box.min.y);
  w.svarint(box.min.z);
  w.varint(static_cast<std::uint64_t>(box.max.x - box.min.x));
  w.varint(static_cast<std::uint64_t>(box.max.y - box.min.y));
  w.varint(static_cast<std::uint64_t>(box.max.z - box.min.z));
  const Bytes descriptor = encode(record.edit);
  w.varint(descriptor.size());
  w.bytes(descriptor);
  return out;
}

namespace {

/// Reads the fields up to the cause.
void read_head(ByteReader& r, EditRecord& record) {
  constexpr std::uint64_t kU32Max = std::numeric_limits<std::uint32_t>::max();
  if (r.u8() != kEditRecordVersion) r.reject(ErrorCode::bad_version, "unknown edit record version");
  record.log = static_cast<LogId>(r.varint_max(kU32Max, "log id exceeds 32 bits"));
  record.version.epoch = static_cast<Epoch>(r.varint_max(kU32Max, "epoch exceeds 32 bits"));
  record.version.seq = r.varint();
  record.op.author = static_cast<AuthorId>(r.varint_max(kU32Max, "author exceeds 32 bits"));
  record.op.instance = r.u64();
  record.op.seq = r.varint();
  record.time_us = r.svarint();
  const std::uint8_t cause = r.u8();
  if (cause > kCauseMax) r.reject(ErrorCode::bad_value, "unknown cause");
  record.cause = static_cast<Cause>(cause <= kCauseMax ? cause : 0);
}

}  // namespace

Result<EditRecord> decode_record(ByteView in) {
  ByteReader r(in);
  EditRecord record;
  read_head(r, record);
  record.subject = r.varint();
  const auto coordinate = [&r] {
    return static_cast<std::int32_t>(
        r.svarint_in(-kWorldLimit, kWorldLimit - 1, "box outside the world"));
  };
  // This bound only prevents an overflow. The box is compared with that of the descriptor below.
  const auto side = [&r] {
    return static_cast<std::int32_t>(
        r.varint_max(2 * std::uint64_t{kWorldLimit}, "box larger than the world"));
  };
  VoxelBox box;
  box.min.x = coordinate();
  box.min.y = coordinate();
  box.min.z = coordinate();
  box.max.x = box.min.x + side();
  box.max.y = box.min.y + side();
  box.max.z = box.min.z + side();
  const auto length = r.varint_max(kRecordDescriptorBytesMax, "descriptor too long");
  const std::uint64_t at = r.offset();
  const ByteView bytes = r.bytes(static_cast<std::size_t>(length));
  if (const auto done = r.finish(); !done) return failure(done.error());
  auto edit = decode_descriptor(bytes);
  if (!edit) return fail(edit.error().code, edit.error().what, at + edit.error().offset);
  record.edit = *std::move(edit);
  if (auto valid = validate_fields(record); !valid) return failure(valid.error());
  if (box != bounding_box(record.edit)) {
    return fail(ErrorCode::bad_value, "bounding box is not the descriptor's", at);
  }
  return record;
}

std::optional<Cause> cause_of_record(ByteView in) {
  ByteReader r(in);
  EditRecord record;
  read_head(r, record);
  return r.ok() ? std::optional(record.cause) : std::nullopt;
}

}  // namespace runstone
