#include "protocol/chunks/chunk_codec.hpp"

#include <array>
#include <bit>
#include <cstring>
#include <vector>

#include "common/core/assert.hpp"
#include "protocol/chunks/chunk_size.hpp"
#include "protocol/chunks/coded_body.hpp"
#include "protocol/chunks/packed_body.hpp"

namespace runstone {
namespace {

// Raw runs are copied between memory and wire without conversion.
static_assert(std::endian::native == std::endian::little);
static_assert(std::is_trivially_copyable_v<PackedRun> && offsetof(PackedRun, material) == 2);

constexpr std::uint8_t kChunkBytesVersion = 1;
constexpr std::uint8_t kZstdFlag = 8;  // in the axis order byte of packed chunks

void append_bytes(Bytes& out, const void* from, std::size_t count) {
  const auto* first = static_cast<const std::uint8_t*>(from);
  out.insert(out.end(), first, first + count);
}

void write_runs(Bytes& out, const NarrowRuns& runs) {
  append_bytes(out, runs.packed().data(), runs.packed().size_bytes());
}
void write_runs(Bytes& out, const WideRuns& runs) {
  append_bytes(out, runs.ends().data(), runs.ends().size_bytes());
  append_bytes(out, runs.materials().data(), runs.materials().size_bytes());
}

void write_head(ByteWriter& w, const RunChunk& chunk, ChunkEncoding encoding, std::uint8_t flags) {
  w.u8(static_cast<std::uint8_t>(encoding));
  w.u8(kChunkBytesVersion);
  w.u8(static_cast<std::uint8_t>(static_cast<std::uint8_t>(chunk.order) | flags));
  if (encoding == ChunkEncoding::raw) w.u8(0);
  for (const std::uint8_t side : chunk.extent.sides()) w.u8(side);
}

void encode_raw(const RunChunk& chunk, Bytes& out) {
  out.reserve(out.size() + raw_bytes(chunk));
  ByteWriter w(out);
  write_head(w, chunk, ChunkEncoding::raw, 0);
  w.u8(0);
  w.u32(static_cast<std::uint32_t>(chunk.runs.size()));
  chunk.runs.visit([&out](const auto& runs) { write_runs(out, runs); });
}

void write_palette(ByteWriter& w, std::span<const Material> palette) {
  w.varint(palette.size());
  std::uint32_t lowest = 0;  // smallest id that may follow
  for (const Material id : palette) {
    w.varint(id - lowest);
    lowest = id + 1u;
  }
}

void encode_packed(const RunChunk& chunk, Bytes& out) {
  const PackedBody packed = pack(chunk.runs, ordered(chunk.extent, chunk.order).f);
  const ByteView body = packed.compressed.empty() ? packed.body : packed.compressed;
  ByteWriter w(out);
  write_head(w, chunk, ChunkEncoding::packed, packed.compressed.empty() ? 0 : kZstdFlag);
  w.varint(chunk.runs.size());
  write_palette(w, packed.palette);
  w.bytes(body);
}

void encode_coded(const RunChunk& chunk, Bytes& out) {
  const CodedBody coded = code_runs(chunk.runs, ordered(chunk.extent, chunk.order));
  ByteWriter w(out);
  write_head(w, chunk, ChunkEncoding::coded, 0);
  write_palette(w, coded.palette);
  w.bytes(coded.bytes);
}

// The fields that all encodings have before the runs.
struct Head {
  Extent extent;
  AxisOrder order{};
  bool zstd = false;
};

Head read_head(ByteReader& r, ChunkEncoding encoding, const Extent* expected) {
  Head head;
  if (r.u8() != kChunkBytesVersion)
    r.reject(ErrorCode::bad_version, "unknown version of chunk bytes");
  std::uint8_t order = r.u8();
  if (encoding == ChunkEncoding::packed) {
    head.zstd = (order & kZstdFlag) != 0;
    order &= static_cast<std::uint8_t>(~kZstdFlag);
  } else if (encoding == ChunkEncoding::raw && r.u8() != 0) {
    r.reject(ErrorCode::not_canonical, "reserved byte of a chunk is not zero");
  }
  if (order >= kAxisOrderCount) r.reject(ErrorCode::bad_value, "unknown axis order");
  head.order = static_cast<AxisOrder>(order);
  head.extent.x = r.u8();
  head.extent.y = r.u8();
  head.extent.z = r.u8();
  if (!head.extent.valid()) r.reject(ErrorCode::bad_value, "chunk side outside 8..128");
  if (expected != nullptr && head.extent != *expected)
    r.reject(ErrorCode::bad_value, "chunk of another size");
  return head;
}

Result<RunChunk> validated(RunChunk chunk) {
  if (const auto valid = validate(chunk); !valid) return failure(valid.error());
  return chunk;
}

Result<RunChunk> decode_raw(ByteReader& r, const Extent* expected) {
  const Head head = read_head(r, ChunkEncoding::raw, expected);
  if (r.u8() != 0) r.reject(ErrorCode::not_canonical, "reserved byte of a chunk is not zero");
  const std::size_t count = r.u32();
  const bool narrow = head.extent.volume() <= kNarrowVolumeMax;
  const ByteView runs = r.bytes(count * (narrow ? 4 : 6));
  if (const auto done = r.finish(); !done) return failure(done.error());
  if (count == 0) return fail(ErrorCode::broken_invariant, "chunk has no runs");
  if (narrow) {
    std::vector<PackedRun> packed(count);
    std::memcpy(packed.data(), runs.data(), runs.size());
    return validated({head.extent, head.order, RunList::of_narrow(std::move(packed))});
  }
  std::vector<std::uint32_t> ends(count);
  std::vector<Material> materials(count);
  std::memcpy(ends.data(), runs.data(), 4 * count);
  std::memcpy(materials.data(), runs.data() + 4 * count, 2 * count);
  return validated(
      {head.extent, head.order, RunList::of_wide(std::move(ends), std::move(materials))});
}

/// Reads at most `colours_max` ids. Allocates only after it has checked that their bytes are
/// present. The result is valid if r.ok().
std::vector<Material> read_palette(ByteReader& r, std::uint64_t colours_max) {
  const auto colours = r.varint_max(kMaterialCountMax, "palette exceeds 65536 materials");
  if (colours > colours_max) r.reject(ErrorCode::bad_value, "palette larger than the run count");
  if (r.ok() && colours == 0) r.reject(ErrorCode::broken_invariant, "chunk has no runs");
  if (colours > r.left()) r.reject(ErrorCode::truncated, "input ends inside the palette");
  std::vector<Material> palette;
  if (r.ok()) palette.reserve(static_cast<std::size_t>(colours));
  for (std::uint64_t lowest = 0; r.ok() && palette.size() < colours;) {
    const std::uint64_t step = r.varint_max(0xffff, "material id exceeds 16 bits");
    if (lowest + step > 0xffff) r.reject(ErrorCode::bad_value, "material id exceeds 16 bits");
    if (!r.ok()) break;
    palette.push_back(static_cast<Material>(lowest + step));
    lowest += step + 1;
  }
  return palette;
}

/// Returns the validated chunk of unpacked runs. Errors of runs keep their run index; other offsets
/// are moved by `body_at`, the offset of the body.
Result<RunChunk> packed_chunk(const Head& head, Result<RunList> runs, std::size_t body_at) {
  if (!runs) {
    const Error& e = runs.error();
    return fail(e.code, e.what,
                e.code == ErrorCode::broken_invariant ? e.offset : body_at + e.offset);
  }
  return validated({head.extent, head.order, *std::move(runs)});
}

Result<RunChunk> decode_packed(ByteReader& r, const Extent* expected) {
  const Head head = read_head(r, ChunkEncoding::packed, expected);
  // Before the axis order is used.
  if (!r.ok()) return failure(r.error());
  PackedShape shape;
  shape.side = ordered(head.extent, head.order).f;
  shape.volume = head.extent.volume();
  shape.runs = static_cast<std::size_t>(r.varint_max(shape.volume, "more runs than voxels"));
  const std::vector<Material> palette = read_palette(r, shape.runs);
  if (!r.ok()) return failure(r.error());
  shape.materials = palette.size();
  const std::size_t body_at = r.offset();
  return packed_chunk(head, unpack(r.bytes(r.left()), head.zstd, shape, palette), body_at);
}

Result<RunChunk> decode_coded(ByteReader& r, const Extent* expected) {
  const Head head = read_head(r, ChunkEncoding::coded, expected);
  const std::vector<Material> palette = read_palette(r, head.extent.volume());
  if (r.ok() && palette.size() == 1) {
    if (const auto done = r.finish(); !done) return failure(done.error());
    return uniform_chunk(head.extent, palette[0], head.order);
  }
  if (!r.ok()) return failure(r.error());
  const std::size_t body_at = r.offset();
  auto runs = decode_runs(r.bytes(r.left()), palette, ordered(head.extent, head.order));
  if (!runs) return fail(runs.error().code, runs.error().what, body_at);
  return validated({head.extent, head.order, *std::move(runs)});
}

Result<RunChunk> decode(ByteView in, const Extent* expected) {
  ByteReader r(in);
  const std::uint8_t encoding = r.u8();
  if (!r.ok()) return failure(r.error());
  if (encoding == static_cast<std::uint8_t>(ChunkEncoding::raw)) return decode_raw(r, expected);
  if (encoding == static_cast<std::uint8_t>(ChunkEncoding::packed))
    return decode_packed(r, expected);
  if (encoding == static_cast<std::uint8_t>(ChunkEncoding::coded)) return decode_coded(r, expected);
  return fail(ErrorCode::unknown_kind, "unknown chunk encoding");
}

}  // namespace

void encode_chunk(const RunChunk& chunk, ChunkEncoding encoding, Bytes& out) {
  RUNSTONE_ASSERT(validate(chunk).has_value());
  if (encoding == ChunkEncoding::raw) return encode_raw(chunk, out);
  if (encoding == ChunkEncoding::coded) return encode_coded(chunk, out);
  RUNSTONE_ASSERT(encoding == ChunkEncoding::packed);
  encode_packed(chunk, out);
}

Bytes encode_chunk(const RunChunk& chunk, ChunkEncoding encoding) {
  Bytes out;
  encode_chunk(chunk, encoding, out);
  return out;
}

Result<RunChunk> decode_chunk(ByteView in) { return decode(in, nullptr); }
Result<RunChunk> decode_chunk(ByteView in, Extent expected) { return decode(in, &expected); }

std::size_t raw_bytes(const RunChunk& chunk) { return kChunkHeaderBytes + chunk.runs.byte_size(); }

std::size_t chunk_bytes_about(const RunChunk& chunk, ChunkEncoding encoding) {
  return encoding == ChunkEncoding::raw ? raw_bytes(chunk)
                                        : kChunkHeaderBytes + chunk.runs.size() / 2;
}

}  // namespace runstone
