#include "protocol/chunks/zstd_frame.hpp"

#include <zstd.h>

#include <memory>
#include <new>

#include "protocol/chunks/codec_scratch.hpp"

namespace runstone {
namespace {

struct FreeDecompressor {
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

struct UnpackScratch {
  Bytes body;
  std::unique_ptr<ZSTD_DCtx, FreeDecompressor> decompressor;
};

}  // namespace

Result<ByteView> unpack_zstd_frame(ByteView frame, std::size_t bytes) {
  if (ZSTD_getFrameContentSize(frame.data(), frame.size()) != bytes) {
    return fail(ErrorCode::bad_value, "zstd frame of another size than the body");
  }
  if (ZSTD_findFrameCompressedSize(frame.data(), frame.size()) != frame.size()) {
    return fail(ErrorCode::trailing_bytes, "zstd frame is truncated or bytes follow it");
  }
  thread_local UnpackScratch s;
  if (!s.decompressor) s.decompressor.reset(ZSTD_createDCtx());
  if (!s.decompressor) throw std::bad_alloc();
  keep_small(s.body);
  s.body.resize(bytes);
  const std::size_t size =
      ZSTD_decompressDCtx(s.decompressor.get(), s.body.data(), bytes, frame.data(), frame.size());
  if (ZSTD_isError(size) != 0 || size != bytes)
    return fail(ErrorCode::bad_checksum, "zstd frame is damaged");
  return ByteView(s.body);
}

}  // namespace runstone
