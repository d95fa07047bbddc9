// What several files of vectors have: chunks, digests and refusals as JSON. Internal to vectors.
#pragma once
#include <cstdint>
#include <string>

#include "common/core/coords.hpp"
#include "common/core/digest.hpp"
#include "common/core/hex.hpp"
#include "common/runs/run_chunk.hpp"
#include "protocol/chunks/chunk_codec.hpp"
#include "tests/conformance/vectors/vector_file.hpp"

namespace runstone::conformance {

/// Returns both lanes as 16 hexadecimal digits each, high digits first.
Json json_of(const Digest& digest);
Json json_of(const VoxelPos& pos);
Json json_of(const ChunkCoord& at);
/// Returns the name of an axis order, such as "yxz".
const char* name_of(AxisOrder order);
/// Returns the chunk bytes in the encoding `raw`, as hexadecimal digits.
std::string raw_hex(const RunChunk& chunk);
/// Returns bytes that a reader must refuse, with the reason that the library gives. Requires a
/// refused result.
template <class T>
Json refusal_of(const std::string& name, ByteView bytes, const Result<T>& result) {
  return {{"name", name}, {"bytes", to_hex(bytes)}, {"refused", result.error().what}};
}
/// Returns ground of edge `edge`: stone below a surface that varies, ores in it and some plants.
RunChunk ground_chunk(ChunkCoord at, unsigned edge, AxisOrder order);

}  // namespace runstone::conformance
