// Chunk bytes: the runs of a chunk on the wire, on disk and in caches. docs/protocol.md specifies
// the layouts:
//   raw:    u8 1 | u8 version 1 | u8 axis order | u8 0 | u8 x, y, z sides | u8 0 | u32 run count |
//           runs as in memory: narrow: {u16 end, u16 material} each; wide: all u32 ends, then all
//           u16 materials
//   packed: u8 2 | u8 version 1 | u8 axis order + 8 if the body is zstd | u8 x, y, z sides | varint
//           run count | varint palette size | palette (varint ids, ascending, the first as is, then
//           differences - 1) | body to the end, plain or one zstd frame without its magic number.
//           The body is a plane of palette indices (u8 each, u16 if the palette exceeds 256), a
//           plane of one byte for each length but the last, ordered by material, and the long
//           lengths as varints
//   coded:  u8 3 | u8 version 1 | u8 axis order | u8 x, y, z sides | palette size and palette as in
//           `packed` | body to the end: range-coded bits (coded_body.hpp); empty if the palette
//           has one material
// Decoding `packed` and `coded` is one linear pass over runs, never over voxels.
// Each encoding is canonical but for the choices of zstd: the decoder rejects every other spelling
// of a chunk.
// Thread: any. Scratch and zstd contexts are kept per thread and reused.
#pragma once
#include <cstddef>
#include <cstdint>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Values are on wire and disk.
enum class ChunkEncoding : std::uint8_t { raw = 1, packed = 2, coded = 3 };

/// The encodings that this build reads, a bit each: 1 << (encoding - 1).
inline constexpr std::uint8_t kEncodingsKnown = 7;
/// Returns the name used in options and reports.
constexpr const char* name_of(ChunkEncoding encoding) {
  return encoding == ChunkEncoding::raw      ? "raw"
         : encoding == ChunkEncoding::packed ? "packed"
                                             : "coded";
}
constexpr bool encoding_known(unsigned value) { return value >= 1 && value <= 3; }

/// Appends the bytes of the chunk. Requires a valid chunk. Cost: O(runs).
void encode_chunk(const RunChunk& chunk, ChunkEncoding encoding, Bytes& out);
Bytes encode_chunk(const RunChunk& chunk, ChunkEncoding encoding);

/// Decodes any encoding; the first byte names it. The result is validated. Offsets of errors are
/// byte offsets, or run indices where the error names a run. Memory is bounded:
///   - raw and plain packed bodies: by their bytes;
///   - zstd bodies: by the run count and the volume, at most 11 bytes a voxel;
///   - coded bodies: by the volume, at most 30 bytes a voxel.
/// Cost: O(runs).
Result<RunChunk> decode_chunk(ByteView in);
/// Like decode_chunk(in), for a known extent. Rejects another extent before it allocates anything.
Result<RunChunk> decode_chunk(ByteView in, Extent expected);

/// Returns the size of the raw bytes without making them.
std::size_t raw_bytes(const RunChunk& chunk);
/// Returns the size of the chunk's bytes. For packed and coded it is an estimate from the number of
/// runs.
std::size_t chunk_bytes_about(const RunChunk& chunk, ChunkEncoding encoding);

}  // namespace runstone
