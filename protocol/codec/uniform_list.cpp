#include "protocol/codec/uniform_list.hpp"

namespace runstone {

// An entry:
//   svarint x, z, y of the lowest chunk, each minus that of the entry before, of the first entry
//   minus 0 |
//   varint chunks - 1 | varint material | varint epoch | varint seq, if the epoch is not 0
Bytes encode_uniform(const std::vector<UniformChunk>& chunks) {
  RUNSTONE_ASSERT(!chunks.empty() && chunks.size() <= kUniformChunksMax);
  Bytes out;
  ByteWriter w(out);
  ChunkCoord at{};
  for (std::size_t first = 0; first < chunks.size();) {
    const UniformChunk& chunk = chunks[first];
    RUNSTONE_ASSERT(chunk.key.lod == 0);
    RUNSTONE_ASSERT(first == 0 || is_before_in_list(chunks[first - 1].key.at, chunk.key.at));
    const ChunkCoord c = chunk.key.at;
    std::size_t count = 1;
    while (first + count < chunks.size()) {
      const UniformChunk& next = chunks[first + count];
      const ChunkCoord above{c.x, c.y + static_cast<std::int32_t>(count), c.z};
      if (next.key.at != above || next.material != chunk.material || next.version != chunk.version)
        break;
      ++count;
    }
    w.svarint(std::int64_t{c.x} - at.x);
    w.svarint(std::int64_t{c.z} - at.z);
    w.svarint(std::int64_t{c.y} - at.y);
    w.varint(count - 1);
    w.varint(chunk.material);
    w.varint(chunk.version.epoch);
    if (chunk.version.epoch != 0) w.varint(chunk.version.seq);
    at = c;
    first += count;
  }
  return out;
}

Result<std::vector<UniformChunk>> decode_uniform(ByteView bytes, std::int32_t edge) {
  const std::int64_t reach = kWorldLimit / edge;
  ByteReader in(bytes);
  std::vector<UniformChunk> chunks;
  ChunkCoord at{};
  while (in.ok() && !in.at_end()) {
    const auto axis = [&](std::int32_t from, const char* what) {
      return static_cast<std::int32_t>(from + in.svarint_in(-reach - from, reach - 1 - from, what));
    };
    const std::int32_t x = axis(at.x, "uniform chunk lies outside the world");
    const std::int32_t z = axis(at.z, "uniform chunk lies outside the world");
    const std::int32_t y = axis(at.y, "uniform chunk lies outside the world");
    const std::uint64_t more =
        in.varint_max(kUniformChunksMax - 1, "too many uniform chunks in one entry");
    UniformChunk chunk;
    chunk.material =
        static_cast<Material>(in.varint_max(kMaterialCountMax - 1, "material exceeds 16 bits"));
    chunk.version.epoch = static_cast<Epoch>(in.varint_max(0xffff'ffff, "epoch exceeds 32 bits"));
    if (chunk.version.epoch != 0) {
      chunk.version.seq = in.varint_max(kSequenceMax, "sequence exceeds 63 bits");
      if (chunk.version.seq == 0)
        in.reject(ErrorCode::bad_value, "version of a uniform chunk is half zero");
    }
    if (!in.ok()) break;
    at = {x, y, z};
    if (!chunks.empty() && !is_before_in_list(chunks.back().key.at, at)) {
      in.reject(ErrorCode::not_canonical, "uniform chunks do not ascend");
    }
    if (chunks.size() + more + 1 > kUniformChunksMax) {
      in.reject(ErrorCode::limit_exceeded, "more than 4096 uniform chunks");
    }
    if (y + static_cast<std::int64_t>(more) >= reach) {
      in.reject(ErrorCode::bad_value, "uniform chunk lies outside the world");
    }
    for (std::uint64_t i = 0; in.ok() && i <= more; ++i) {
      chunk.key.at = {x, y + static_cast<std::int32_t>(i), z};
      chunks.push_back(chunk);
    }
  }
  if (!in.ok()) return Unexpected<Error>{in.error()};
  if (chunks.empty()) return fail(ErrorCode::bad_value, "list of uniform chunks is empty");
  return chunks;
}

}  // namespace runstone
