#include <utility>

#include "protocol/codec/body_reader.hpp"
#include "protocol/codec/ordered_edit_reader.hpp"
#include "protocol/codec/patch_list.hpp"

namespace runstone {

Result<Message> BodyReader::read(const wire::EditRequest& t) const {
  EditRequest m;
  m.client_seq = t.client_seq();
  m.submitted_us = t.submitted_us();
  if (!is_time(m.submitted_us)) return bad("edit request time is out of range");
  if (m.client_seq == 0) return bad("client sequences start at 1");
  if (m.client_seq > kSequenceMax) return bad("client sequence exceeds 63 bits");
  m.action = t.action();
  m.is_optional = t.optional();
  if (m.action > m.client_seq) return bad("an action begins with a later edit");
  auto edit = decode_voxel_edit(view_of(t.edit()));
  if (edit) {
    m.edit = *std::move(edit);
  } else {
    m.fault = edit.error();
  }
  return Message{std::move(m)};
}

Result<Message> BodyReader::read(const wire::Commit& t) const {
  Commit m;
  m.epoch = t.epoch();
  OrderedEdit edit;
  std::vector<ChunkCoord> touched;
  const auto ok = read_edits(t, edit, touched, [&m, &edit]() -> Result<void> {
    m.edits.push_back(std::move(edit));
    return {};
  });
  if (!ok) return failure(ok.error());
  return Message{std::move(m)};
}

Result<void> BodyReader::read_edits(const wire::Commit& t, OrderedEdit& edit,
                                    std::vector<ChunkCoord>& touched, const TakeEdit& take) const {
  if (t.epoch() == 0) return bad("commit epoch is 0");
  const ByteView bytes = view_of(t.edits());
  if (bytes.empty()) return bad("commit has no edits");
  OrderedEditReader edits(bytes, chunk_edge);
  for (std::size_t count = 0; !edits.at_end(); ++count) {
    if (count == kCommitEditsMax) return bad("commit has more than 4096 edits");
    if (const auto ok = edits.next(edit, touched); !ok) return ok;
    if (const auto ok = take(); !ok) return ok;
  }
  return {};
}

Result<Message> BodyReader::read(const wire::VeiledCommit& t) const {
  if (chunk_edge == 0) return bad("veiled commit before Welcome");
  if (t.epoch() == 0) return bad("commit epoch is 0");
  const ByteView bytes = view_of(t.edits());
  if (bytes.empty()) return bad("commit has no edits");
  VeiledCommit m;
  m.epoch = t.epoch();
  std::vector<ChunkCoord> touched;
  OrderedEditReader edits(bytes, chunk_edge);
  while (!edits.at_end()) {
    if (m.edits.size() == kCommitEditsMax) return bad("commit has more than 4096 edits");
    if (const auto ok = edits.next(m.edits.emplace_back(), touched); !ok)
      return failure(ok.error());
  }
  return Message{std::move(m)};
}

Result<Message> BodyReader::read(const wire::VeilPatches& t) const {
  if (chunk_edge == 0) return bad("veil patches before Welcome");
  if ((t.epoch() == 0) != (t.seq() == 0)) return bad("version is half zero");
  if (t.seq() > kSequenceMax) return bad("sequence exceeds 63 bits");
  const ByteView bytes = view_of(t.patches());
  if (bytes.empty()) return bad("veil patches are missing");
  VeilPatches m;
  m.version = {t.epoch(), t.seq()};
  KeyReader keys(chunk_edge);
  auto patches = entries_of<ChunkPatch>(bytes, kVeilPatchesMax, [&](ByteReader& in) {
    return take_patch(in, keys, m.version.seq, true, chunk_edge);
  });
  if (!patches) return failure(patches.error());
  m.patches = *std::move(patches);
  return Message{std::move(m)};
}

Result<Message> BodyReader::read(const wire::Reject& t) const {
  Reject m;
  m.client_seq = t.client_seq();
  if (m.client_seq == 0) return bad("client sequences start at 1");
  if (t.reason() == 0 || t.reason() > kRejectReasonMax) return bad("reject reason is unknown");
  m.reason = static_cast<RejectReason>(t.reason());
  m.seq = t.seq();
  if (m.seq != 0 && m.reason != RejectReason::already_resolved)
    return bad("reject names a sequence");
  if (!take_text(t.detail(), 0, kTextBytesMax, m.detail))
    return bad("reject detail is not 0 .. 256 bytes of text");
  return m;
}

Result<Message> BodyReader::read(const wire::Durable& t) const {
  if (t.epoch() == 0) return bad("durable epoch is 0");
  return Durable{t.epoch(), t.seq(), t.is_read_only()};
}

Result<Message> BodyReader::read(const wire::Resume& t) const {
  if (t.resolved() > kSequenceMax) return bad("resume: client sequence exceeds 63 bits");
  return Resume{t.resolved()};
}

Result<Message> BodyReader::read(const wire::Resumed& /*t*/) const { return Resumed{}; }

}  // namespace runstone
