#include "protocol/codec/packed_body_v1.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

#include "common/core/assert.hpp"
#include "protocol/codec/read_runs.hpp"
#include "protocol/codec/zstd_frame.hpp"

namespace runstone {
namespace {

/// Makes one pass over the runs and calls put(run, end, material) for each.
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
      if (at == stop)
        return fail(ErrorCode::truncated, "body ends inside the run lengths", body.size());
      std::uint32_t length = *at++;
      // The loop goes on while the last byte has its high bit.
      for (unsigned shift = 7; length >> shift != 0; shift += 7) {
        if (at == stop)
          return fail(ErrorCode::truncated, "body ends inside the run lengths", body.size());
        const std::uint32_t byte = *at++;
        if (byte == 0)
          return fail(ErrorCode::broken_invariant, "run length is longer than needed", i);
        length = (length & ((1u << shift) - 1)) | byte << shift;
        if (shift == 14 && byte >= 0x80)
          return fail(ErrorCode::broken_invariant, "run length exceeds 21 bits", i);
      }
      if (length > volume - end)
        return fail(ErrorCode::broken_invariant, "run ends behind the volume", i);
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
  if (palette.size() > 256)
    return read_planes<std::uint16_t>(body, count, palette, volume, used, put);
  return read_planes<std::uint8_t>(body, count, palette, volume, used, put);
}

}  // namespace

Result<RunList> unpack_v1(ByteView body, bool zstd, const PackedShapeV1& shape,
                          std::span<const Material> palette, std::uint32_t volume) {
  RUNSTONE_ASSERT(shape.plausible(palette.size()) && shape.runs <= volume);
  if (zstd) {
    const auto unpacked = unpack_zstd_frame(body, shape.body_bytes);
    if (!unpacked) return Unexpected<Error>{unpacked.error()};
    body = *unpacked;
  } else if (body.size() != shape.body_bytes) {
    return fail(body.size() < shape.body_bytes ? ErrorCode::truncated : ErrorCode::trailing_bytes,
                "body of another size than announced");
  }
  std::vector<std::uint8_t> used(palette.size(), 0);
  auto runs = read_runs(volume, shape.runs, [&](const auto& put) {
    return read_planes(body, shape.runs, palette, volume, used.data(), put);
  });
  if (!runs) return runs;
  if (std::find(used.begin(), used.end(), 0) != used.end()) {
    return fail(ErrorCode::not_canonical, "palette names a material that no run has");
  }
  return runs;
}

}  // namespace runstone
