#include "protocol/codec/uniform_list.hpp"

#include "protocol/codec/key_list.hpp"

namespace runstone {

// An entry: key of the first chunk | varint chunks - 1 | varint material | version. The others
// follow the first one along z.
Bytes encode_uniform(const std::vector<UniformChunk>& chunks) {
  RUNSTONE_ASSERT(!chunks.empty() && chunks.size() <= kUniformChunksMax);
  Bytes out;
  ByteWriter w(out);
  KeyWriter keys(chunks.front().key.lod);
  for (std::size_t first = 0; first < chunks.size();) {
    const UniformChunk& chunk = chunks[first];
    const ChunkCoord c = chunk.key.at;
    std::size_t count = 1;
    while (first + count < chunks.size()) {
      const UniformChunk& next = chunks[first + count];
      const ChunkCoord behind{c.x, c.y, c.z + static_cast<std::int32_t>(count)};
      if (next.key.at != behind || next.material != chunk.material || next.version != chunk.version)
        break;
      ++count;
    }
    keys.put(w, chunk.key);
    w.varint(count - 1);
    w.varint(chunk.material);
    put_version(w, chunk.version);
    first += count;
  }
  return out;
}

Result<std::vector<UniformChunk>> decode_uniform(ByteView bytes, std::uint8_t level,
                                                 std::int32_t edge) {
  const std::int64_t reach = kWorldLimit / edge >> level;
  ByteReader in(bytes);
  KeyReader keys(edge, level);
  std::vector<UniformChunk> chunks;
  while (in.ok() && !in.at_end()) {
    UniformChunk chunk;
    chunk.key = keys.take(in);
    const std::uint64_t more =
        in.varint_max(kUniformChunksMax - 1, "too many uniform chunks in one entry");
    chunk.material =
        static_cast<Material>(in.varint_max(kMaterialCountMax - 1, "material exceeds 16 bits"));
    chunk.version = take_version(in);
    if (!in.ok()) break;
    const std::int32_t z = chunk.key.at.z;
    if (!chunks.empty() && chunk.key.at <= chunks.back().key.at)
      in.reject(ErrorCode::not_canonical, "uniform chunks do not ascend");
    if (chunks.size() + more + 1 > kUniformChunksMax)
      in.reject(ErrorCode::limit_exceeded, "more than 4096 uniform chunks");
    if (z + static_cast<std::int64_t>(more) >= reach)
      in.reject(ErrorCode::bad_value, "uniform chunk lies outside the world");
    for (std::uint64_t i = 0; in.ok() && i <= more; ++i) {
      chunk.key.at.z = z + static_cast<std::int32_t>(i);
      chunks.push_back(chunk);
    }
  }
  if (!in.ok()) return failure(in.error());
  if (chunks.empty()) return fail(ErrorCode::bad_value, "list of uniform chunks is empty");
  return chunks;
}

}  // namespace runstone
