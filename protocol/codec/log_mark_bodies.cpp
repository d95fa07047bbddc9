#include <cstdint>
#include <utility>

#include "protocol/codec/body_reader.hpp"

namespace runstone {
namespace {

bool is_in_world(const VoxelPos& at) {
  const auto is_inside = [](std::int32_t c) { return c >= -kWorldLimit && c < kWorldLimit; };
  return is_inside(at.x) && is_inside(at.y) && is_inside(at.z);
}

Result<void> take_mark(const wire::LogMark& t, LogMark& mark) {
  if (t.seq() == 0 || t.seq() > kSequenceMax) return bad("log marks: seq is out of range");
  if (!is_time(t.utc_us())) return bad("log marks: time is out of range");
  if (t.cause() > kLogMarkCauseMax) return bad("log marks: cause is unknown");
  if (t.kind() == 0) return bad("log marks: kind is 0");
  mark = {t.seq(), t.utc_us(), t.author(), static_cast<Cause>(t.cause()),
          static_cast<EditKind>(t.kind())};
  return {};
}

}  // namespace

Result<Message> BodyReader::read(const wire::LogMarksRequest& t) const {
  if (t.request() == 0) return bad("requests for log marks start at 1");
  if (t.first() == 0 || t.first() > t.last() || t.last() > kSequenceMax)
    return bad("log marks: not 1 <= first <= last");
  if (t.count() == 0 || t.count() > kLogMarksMax) return bad("log marks: count is not 1 .. 128");
  LogMarksRequest m{t.request(), t.first(), t.last(), t.count()};
  if (const wire::Corner* const at = t.at()) {
    m.at = VoxelPos{at->x(), at->y(), at->z()};
    if (!is_in_world(*m.at)) return bad("log marks: the voxel is outside the world");
  }
  return m;
}

Result<Message> BodyReader::read(const wire::LogMarks& t) const {
  const auto count = count_of(t.marks(), kLogMarksMax);
  const auto author_count = count_of(t.authors(), kLogMarksMax);
  if (!count || !author_count) return bad("log marks: more than 128 marks or authors");
  // The verifier checks the alignment of a list, not that of its entries.
  if (*count != 0 && reinterpret_cast<std::uintptr_t>(t.marks()->Data()) % alignof(Sequence) != 0)
    return bad("log marks are not aligned");
  LogMarks m;
  m.request = t.request();
  m.first = t.first();
  if (m.request == 0 || m.first == 0 || m.first > kSequenceMax)
    return bad("log marks: request or first is out of range");
  if (!take_text(t.refused(), 0, kTextBytesMax, m.refusal))
    return bad("log marks: refusal is not 0 .. 256 bytes of text");
  if (!m.refusal.empty() && *count + *author_count != 0) return bad("refused log marks are given");
  m.marks.resize(*count);
  for (std::uint32_t i = 0; i < *count; ++i) {
    if (const auto ok = take_mark(*t.marks()->Get(i), m.marks[i]); !ok) return failure(ok.error());
    if (i > 0 && m.marks[i].seq <= m.marks[i - 1].seq) return bad("log marks do not ascend");
  }
  m.authors.resize(*author_count);
  for (std::uint32_t i = 0; i < *author_count; ++i) {
    const wire::LogAuthor& from = *t.authors()->Get(i);
    m.authors[i].author = from.author();
    if (from.author() == 0 || (i > 0 && from.author() <= m.authors[i - 1].author))
      return bad("authors of log marks do not ascend from 1");
    if (!take_text(from.name(), 1, kPlayerNameBytesMax, m.authors[i].name))
      return bad("log marks: name is not 1 .. 32 bytes of text");
  }
  return m;
}

}  // namespace runstone
