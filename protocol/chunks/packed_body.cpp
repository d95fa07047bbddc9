#include "protocol/chunks/packed_body.hpp"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "common/core/assert.hpp"
#include "protocol/chunks/codec_scratch.hpp"
#include "protocol/chunks/read_runs.hpp"
#include "protocol/chunks/wire_palette.hpp"
#include "protocol/chunks/zstd_frame.hpp"

namespace runstone {
namespace {

constexpr int kZstdLevel = 5;                  // docs/performance.md compares the levels
constexpr std::size_t kZstdBodyBytesMin = 16;  // a zstd frame adds 5 to 8 bytes here

// Every zstd frame begins with this number, so it is left out.
constexpr std::array<std::uint8_t, 4> kZstdMagic = {0x28, 0xb5, 0x2f, 0xfd};
static_assert(ZSTD_MAGICNUMBER == 0xfd2fb528);

// Tokens of the plane of lengths.
constexpr std::uint32_t kLongLength = 0;   // a varint of the last plane is the length
constexpr std::uint32_t kLengthEnd = 192;  // a token below is the length itself
// The run ends with the line in which it begins. A token one less ends with the next line, and so
// on.
constexpr std::uint32_t kToLineEnd = 255;
constexpr std::uint32_t kLineEndTokens = 64;
static_assert(kLengthEnd + kLineEndTokens == kToLineEnd + 1);

/// A line, as tokens count it, has 2^bits voxels: the largest power of two that divides the side.
/// So positions need shifts only and no division.
struct Line {
  explicit Line(std::uint32_t side)
      : bits(static_cast<unsigned>(std::countr_zero(side))), mask((1u << bits) - 1) {}
  /// Returns the number of lines that a run touches. Requires that the run ends with a line.
  std::uint32_t count(std::uint32_t begin, std::uint32_t end) const {
    return (end - (begin & ~mask)) >> bits;
  }
  bool ends_at(std::uint32_t at) const { return (at & mask) == 0; }
  unsigned bits;
  std::uint32_t mask;
};

struct FreeCompressor {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
};

struct PackScratch {
  WirePalette palette;
  std::vector<std::uint32_t> next;  // token of each material, by palette index
  Bytes body, long_lengths;
  Bytes frame;  // a whole zstd frame
  std::unique_ptr<ZSTD_CCtx, FreeCompressor> compressor;
};

PackScratch& pack_scratch() {
  thread_local PackScratch mine;
  return mine;
}

/// Replaces the number of tokens of each material by the place of its first token.
void counts_to_places(std::vector<std::uint32_t>& next) {
  std::uint32_t place = 0;
  for (std::uint32_t& one : next) place += std::exchange(one, place);
}

/// Writes the first plane and computes the place of the first token of each material.
template <class Index, class Runs>
void write_indices(const Runs& runs, PackScratch& s) {
  s.next.assign(s.palette.ids().size(), 0);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto index = static_cast<Index>(s.palette.index_of(runs.material(i)));
    std::memcpy(s.body.data() + i * sizeof(Index), &index, sizeof(Index));
    ++s.next[index];
  }
  --s.next[s.palette.index_of(runs.material(runs.size() - 1))];  // the last run has no token
  counts_to_places(s.next);
}

template <class Index, class Runs>
void write_planes(const Runs& runs, Line line, PackScratch& s) {
  const std::size_t count = runs.size(), tokens_at = count * sizeof(Index);
  s.body.resize(tokens_at + count - 1);
  write_indices<Index>(runs, s);
  s.long_lengths.clear();
  ByteWriter long_lengths(s.long_lengths);
  std::uint32_t begin = 0;
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const std::uint32_t end = runs.end(i), length = end - begin, lines = line.count(begin, end);
    std::uint32_t token = length < kLengthEnd ? length : kLongLength;
    if (line.ends_at(end) && lines <= kLineEndTokens) {
      token = kToLineEnd + 1 - lines;
    } else if (token == kLongLength) {
      long_lengths.varint(length);
    }
    Index index;
    std::memcpy(&index, s.body.data() + i * sizeof(Index), sizeof(Index));
    s.body[tokens_at + s.next[index]++] = static_cast<std::uint8_t>(token);
    begin = end;
  }
  s.body.insert(s.body.end(), s.long_lengths.begin(), s.long_lengths.end());
}

/// Returns the body as one zstd frame without its magic number, or an empty view if that is not
/// smaller.
ByteView compress(PackScratch& s) {
  if (s.body.size() < kZstdBodyBytesMin) return {};
  if (!s.compressor) s.compressor.reset(ZSTD_createCCtx());
  if (!s.compressor) throw std::bad_alloc();
  // zstd stops when it runs out of space: the frame would not be smaller.
  s.frame.resize(kZstdMagic.size() + s.body.size() - 1);
  const std::size_t size = ZSTD_compressCCtx(s.compressor.get(), s.frame.data(), s.frame.size(),
                                             s.body.data(), s.body.size(), kZstdLevel);
  if (ZSTD_isError(size) != 0) return {};
  return ByteView(s.frame).first(size).subspan(kZstdMagic.size());
}

/// Unpacks exactly one frame. Fails if it does not announce a plausible size or has another one.
Result<ByteView> decompress(ByteView in, const PackedShape& shape, PackScratch& s) {
  keep_small(s.frame);
  s.frame.assign(kZstdMagic.begin(), kZstdMagic.end());
  s.frame.insert(s.frame.end(), in.begin(), in.end());
  const ByteView frame = s.frame;
  const std::uint64_t announced = ZSTD_getFrameContentSize(frame.data(), frame.size());
  // The values that stand for an error and for an unknown size are not plausible either.
  if (!shape.plausible(announced)) {
    return fail(ErrorCode::bad_value, "zstd frame of a size that does not fit the run count");
  }
  return unpack_zstd_frame(frame, static_cast<std::size_t>(announced));
}

