#include "common/formats/rsb_block.hpp"

#include <xxhash.h>
#include <zstd.h>

#include <algorithm>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

constexpr std::size_t kRsbChecksummedBytes = kRsbHeaderBytes - sizeof(std::uint64_t);

Result<void> check_rsb_bounds(const RsbBlock& block) {
  const auto bad = [](const char* what) { return fail(ErrorCode::bad_value, what); };
  if (block.raw_bytes > kRsbRawBytesMax)
    return fail(ErrorCode::limit_exceeded, "block is too long");
  if (block.count > kRsbCountMax)
    return fail(ErrorCode::limit_exceeded, "block has too many entries");
  if (block.stored_bytes > block.raw_bytes) return bad("block is longer packed than unpacked");
  if (block.stored_bytes == 0) return bad("block has no payload");
  const bool has_entries = block.kind == RsbKind::materials || block.kind == RsbKind::sections;
  if (has_entries != (block.count != 0)) return bad("block of this kind cannot have this count");
  if (!has_entries && block.first != 0) return bad("block without entries has a first entry");
  return {};
}

}  // namespace

std::string RsbError::message() const {
  return std::string(part) + " at byte " + std::to_string(position) + ": " + error.what;
}

RsbSource rsb_source(ByteView file) {
  return [file](std::uint64_t position, std::span<std::uint8_t> out) -> std::optional<std::size_t> {
    if (position >= file.size()) return 0;
    const ByteView rest = file.subspan(static_cast<std::size_t>(position));
    const std::size_t count = std::min(out.size(), rest.size());
    std::copy_n(rest.begin(), count, out.begin());
    return count;
  };
}

const char* rsb_part_name(RsbKind kind) {
  switch (kind) {
    case RsbKind::head:
      return "head";
    case RsbKind::materials:
      return "materials";
    case RsbKind::sections:
      return "sections";
    case RsbKind::end:
      return "end";
  }
  return "block";
}

void write_rsb_header(RsbBlock& block, std::uint64_t checksum_before, Bytes& out) {
  RUNSTONE_ASSERT(check_rsb_bounds(block).has_value());
  const std::size_t begin = out.size();
  ByteWriter w(out);
  w.u32(static_cast<std::uint32_t>(block.kind));
  w.u32(block.stored_bytes);
  w.u32(block.raw_bytes);
  w.u32(block.count);
  w.u64(block.first);
  w.u64(block.position);
  w.u64(block.payload_checksum);
  block.header_checksum =
      XXH3_64bits_withSeed(out.data() + begin, kRsbChecksummedBytes, checksum_before);
  w.u64(block.header_checksum);
}

Result<RsbBlock> read_rsb_header(ByteView in, std::uint64_t checksum_before) {
  if (in.size() < kRsbHeaderBytes)
    return fail(ErrorCode::truncated, "file ends inside a block header");
  ByteReader r(in.first(kRsbHeaderBytes));
  const std::uint32_t kind = r.u32();
  RsbBlock block;
  block.stored_bytes = r.u32();
  block.raw_bytes = r.u32();
  block.count = r.u32();
  block.first = r.u64();
  block.position = r.u64();
  block.payload_checksum = r.u64();
  block.header_checksum = r.u64();
  if (block.header_checksum !=
      XXH3_64bits_withSeed(in.data(), kRsbChecksummedBytes, checksum_before)) {
    return fail(ErrorCode::bad_checksum, "checksum of the block header is wrong");
  }
  if (kind < 1 || kind > static_cast<std::uint32_t>(RsbKind::end))
    return fail(ErrorCode::unknown_kind, "unknown kind of block");
  block.kind = static_cast<RsbKind>(kind);
  if (const auto bounds = check_rsb_bounds(block); !bounds) return failure(bounds.error());
  return block;
}

std::uint64_t rsb_payload_checksum(ByteView stored) {
  return XXH3_64bits(stored.data(), stored.size());
}

void pack_rsb_payload(ByteView raw, int level, Bytes& out) {
  if (level != 0 && raw.size() > 1) {
    // zstd fails if this room does not suffice; then compression gains nothing.
    out.resize(raw.size() - 1);
    const std::size_t size = ZSTD_compress(out.data(), out.size(), raw.data(), raw.size(), level);
    if (ZSTD_isError(size) == 0) {
      out.resize(size);
      return;
    }
  }
  out.assign(raw.begin(), raw.end());
}

Result<void> unpack_rsb_payload(ByteView stored, std::uint32_t raw_bytes, Bytes& out) {
  RUNSTONE_ASSERT(stored.size() <= raw_bytes && raw_bytes <= kRsbRawBytesMax);
  if (stored.size() == raw_bytes) {
    out.assign(stored.begin(), stored.end());
    return {};
  }
  if (ZSTD_getFrameContentSize(stored.data(), stored.size()) != raw_bytes)
    return fail(ErrorCode::bad_value, "zstd frame of another size than announced");
  if (ZSTD_findFrameCompressedSize(stored.data(), stored.size()) != stored.size())
    return fail(ErrorCode::trailing_bytes, "zstd frame is cut or something follows it");
  out.resize(raw_bytes);
  const std::size_t size = ZSTD_decompress(out.data(), out.size(), stored.data(), stored.size());
  if (ZSTD_isError(size) != 0 || size != raw_bytes)
    return fail(ErrorCode::bad_checksum, "zstd frame is damaged");
  return {};
}

}  // namespace runstone
