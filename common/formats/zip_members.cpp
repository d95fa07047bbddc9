#include "common/formats/zip_members.hpp"

#include <algorithm>

namespace runstone {
namespace {

constexpr std::uint32_t kZipEndMark = 0x06054b50, kZipEntryMark = 0x02014b50,
                        kZipLocalMark = 0x04034b50;
constexpr std::size_t kZipEndBytes = 22, kZipLocalBytes = 30;
constexpr std::uint16_t kZipMembersMax = 1024;
constexpr std::uint32_t kZipIn64 = 0xffff'ffff;
/// Deflate makes at most this many bytes of one.
constexpr std::uint64_t kDeflateFactorMax = 1032;

std::string_view zip_text(ByteView bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Result<ZipMember> read_zip_entry(ByteView file, ByteReader& in) {
  const std::size_t begin = in.offset();
  const auto bad = [&](ErrorCode code, const char* what) { return fail(code, what, begin); };
  if (in.u32() != kZipEntryMark && in.ok())
    return bad(ErrorCode::bad_value, "zip: an entry of the directory has another mark");
  in.u16();  // versions
  in.u16();
  const std::uint16_t flags = in.u16(), method = in.u16();
  in.u32();  // time
  ZipMember out;
  out.checksum = in.u32();
  std::uint64_t packed_bytes = in.u32();
  out.bytes = in.u32();
  const std::uint16_t name_bytes = in.u16(), extra_bytes = in.u16(), comment_bytes = in.u16();
  in.bytes(2 + 2 + 4);  // disk, attributes
  std::uint64_t local = in.u32();
  out.name = zip_text(in.bytes(name_bytes));
  ByteReader extra(in.bytes(extra_bytes));
  in.bytes(comment_bytes);
  if (!in.ok()) return bad(ErrorCode::truncated, "zip: the directory is cut");
  while (extra.left() >= 4) {
    const std::uint16_t id = extra.u16(), size = extra.u16();
    if (size > extra.left()) break;
    ByteReader wide(extra.bytes(size));
    if (id != 1) continue;
    for (std::uint64_t* field : {&out.bytes, &packed_bytes, &local}) {
      if (*field == kZipIn64 && wide.left() >= 8) *field = wide.u64();
    }
  }
  if ((flags & 1) != 0) return bad(ErrorCode::bad_value, "zip: a member is encrypted");
  if (method != 0 && method != 8)
    return bad(ErrorCode::bad_value, "zip: a member is neither stored nor deflated");
  out.is_deflated = method == 8;
  if (local > file.size() || file.size() - local < kZipLocalBytes)
    return bad(ErrorCode::bad_value, "zip: a member lies outside the file");
  ByteReader head(file.subspan(static_cast<std::size_t>(local)));
  if (head.u32() != kZipLocalMark)
    return bad(ErrorCode::bad_value, "zip: a member has another mark");
  head.bytes(22);
  const std::size_t before = std::size_t{head.u16()} + head.u16();
  head.bytes(before);
  if (!head.ok() || packed_bytes > head.left())
    return bad(ErrorCode::bad_value, "zip: a member lies outside the file");
  out.offset = static_cast<std::size_t>(local) + head.offset();
  out.packed = head.bytes(static_cast<std::size_t>(packed_bytes));
  const bool is_possible = out.is_deflated ? out.bytes / kDeflateFactorMax <= packed_bytes + 64
                                           : out.bytes == packed_bytes;
  if (!is_possible) return bad(ErrorCode::bad_value, "zip: a member has another size than it says");
  return out;
}

}  // namespace

Result<std::vector<ZipMember>> zip_members(ByteView file) {
  if (file.size() < kZipEndBytes)
    return fail(ErrorCode::truncated, "zip: is shorter than a directory", file.size());
  // A comment of at most 65,535 bytes follows the directory.
  const std::size_t last = file.size() - kZipEndBytes;
  const std::size_t first = last - std::min<std::size_t>(last, 65'535);
  for (std::size_t at = last + 1; at-- > first;) {
    ByteReader end(file.subspan(at));
    if (end.u32() != kZipEndMark) continue;
    end.bytes(2 + 2 + 2);
    const std::uint16_t count = end.u16();
    const std::uint32_t bytes = end.u32(), offset = end.u32();
    if (end.u16() != end.left()) continue;
    if (count > kZipMembersMax)
      return fail(ErrorCode::limit_exceeded, "zip: more than 1024 members", at);
    if (offset > at || bytes > at - offset)
      return fail(ErrorCode::bad_value, "zip: the directory lies outside the file", at);
    ByteReader in(file.first(offset + std::size_t{bytes}));
    in.bytes(offset);
    std::vector<ZipMember> out;
    for (std::uint16_t i = 0; i < count; ++i) {
      auto member = read_zip_entry(file, in);
      if (!member) return failure(member.error());
      out.push_back(*std::move(member));
    }
    return out;
  }
  return fail(ErrorCode::truncated, "zip: the directory at the end is missing", file.size());
}

}  // namespace runstone
