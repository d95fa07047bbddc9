#include "bench/wire/luanti_form.hpp"

#include <zstd.h>

#include <algorithm>
#include <memory>

#include "common/core/assert.hpp"

namespace runstone::bench {
namespace {

constexpr int kLuantiLevel = 3;
constexpr std::uint8_t kNetworkVersion = 2;
constexpr std::size_t kPlainBytesMax = std::size_t{1} << 20;

struct Free {
  void operator()(ZSTD_CStream* stream) const { ZSTD_freeCStream(stream); }
  void operator()(ZSTD_DStream* stream) const { ZSTD_freeDStream(stream); }
};

struct LuantiScratch {
  std::unique_ptr<ZSTD_CStream, Free> compressor{ZSTD_createCStream()};
  std::unique_ptr<ZSTD_DStream, Free> decompressor{ZSTD_createDStream()};
  Bytes plain;  // of the block to send
  // The buffer is never cleared, because only the bytes that were read into it are used.
  Bytes received = Bytes(kPlainBytesMax);
};

LuantiScratch& luanti_scratch() {
  thread_local LuantiScratch mine;
  return mine;
}

void put_u16(Bytes& out, unsigned v) {
  out.push_back(static_cast<std::uint8_t>(v >> 8));
  out.push_back(static_cast<std::uint8_t>(v));
}

unsigned get_u16(ByteReader& in) {
  const unsigned high = in.u8();
  return high << 8 | in.u8();
}

struct Stream {
  ByteView plain;         // a part of the scratch
  std::size_t bytes = 0;  // length of the stream
};

/// Decompresses one stream from the front of `in`.
Result<Stream> decompress(ByteView in, LuantiScratch& s) {
  ZSTD_initDStream(s.decompressor.get());
  ZSTD_inBuffer source{in.data(), in.size(), 0};
  ZSTD_outBuffer target{s.received.data(), s.received.size(), 0};
  const std::size_t left = ZSTD_decompressStream(s.decompressor.get(), &target, &source);
  if (ZSTD_isError(left) != 0 || left != 0)
    return fail(ErrorCode::bad_value, "not one whole zstd stream");
  return Stream{ByteView(s.received).first(target.pos), source.pos};
}

/// Reads what follows the head of a block in both of its forms.
Result<void> read_nodes(ByteReader& in, LuantiNodes& out) {
  if (in.u8() != 2 || in.u8() != 2)
    in.reject(ErrorCode::bad_value, "ids or parameters of another width");
  const ByteView planes = in.bytes(4 * kLuantiNodes);
  if (!in.ok()) return failure(in.error());
  for (std::size_t i = 0; i < kLuantiNodes; ++i) {
    out.id[i] = static_cast<std::uint16_t>(planes[2 * i] << 8 | planes[2 * i + 1]);
  }
  std::copy_n(planes.begin() + 2 * kLuantiNodes, kLuantiNodes, out.param1.begin());
  std::copy_n(planes.begin() + 3 * kLuantiNodes, kLuantiNodes, out.param2.begin());
  return {};
}

}  // namespace

void encode_luanti_block(const LuantiNodes& nodes, Bytes& out) {
  LuantiScratch& s = luanti_scratch();
  s.plain.assign({0, 0xff, 0xff, 2, 2});
  for (const std::uint16_t id : nodes.id) put_u16(s.plain, id);
  s.plain.insert(s.plain.end(), nodes.param1.begin(), nodes.param1.end());
  s.plain.insert(s.plain.end(), nodes.param2.begin(), nodes.param2.end());
  s.plain.push_back(0);

  const std::size_t at = out.size();
  out.resize(at + ZSTD_compressBound(s.plain.size()));
  ZSTD_initCStream(s.compressor.get(), kLuantiLevel);
  ZSTD_inBuffer source{s.plain.data(), s.plain.size(), 0};
  ZSTD_outBuffer target{out.data() + at, out.size() - at, 0};
  // There are two calls, as in Luanti. If the call that ends the frame had all input, zstd would
  // write the content size.
  ZSTD_compressStream2(s.compressor.get(), &target, &source, ZSTD_e_continue);
  const std::size_t left = ZSTD_compressStream2(s.compressor.get(), &target, &source, ZSTD_e_end);
  RUNSTONE_ASSERT(left == 0);
  out.resize(at + target.pos);
  out.push_back(kNetworkVersion);
}

Result<void> decode_luanti_wire(ByteView block, LuantiNodes& out) {
  const auto stream = decompress(block, luanti_scratch());
  if (!stream) return failure(stream.error());
  if (stream->bytes + 1 != block.size() || block.back() != kNetworkVersion) {
    return fail(ErrorCode::trailing_bytes, "block does not end as it should");
  }
  ByteReader in(stream->plain);
  in.bytes(1 + 2);
  return read_nodes(in, out);
}

Result<void> decode_luanti_row(ByteView row, LuantiNodes& out) {
  if (row.empty() || row[0] != 29) return fail(ErrorCode::bad_version, "row is not of version 29");
  const auto stream = decompress(row.subspan(1), luanti_scratch());
  if (!stream) return failure(stream.error());
  ByteReader in(stream->plain);
  in.bytes(1 + 2 + 4);
  in.u8();
  const unsigned names = get_u16(in);
  for (unsigned i = 0; i < names && in.ok(); ++i) {
    get_u16(in);
    in.bytes(get_u16(in));
  }
  return read_nodes(in, out);
}

}  // namespace runstone::bench
