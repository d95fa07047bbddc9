// Chunk bytes: runs as they lie on the wire, on disk and in caches. docs/protocol.md gives all layouts.
//   raw:    u8 1 | u8 version 1 | u8 axis order | u8 0 | u8 x, y, z sides | u8 0 | u32 run count | runs as in
//           memory: narrow {u16 end, u16 material} each, or wide all u32 ends, then all u16 materials
//   packed: u8 2 | u8 version 2 | u8 axis order + 8 if the body is zstd | u8 x, y, z sides | varint run count
//           | varint palette size | palette (varint ids, ascending, first as is, then differences - 1)
//           | body to the end, plain or one zstd frame without its magic: a plane of palette indices (u8 each, u16
//           if the palette exceeds 256), a plane of a byte for each length but the last, material by material,
//           and the long lengths as varints
//   coded:  u8 3 | u8 version 1 | u8 axis order | u8 x, y, z sides | palette as above | body to the end: range-coded
//           bits (coded_body.hpp); none if the palette has one material
// `packed` and `coded` become the run array in one linear pass over runs, never per voxel.
// A chunk has one spelling in each but for zstd's choices: every other one is refused. Packed of version 1 is read, never written.
// Threads: any; scratch and zstd contexts are kept per thread and reused.
#pragma once
#include <cstddef>
#include <cstdint>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Values are on wire and disk.
enum class ChunkEncoding : std::uint8_t { raw = 1, packed = 2, coded = 3 };

/// What a peer reads: a bit for each, 1 << (encoding - 1).
inline constexpr std::uint8_t kEncodingsKnown = 7;
/// As options and reports call it.
constexpr const char* name_of(ChunkEncoding encoding) {
  return encoding == ChunkEncoding::raw      ? "raw"
         : encoding == ChunkEncoding::packed ? "packed"
                                             : "coded";
}
constexpr bool encoding_known(unsigned value) { return value >= 1 && value <= 3; }

/// Appends the chunk's bytes. Requires a valid chunk. O(runs).
void encode_chunk(const RunChunk& chunk, ChunkEncoding encoding, Bytes& out);
Bytes encode_chunk(const RunChunk& chunk, ChunkEncoding encoding);

/// Any encoding, told by the first byte; the result is validated. Memory is bounded: raw and uncompressed bodies by
/// the bytes that are there, zstd bodies by run count, that and coded bodies by the volume (at most 11 and 30
/// bytes a voxel). Offsets of errors are byte offsets, run indices where a run is named. O(runs).
Result<RunChunk> decode_chunk(ByteView in);
/// The same for a known extent: another one is refused before anything is allocated.
Result<RunChunk> decode_chunk(ByteView in, Extent expected);

/// Size of the raw bytes without making them.
std::size_t raw_bytes(const RunChunk& chunk);
/// Size of the chunk's bytes, for `packed` a rough guess from the runs alone: of terrain a run takes about half a byte.
std::size_t chunk_bytes_about(const RunChunk& chunk, ChunkEncoding encoding);

}  // namespace runstone
