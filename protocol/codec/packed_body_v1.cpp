#include "protocol/codec/packed_body_v1.hpp"

#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <vector>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

constexpr std::size_t kScratchBytesKept = 1 << 20;  // one huge chunk must not hold memory for ever

struct FreeContext {
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

struct Scratch {
  std::vector<std::uint8_t> used;  // by palette index
  Bytes body;
  std::unique_ptr<ZSTD_DCtx, FreeContext> decompressor;
};

Scratch& scratch() {
  thread_local Scratch mine;
  return mine;
}

/// Exactly one frame that announces and holds `bytes` bytes.
Result<ByteView> decompress(ByteView frame, std::size_t bytes, Scratch& s) {
  if (ZSTD_getFrameContentSize(frame.data(), frame.size()) != bytes) {
    return fail(ErrorCode::bad_value, "zstd frame of another size than the body");
  }
  if (ZSTD_findFrameCompressedSize(frame.data(), frame.size()) != frame.size()) {
    return fail(ErrorCode::trailing_bytes, "zstd frame is cut or something follows it");
  }
  if (!s.decompressor) s.decompressor.reset(ZSTD_createDCtx());
  RUNSTONE_ASSERT(s.decompressor != nullptr);
  if (s.body.capacity() > kScratchBytesKept) Bytes().swap(s.body);
  s.body.resize(bytes);
  const std::size_t size =
      ZSTD_decompressDCtx(s.decompressor.get(), s.body.data(), bytes, frame.data(), frame.size());
  if (ZSTD_isError(size) != 0 || size != bytes) return fail(ErrorCode::bad_checksum, "zstd frame is damaged");
  return ByteView(s.body);
}

/// The one pass over runs: calls put(run, end, material) for each.
template <class Index, class Put>
Result<void> read_planes(ByteView body, std::size_t count, std::span<const Material> palette,
                         std::uint32_t volume, std::uint8_t* used, Put&& put) {
  const std::uint8_t* index_at = body.data();
  const std::uint8_t* at = index_at + count * sizeof(Index);
  const std::uint8_t* const stop = body.data() + body.size();
  std::uint32_t end = 0;
  for (std::size_t i = 0; i < count; ++i, index_at += sizeof(Index)) {
    Index index;
    std::memcpy(&index, index_at, sizeof(Index));
    if (index >= palette.size())
      return fail(ErrorCode::broken_invariant, "palette index behind the palette", i);
    used[index] = 1;
    if (i + 1 == count) {
      end = volume;
    } else {
      if (at == stop) return fail(ErrorCode::truncated, "body ends inside the run lengths", body.size());
      std::uint32_t length = *at++;
      for (unsigned shift = 7; length >> shift != 0; shift += 7) {  // the last byte read said "more"
        if (at == stop) return fail(ErrorCode::truncated, "body ends inside the run lengths", body.size());
        const std::uint32_t byte = *at++;
        if (byte == 0) return fail(ErrorCode::broken_invariant, "run length is longer than needed", i);
        length = (length & ((1u << shift) - 1)) | byte << shift;
        if (shift == 14 && byte >= 0x80)
          return fail(ErrorCode::broken_invariant, "run length exceeds 21 bits", i);
      }
      if (length > volume - end) return fail(ErrorCode::broken_invariant, "run ends behind the volume", i);
      end += length;
    }
    put(i, end, palette[index]);
  }
  if (at != stop) {
    return fail(ErrorCode::trailing_bytes, "bytes follow the run lengths",
                static_cast<std::uint64_t>(at - body.data()));
  }
  return {};
}

template <class Put>
Result<void> read_planes(ByteView body, std::size_t count, std::span<const Material> palette,
                         std::uint32_t volume, std::uint8_t* used, Put&& put) {
  if (palette.size() > 256) return read_planes<std::uint16_t>(body, count, palette, volume, used, put);
  return read_planes<std::uint8_t>(body, count, palette, volume, used, put);
}

}  // namespace

Result<RunList> unpack_v1(ByteView body, bool zstd, const PackedShapeV1& shape,
                          std::span<const Material> palette, std::uint32_t volume) {
  RUNSTONE_ASSERT(shape.plausible(palette.size()) && shape.runs <= volume);
  Scratch& s = scratch();
  if (zstd) {
    const auto unpacked = decompress(body, shape.body_bytes, s);
    if (!unpacked) return Unexpected<Error>{unpacked.error()};
    body = *unpacked;
  } else if (body.size() != shape.body_bytes) {
    return fail(body.size() < shape.body_bytes ? ErrorCode::truncated : ErrorCode::trailing_bytes,
                "body of another size than announced");
  }
  s.used.assign(palette.size(), 0);
  Result<void> read;
  RunList runs;
  if (volume <= kNarrowVolumeMax) {
    std::vector<PackedRun> narrow(shape.runs);
    read = read_planes(body, shape.runs, palette, volume, s.used.data(),
                       [out = narrow.data()](std::size_t i, std::uint32_t end, Material material) {
                         out[i] = {static_cast<std::uint16_t>(end), material};
                       });
    runs = RunList::of_narrow(std::move(narrow));
  } else {
    std::vector<std::uint32_t> ends(shape.runs);
    std::vector<Material> materials(shape.runs);
    read = read_planes(
        body, shape.runs, palette, volume, s.used.data(),
        [e = ends.data(), m = materials.data()](std::size_t i, std::uint32_t end, Material material) {
          e[i] = end;
          m[i] = material;
        });
    runs = RunList::of_wide(std::move(ends), std::move(materials));
  }
  if (!read) return Unexpected<Error>{read.error()};
  if (std::find(s.used.begin(), s.used.end(), 0) != s.used.end()) {
    return fail(ErrorCode::not_canonical, "palette names a material that no run has");
  }
  return runs;
}

}  // namespace runstone
