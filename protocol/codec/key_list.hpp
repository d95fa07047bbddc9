// What the byte lists of the protocol share: chunk keys, versions, digests and the loop over
// entries. All lists of chunks ascend by x, then y, then z. docs/protocol.md specifies the bytes.
// Internal to the message codec.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/digest.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// Writes the keys of one list: each axis as svarint of its difference to the key before, the first
/// key to (0, 0, 0). Requires keys of one level of detail, strictly ascending.
class KeyWriter {
 public:
  explicit KeyWriter(std::uint8_t level = 0) : level_(level) {}
  void put(ByteWriter& out, const ChunkKey& key);

 private:
  std::uint8_t level_;
  ChunkCoord last_;
  bool is_first_ = true;
};

/// Reads the keys of one list, all of level of detail `level`. Rejects keys that do not ascend or
/// lie outside the world. `edge` is that of the world's chunks, or the largest one.
class KeyReader {
 public:
  explicit KeyReader(std::int32_t edge, std::uint8_t level = 0);
  ChunkKey take(ByteReader& in);

 private:
  std::int32_t next(ByteReader& in, std::int32_t before) const;
  std::uint8_t level_;
  std::int32_t reach_;
  ChunkCoord last_;
  bool is_first_ = true;
};

/// Writes the epoch as varint, then, unless it is 0, the sequence as varint.
void put_version(ByteWriter& out, const Version& version);
/// Rejects a version that is half zero.
Version take_version(ByteReader& in);

/// Writes both lanes as u64.
void put_digest(ByteWriter& out, const Digest& digest);
Digest take_digest(ByteReader& in);
/// Reads one lane. Rejects a lane that is not reduced.
std::uint64_t take_lane(ByteReader& in);

/// Calls `take` for each entry until the bytes end. Requires at least one entry; fails if there are
/// more than `count_max`.
template <class Entry, class Take>
Result<std::vector<Entry>> entries_of(ByteView bytes, std::size_t count_max, Take&& take) {
  std::vector<Entry> out;
  ByteReader in(bytes);
  do {
    if (out.size() == count_max) in.reject(ErrorCode::limit_exceeded, "list has too many entries");
    Entry entry = take(in);
    if (!in.ok()) return failure(in.error());
    out.push_back(std::move(entry));
  } while (!in.at_end());
  return out;
}

/// Requires at least one key; strictly ascending.
Bytes encode_keys(std::span<const ChunkKey> keys);
Result<std::vector<ChunkKey>> decode_keys(ByteView bytes, std::size_t count_max, std::int32_t edge);

}  // namespace runstone
