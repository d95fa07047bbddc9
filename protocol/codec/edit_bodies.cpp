#include <algorithm>
#include <limits>
#include <utility>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "protocol/codec/body_reader.hpp"

namespace runstone {

Result<Message> BodyReader::read(const wire::EditRequest& t) const {
  EditRequest m;
  m.client_seq = t.client_seq();
  m.submitted_us = t.submitted_us();
  if (!is_time(m.submitted_us)) return bad("edit request time is out of range");
  if (m.client_seq == 0) return bad("client sequences start at 1");
  if (m.client_seq > kSequenceMax) return bad("client sequence exceeds 63 bits");
  auto edit = decode_descriptor(view_of(t.edit()));
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
  m.first = t.first();
  m.edits.reserve(t.edits() == nullptr ? 0
                                       : std::min<std::size_t>(t.edits()->size(), kCommitEditsMax));
  OrderedEdit edit;
  std::vector<ChunkCoord> touched;
  const auto ok = read_edits(t, edit, touched, [&m, &edit](Sequence) -> Result<void> {
    m.edits.push_back(std::move(edit));
    return {};
  });
  if (!ok) return Unexpected<Error>{ok.error()};
  return Message{std::move(m)};
}

Result<void> BodyReader::read_edits(const wire::Commit& t, OrderedEdit& edit,
                                    std::vector<ChunkCoord>& touched, const TakeEdit& take) const {
  const auto count = count_of(t.edits(), kCommitEditsMax);
  if (!count || *count == 0) return bad("commit has not 1 .. 4096 edits");
  if (t.epoch() == 0) return bad("commit epoch is 0");
  const Sequence first = t.first();
  if (first == 0 || first > std::numeric_limits<Sequence>::max() - kCommitEditsMax) {
    return bad("commit sequence is out of range");
  }
  std::size_t previous_bytes = 0;
  for (std::uint32_t i = 0; i < *count; ++i) {
    const wire::OrderedEdit& e = *t.edits()->Get(i);
    const Sequence seq = first + i;
    if (const auto ok = read_edit(e, seq, edit); !ok) return ok;
    const ByteView previous = view_of(e.previous());
    previous_bytes += previous.size();
    // Several tables may point at one list: what is decoded would then outgrow the message.
    if (previous_bytes > message_bytes) return bad("commit shares its lists of previous sequences");
    if (const auto ok = read_previous(previous, seq, edit, touched); !ok) return ok;
    if (const auto ok = take(seq); !ok) return ok;
  }
  return {};
}

Result<void> BodyReader::read_edit(const wire::OrderedEdit& e, Sequence seq,
                                   OrderedEdit& out) const {
  out.op = {e.author(), e.instance(), e.client_seq()};
  if (e.cause() > kCauseMax) return bad("commit cause is unknown");
  out.cause = static_cast<Cause>(e.cause());
  out.submitted_us = e.submitted_us();
  out.ordered_us = e.ordered_us();
  if (!is_time(out.submitted_us) || !is_time(out.ordered_us))
    return bad("commit time is out of range");
  out.subject = e.subject();
  if (out.subject >= seq) return bad("commit subject is not an earlier edit");
  auto descriptor = decode_descriptor(view_of(e.edit()));
  if (!descriptor) return Unexpected<Error>{descriptor.error()};
  out.edit = *std::move(descriptor);
  return {};
}

Result<void> BodyReader::read_previous(ByteView bytes, Sequence seq, OrderedEdit& out,
                                       std::vector<ChunkCoord>& touched) const {
  out.previous.clear();
  ByteReader in(bytes);
  while (in.ok() && !in.at_end()) {
    const std::uint64_t back = in.varint_max(seq, "previous sequence lies before the log");
    if (back == 0) in.reject(ErrorCode::bad_value, "an edit cannot precede itself");
    if (out.previous.size() == kTouchedChunksMax)
      in.reject(ErrorCode::limit_exceeded, "edit touches too many chunks");
    if (in.ok()) out.previous.push_back(seq - back);
  }
  if (!in.ok()) return Unexpected<Error>{in.error()};
  if (chunk_edge == 0) return {};
  // The bound comes before the list: a hostile box may touch millions of chunks. Servers reject by
  // the same bound.
  if (touched_chunks_bound(out.edit, chunk_edge) > kTouchedChunksMax) {
    return fail(ErrorCode::limit_exceeded, "edit touches too many chunks");
  }
  touched_chunks(out.edit, chunk_edge, touched);
  if (touched.size() != out.previous.size()) {
    return bad("commit does not list one previous sequence per touched chunk");
  }
  return {};
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
  return Durable{t.epoch(), t.seq()};
}

}  // namespace runstone
