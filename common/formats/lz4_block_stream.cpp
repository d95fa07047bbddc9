#include "common/formats/lz4_block_stream.hpp"

#include <lz4.h>
#include <xxhash.h>

#include <algorithm>
#include <string_view>

namespace runstone {
namespace {

constexpr std::string_view kLz4Mark = "LZ4Block";
constexpr std::uint8_t kLz4Stored = 0x10, kLz4Packed = 0x20;  // high half of the token
constexpr unsigned kLz4SmallestBlockBits = 10;                // plus the low half of the token
constexpr std::uint32_t kLz4Seed = 0x9747b28c, kLz4ChecksumMask = 0x0fffffff;

}  // namespace

Result<void> unpack_lz4_blocks(ByteView data, std::size_t bytes_max, Bytes& out) {
  ByteReader in(data);
  const std::size_t begin = out.size();
  while (true) {
    const std::size_t at = in.offset();
    const ByteView mark = in.bytes(kLz4Mark.size());
    if (in.ok() && !std::equal(mark.begin(), mark.end(), kLz4Mark.begin()))
      return fail(ErrorCode::bad_value, "lz4 stream: a block does not begin with its mark", at);
    const std::uint8_t token = in.u8();
    const std::uint32_t packed_bytes = in.u32();
    const std::uint32_t plain_bytes = in.u32();
    const std::uint32_t checksum = in.u32();
    const ByteView packed = in.bytes(packed_bytes);
    if (!in.ok()) return fail(ErrorCode::truncated, "lz4 stream: a block ends early", at);
    const auto method = static_cast<std::uint8_t>(token & 0xf0);
    if (method != kLz4Stored && method != kLz4Packed)
      return fail(ErrorCode::unknown_kind, "lz4 stream: unknown method of a block", at);
    if (plain_bytes == 0) return {};
    if (plain_bytes > (1U << (kLz4SmallestBlockBits + (token & 0x0f))))
      return fail(ErrorCode::bad_value, "lz4 stream: a block is larger than its token allows", at);
    if (plain_bytes > bytes_max - (out.size() - begin))
      return fail(ErrorCode::limit_exceeded, "lz4 stream: decompresses to too many bytes", at);
    // A block of LZ4 has at least one byte for each 255 of its output.
    if (method == kLz4Stored ? packed_bytes != plain_bytes
                             : std::uint64_t{packed_bytes} * 255 < plain_bytes)
      return fail(ErrorCode::bad_value, "lz4 stream: size of a block is wrong", at);
    const std::size_t filled = out.size();
    out.resize(filled + plain_bytes);
    if (method == kLz4Stored) {
      std::copy(packed.begin(), packed.end(), out.begin() + static_cast<std::ptrdiff_t>(filled));
    } else if (LZ4_decompress_safe(reinterpret_cast<const char*>(packed.data()),
                                   reinterpret_cast<char*>(out.data() + filled),
                                   static_cast<int>(packed_bytes), static_cast<int>(plain_bytes)) !=
               static_cast<int>(plain_bytes)) {
      return fail(ErrorCode::bad_value, "lz4 stream: a block is damaged", at);
    }
    if ((XXH32(out.data() + filled, plain_bytes, kLz4Seed) & kLz4ChecksumMask) != checksum)
      return fail(ErrorCode::bad_checksum, "lz4 stream: checksum of a block is wrong", at);
  }
}

}  // namespace runstone
