#include "common/formats/luanti_stream.hpp"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <memory>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

struct ZstdDeleter {
  void operator()(ZSTD_DStream* stream) const { ZSTD_freeDStream(stream); }
};

struct ZlibDeleter {
  void operator()(z_stream* stream) const { inflateEnd(stream); }
};

}  // namespace

// The streaming calls are needed, because Luanti writes no content size.
Result<Bytes> unpack_zstd(ByteView data, std::size_t at, std::size_t bytes_max) {
  const std::unique_ptr<ZSTD_DStream, ZstdDeleter> stream(ZSTD_createDStream());
  RUNSTONE_ASSERT(stream != nullptr);
  Bytes out(std::min(std::size_t{20} << 10, bytes_max));  // nearly every block fits
  ZSTD_inBuffer source{data.data(), data.size(), at};
  std::size_t filled = 0;
  while (true) {
    ZSTD_outBuffer target{out.data(), out.size(), filled};
    const std::size_t status = ZSTD_decompressStream(stream.get(), &target, &source);
    if (ZSTD_isError(status) != 0) {
      return fail(ErrorCode::bad_value, "luanti block: not a zstd stream, or a damaged one",
                  source.pos);
    }
    filled = target.pos;
    if (status == 0) {
      out.resize(filled);
      return out;
    }
    if (filled < out.size()) {
      // The output has room left, so the stream needs more input, but all input was consumed.
      return fail(ErrorCode::truncated, "luanti block: the zstd stream ends early", source.pos);
    }
    if (out.size() == bytes_max) return out;
    out.resize(std::min(out.size() * 4, bytes_max));
  }
}

Result<std::size_t> unpack_zlib(ByteView data, std::size_t at, std::size_t bytes_max, Bytes* out) {
  RUNSTONE_ASSERT(at <= data.size());
  if (data.size() > UINT32_MAX)
    return fail(ErrorCode::limit_exceeded, "luanti block: more than 4 GiB");
  z_stream stream{};
  const int begun = inflateInit(&stream);
  RUNSTONE_ASSERT(begun == Z_OK);
  const std::unique_ptr<z_stream, ZlibDeleter> end(&stream);
  stream.next_in = const_cast<Bytef*>(data.data() + at);
  stream.avail_in = static_cast<uInt>(data.size() - at);
  std::array<std::uint8_t, 16384> part;
  std::size_t total = 0;
  while (true) {
    stream.next_out = part.data();
    stream.avail_out = static_cast<uInt>(part.size());
    const int status = inflate(&stream, Z_NO_FLUSH);
    const std::size_t offset = data.size() - stream.avail_in;
    if (status == Z_BUF_ERROR)
      return fail(ErrorCode::truncated, "luanti block: a zlib stream ends early", offset);
    if (status != Z_OK && status != Z_STREAM_END)
      return fail(ErrorCode::bad_value, "luanti block: not a zlib stream, or a damaged one",
                  offset);
    const std::size_t made = part.size() - stream.avail_out;
    total += made;
    if (total > bytes_max)
      return fail(ErrorCode::limit_exceeded, "luanti block: a zlib stream is too long", offset);
    if (out != nullptr) out->insert(out->end(), part.data(), part.data() + made);
    if (status == Z_STREAM_END) return offset;
  }
}

}  // namespace runstone
