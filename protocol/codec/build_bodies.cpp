#include <cstdint>
#include <utility>

#include "common/edits/descriptor/library_change.hpp"
#include "protocol/codec/body_reader.hpp"

namespace runstone {
namespace {

constexpr std::uint64_t kFileBytesMax = kLibraryFileBytesMax;

Result<void> take_build(const wire::ListedBuild& t, ListedBuild& build) {
  build.number = t.number();
  if (build.number == 0 || build.number > kSequenceMax)
    return bad("builds: a number is out of range");
  ByteReader info(view_of(t.info()));
  build.info = read_build_info(info);
  if (!info.finish()) return bad("builds: an info is damaged");
  build.touched = t.touched();
  if (build.touched == 0 || build.touched > build.info.sides.volume())
    return bad("builds: touched is not 1 .. volume");
  build.file_bytes = t.file_bytes();
  if (build.file_bytes == 0 || build.file_bytes > kFileBytesMax)
    return bad("builds: file_bytes is out of range");
  build.added_by = t.added_by();
  if (!take_text(t.added_by_name(), 0, kPlayerNameBytesMax, build.added_by_name))
    return bad("builds: the name of a player is not 0 .. 32 bytes of text");
  return {};
}

}  // namespace

Result<Message> BodyReader::read(const wire::BuildsRequest& t) const {
  BuildsRequest m;
  m.request = t.request();
  m.before = t.before();
  m.count = t.count();
  if (m.request == 0) return bad("requests about builds start at 1");
  if (m.before == 0 || m.before > kSequenceMax)
    return bad("builds request: before is out of range");
  if (m.count == 0 || m.count > kListedBuildsMax)
    return bad("builds request: count is not 1 .. 50");
  if (!take_text(t.name(), 0, kBuildNameBytesMax, m.name) ||
      !take_text(t.author(), 0, kBuildAuthorBytesMax, m.author) ||
      !take_text(t.tag(), 0, kBuildTagBytesMax, m.tag))
    return bad("builds request: name, author or tag is no text or too long");
  return m;
}

Result<Message> BodyReader::read(const wire::Builds& t) const {
  const auto count = count_of(t.builds(), kListedBuildsMax);
  if (!count) return bad("builds: more than 50");
  Builds m;
  m.request = t.request();
  m.has_more = t.more();
  m.total = t.total();
  if (m.request == 0) return bad("requests about builds start at 1");
  if (!take_text(t.refused(), 0, kTextBytesMax, m.refusal))
    return bad("builds: refusal is not 0 .. 256 bytes of text");
  if (!m.refusal.empty() && *count != 0) return bad("refused builds are given");
  m.builds.resize(*count);
  for (std::uint32_t i = 0; i < *count; ++i) {
    if (const auto ok = take_build(*t.builds()->Get(i), m.builds[i]); !ok)
      return failure(ok.error());
    if (i > 0 && m.builds[i].number >= m.builds[i - 1].number) return bad("builds do not descend");
  }
  return m;
}

Result<Message> BodyReader::read(const wire::BuildPieceRequest& t) const {
  if (t.request() == 0) return bad("requests about builds start at 1");
  if (t.number() == 0 || t.number() > kSequenceMax)
    return bad("build piece request: number is out of range");
  if (t.offset() % kBuildPieceBytes != 0 || t.offset() >= kFileBytesMax)
    return bad("build piece request: offset is no multiple of 65536 below 2^30");
  return BuildPieceRequest{t.request(), t.number(), t.offset()};
}

Result<Message> BodyReader::read(const wire::BuildPiece& t) const {
  BuildPiece m;
  m.request = t.request();
  if (m.request == 0) return bad("requests about builds start at 1");
  const ByteView bytes = view_of(t.bytes());
  if (bytes.size() > kBuildPieceBytes) return bad("build piece: more than 65536 bytes");
  if (!take_text(t.refused(), 0, kTextBytesMax, m.refusal))
    return bad("build piece: refusal is not 0 .. 256 bytes of text");
  if (bytes.empty() == m.refusal.empty())
    return bad("build piece: has bytes and a refusal, or neither");
  m.bytes.assign(bytes.begin(), bytes.end());
  return m;
}

Result<Message> BodyReader::read(const wire::BuildOffer& t) const {
  if (t.request() == 0) return bad("requests about builds start at 1");
  if (t.file_bytes() == 0 || t.file_bytes() > kFileBytesMax)
    return bad("build offer: file_bytes is out of range");
  return BuildOffer{t.request(), t.file_bytes()};
}

Result<Message> BodyReader::read(const wire::BuildUpload& t) const {
  BuildUpload m;
  m.request = t.request();
  m.offset = t.offset();
  const ByteView bytes = view_of(t.bytes());
  if (m.request == 0) return bad("requests about builds start at 1");
  if (bytes.empty() || bytes.size() > kBuildUploadBytesMax)
    return bad("build upload: not 1 .. 32768 bytes");
  if (m.offset >= kFileBytesMax) return bad("build upload: offset is out of range");
  m.bytes.assign(bytes.begin(), bytes.end());
  return m;
}

Result<Message> BodyReader::read(const wire::BuildAnswer& t) const {
  BuildAnswer m;
  m.request = t.request();
  m.received = t.received();
  m.number = t.number();
  if (m.request == 0) return bad("requests about builds start at 1");
  if (m.received > kFileBytesMax || m.number > kSequenceMax)
    return bad("build answer: received or number is out of range");
  if (!take_text(t.refused(), 0, kTextBytesMax, m.refusal))
    return bad("build answer: refusal is not 0 .. 256 bytes of text");
  if (m.number != 0 && !m.refusal.empty()) return bad("build answer: added and refused");
  return m;
}

}  // namespace runstone
