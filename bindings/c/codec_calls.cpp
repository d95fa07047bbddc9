// Calls of runstone.h on chunk bytes.
#include "bindings/c/buffer.hpp"
#include "bindings/c/chunk_handle.hpp"
#include "bindings/c/runstone.h"
#include "common/runs/checked_runs.hpp"
#include "protocol/chunks/chunk_codec.hpp"

using namespace runstone;
using namespace runstone::c_interface;

runstone_status runstone_chunk_encode(const runstone_chunk* chunk, uint32_t encoding, uint8_t* out,
                                      size_t capacity, size_t* count) {
  return answer([&] {
    const RunChunk& runs = whole(chunk, "chunk").runs;
    if (!encoding_known(encoding)) refuse(RUNSTONE_BAD_ARGUMENT, "encoding", "is unknown");
    given(count, "count");
    const auto kind = static_cast<ChunkEncoding>(encoding);
    // The size of raw bytes is known without making them.
    if (kind == ChunkEncoding::raw && !has_room(out, capacity, raw_bytes(runs), count)) return;
    write_elements(std::span<const std::uint8_t>(encode_chunk(runs, kind)), out, capacity, count);
  });
}

runstone_status runstone_chunk_decode(const uint8_t* bytes, size_t count, const uint32_t sides[3],
                                      runstone_chunk** out) {
  return answer([&] {
    output(out, "out");
    const ByteView in = elements(bytes, count, "bytes");
    const auto decoded = [&]() -> Result<RunChunk> {
      if (sides == nullptr) return decode_chunk(in);
      const auto extent = chunk_extent(sides[0], sides[1], sides[2]);
      if (!extent) refuse(RUNSTONE_BAD_ARGUMENT, "sides", "are not 8 to 128 voxels");
      return decode_chunk(in, *extent);
    };
    Result<RunChunk> chunk = decoded();
    if (!chunk) refuse("bytes", chunk.error());
    create(out, *std::move(chunk));
  });
}
