#include "common/rlog/rlog_block.hpp"

#include <xxhash.h>
#include <zstd.h>

namespace runstone {
namespace {

constexpr std::size_t kChecksummedBytes = kRlogHeaderBytes - sizeof(std::uint64_t);

Result<void> check_bounds(const RlogBlock& block) {
  const auto bad = [](const char* what) { return fail(ErrorCode::bad_value, what); };
  if (block.raw_bytes > kRlogRawBytesMax)
    return fail(ErrorCode::limit_exceeded, "block is too long");
  if (block.count > kRlogCountMax)
    return fail(ErrorCode::limit_exceeded, "block has too many entries");
  if (block.stored_bytes > block.raw_bytes) return bad("block is longer packed than unpacked");
  if (block.first == 0 || block.first > kSequenceMax)
    return bad("block begins at an impossible sequence");
  const bool has_entries = block.kind == RlogKind::edits || block.kind == RlogKind::players;
  if (has_entries != (block.count != 0)) return bad("block of this kind cannot have this count");
  if ((block.kind == RlogKind::end) != (block.stored_bytes == 0)) {
    return bad("block of this kind cannot have this length");
  }
  if ((block.raw_bytes == 0) != (block.stored_bytes == 0)) return bad("block has one length of 0");
  if (block.kind == RlogKind::edits && block.count - 1 > kSequenceMax - block.first) {
    return bad("block ends at an impossible sequence");
  }
  if (block.last_us < block.first_us ||
      (block.kind != RlogKind::edits && block.last_us != block.first_us)) {
    return bad("block ends before it begins");
  }
  return {};
}

}  // namespace

std::string RlogError::message() const {
  return "edit " + std::to_string(seq) + " at byte " + std::to_string(position) + ": " + error.what;
}

void write_header(RlogBlock& block, std::uint64_t checksum_before, Bytes& out) {
  RUNSTONE_ASSERT(check_bounds(block).has_value());
  const std::size_t begin = out.size();
  ByteWriter w(out);
  w.u32(static_cast<std::uint32_t>(block.kind));
  w.u32(block.stored_bytes);
  w.u32(block.raw_bytes);
  w.u32(block.count);
  w.u64(block.first);
  w.u64(static_cast<std::uint64_t>(block.first_us));
  w.u64(static_cast<std::uint64_t>(block.last_us));
  w.u64(block.position);
  w.u64(block.payload_checksum);
  block.header_checksum =
      XXH3_64bits_withSeed(out.data() + begin, kChecksummedBytes, checksum_before);
  w.u64(block.header_checksum);
}

Result<RlogBlock> read_header(ByteView in, std::uint64_t checksum_before) {
  if (in.size() < kRlogHeaderBytes)
    return fail(ErrorCode::truncated, "file ends inside a block header");
  ByteReader r(in.first(kRlogHeaderBytes));
  const std::uint32_t kind = r.u32();
  RlogBlock block;
  block.stored_bytes = r.u32();
  block.raw_bytes = r.u32();
  block.count = r.u32();
  block.first = r.u64();
  block.first_us = static_cast<TimeUs>(r.u64());
  block.last_us = static_cast<TimeUs>(r.u64());
  block.position = r.u64();
  block.payload_checksum = r.u64();
  block.header_checksum = r.u64();
  if (block.header_checksum !=
      XXH3_64bits_withSeed(in.data(), kChecksummedBytes, checksum_before)) {
    return fail(ErrorCode::bad_checksum, "checksum of the block header is wrong");
  }
  if (kind < 1 || kind > static_cast<std::uint32_t>(RlogKind::end)) {
    return fail(ErrorCode::unknown_kind, "unknown kind of block");
  }
  block.kind = static_cast<RlogKind>(kind);
  if (const auto bounds = check_bounds(block); !bounds) return failure(bounds.error());
  return block;
}

std::uint64_t rlog_payload_checksum(ByteView stored) {
  return XXH3_64bits(stored.data(), stored.size());
}

void pack_rlog_payload(ByteView raw, int level, Bytes& out) {
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

Result<void> unpack_rlog_payload(ByteView stored, std::uint32_t raw_bytes, Bytes& out) {
  RUNSTONE_ASSERT(stored.size() <= raw_bytes && raw_bytes <= kRlogRawBytesMax);
  if (stored.size() == raw_bytes) {
    out.assign(stored.begin(), stored.end());
    return {};
  }
  if (ZSTD_getFrameContentSize(stored.data(), stored.size()) != raw_bytes) {
    return fail(ErrorCode::bad_value, "zstd frame of another size than announced");
  }
  if (ZSTD_findFrameCompressedSize(stored.data(), stored.size()) != stored.size()) {
    return fail(ErrorCode::trailing_bytes, "zstd frame is cut or something follows it");
  }
  out.resize(raw_bytes);
  const std::size_t size = ZSTD_decompress(out.data(), out.size(), stored.data(), stored.size());
  if (ZSTD_isError(size) != 0 || size != raw_bytes) {
    return fail(ErrorCode::bad_checksum, "zstd frame is damaged");
  }
  return {};
}

}  // namespace runstone
