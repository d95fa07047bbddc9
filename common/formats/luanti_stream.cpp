#include "common/formats/luanti_stream.hpp"

#include <zstd.h>

#include <algorithm>
#include <memory>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

struct ZstdDeleter {
  void operator()(ZSTD_DStream* stream) const { ZSTD_freeDStream(stream); }
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

}  // namespace runstone