/// Computes the place of the first token of each material. Fails if a material has no run.
template <class Index>
Result<void> read_indices(const std::uint8_t* indices, std::size_t count, std::size_t materials,
                          std::vector<std::uint32_t>& next) {
  next.assign(materials, 0);
  Index index = 0;
  for (std::size_t i = 0; i < count; ++i) {
    std::memcpy(&index, indices + i * sizeof(Index), sizeof(Index));
    if (index >= materials)
      return fail(ErrorCode::broken_invariant, "palette index behind the palette", i);
    ++next[index];
  }
  if (std::find(next.begin(), next.end(), 0) != next.end()) {
    return fail(ErrorCode::not_canonical, "palette names a material that no run has");
  }
  --next[index];  // the last run has no token
  counts_to_places(next);
  return {};
}

/// Returns the next length of the last plane, or 0 if there is none or its varint is not canonical.
std::uint32_t read_long_length(const std::uint8_t*& at, const std::uint8_t* stop) {
  std::uint32_t length = 0;
  for (unsigned shift = 0; shift < 21 && at != stop; shift += 7) {
    const std::uint32_t byte = *at++;
    length |= (byte & 0x7f) << shift;
    if (byte < 0x80) return byte == 0 ? 0 : length;  // a last byte of 0 is not canonical
  }
  return 0;
}

/// Makes one pass over the runs and calls put(run, end, material) for each.
template <class Index, class Put>
Result<void> read_planes(ByteView body, const PackedShape& shape, std::span<const Material> palette,
                         std::vector<std::uint32_t>& next_of, Put&& put) {
  const std::size_t count = shape.runs;
  const std::uint8_t* const indices = body.data();
  const std::uint8_t* const tokens = indices + count * sizeof(Index);
  const std::uint8_t* at = tokens + count - 1;
  const std::uint8_t* const stop = body.data() + body.size();
  if (const auto read = read_indices<Index>(indices, count, palette.size(), next_of); !read)
    return read;
  std::uint32_t* const next = next_of.data();
  const Line line(shape.side);
  std::uint32_t end = 0;
  Index index;
  for (std::size_t i = 0; i + 1 < count; ++i) {
    std::memcpy(&index, indices + i * sizeof(Index), sizeof(Index));
    const std::uint32_t token = tokens[next[index]++], begin = end;
    std::uint32_t length = token;
    if (token == kLongLength) {
      length = read_long_length(at, stop);
      if (length < kLengthEnd)
        return fail(ErrorCode::broken_invariant,
                    "long run length is truncated, not canonical or below 192", i);
    }
    // The branch is unpredictable, so both ends are computed.
    const std::uint32_t line_end = (begin & ~line.mask) + ((kToLineEnd + 1 - token) << line.bits);
    const bool to_line_end = token >= kLengthEnd;
    end = to_line_end ? line_end : begin + length;
    if ((line.ends_at(end) && line.count(begin, end) <= kLineEndTokens) != to_line_end)
      return fail(ErrorCode::broken_invariant, "run to the end of a line is written as a length",
                  i);
    if (end >= shape.volume)
      return fail(ErrorCode::broken_invariant, "run ends behind the volume", i);
    put(i, end, palette[index]);
  }
  std::memcpy(&index, indices + (count - 1) * sizeof(Index), sizeof(Index));
  put(count - 1, shape.volume, palette[index]);
  if (at != stop) {
    return fail(ErrorCode::trailing_bytes, "bytes follow the run lengths",
                static_cast<std::uint64_t>(at - body.data()));
  }
  return {};
}

template <class Put>
Result<void> read_planes(ByteView body, const PackedShape& shape, std::span<const Material> palette,
                         std::vector<std::uint32_t>& next, Put&& put) {
  if (shape.has_wide_indices()) return read_planes<std::uint16_t>(body, shape, palette, next, put);
  return read_planes<std::uint8_t>(body, shape, palette, next, put);
}

}  // namespace

bool PackedShape::plausible(std::uint64_t body_bytes) const {
  const std::uint64_t least = runs * (has_wide_indices() ? 3u : 2u) - 1;
  return body_bytes >= least && body_bytes <= least + 3ULL * (volume / kLengthEnd);
}

PackedBody pack(const RunList& runs, std::uint32_t side) {
  RUNSTONE_ASSERT(runs.size() > 0);
  PackScratch& s = pack_scratch();
  keep_small(s.body);
  keep_small(s.frame);
  runs.visit([&](const auto& list) {
    s.palette.find(list);
    if (s.palette.ids().size() > kNarrowPaletteMax) {
      write_planes<std::uint16_t>(list, Line(side), s);
    } else {
      write_planes<std::uint8_t>(list, Line(side), s);
    }
  });
  const ByteView compressed = compress(s);
  return {s.palette.ids(), s.body, compressed};
}

Result<RunList> unpack(ByteView body, bool zstd, const PackedShape& shape,
                       std::span<const Material> palette) {
  RUNSTONE_ASSERT(shape.runs >= 1 && shape.runs <= shape.volume &&
                  shape.materials == palette.size());
  PackScratch& s = pack_scratch();
  if (zstd) {
    const auto unpacked = decompress(body, shape, s);
    if (!unpacked) return failure(unpacked.error());
    body = *unpacked;
  } else if (!shape.plausible(body.size())) {
    return fail(ErrorCode::bad_value, "body size does not fit the run count");
  }
  return read_runs(shape.volume, shape.runs,
                   [&](const auto& put) { return read_planes(body, shape, palette, s.next, put); });
}

}  // namespace runstone
