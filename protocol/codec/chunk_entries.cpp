#include "protocol/codec/chunk_entries.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include "common/core/assert.hpp"
#include "protocol/codec/key_list.hpp"

namespace runstone {
namespace {

// What follows the key of an entry. Values are on the wire.
enum class EntryForm : std::uint8_t { snapshot = 0, edits = 1 };

// A snapshot: u8 0 | version | digest | varint bytes of the chunk | chunk bytes.
// Edits: u8 1 | version `to` | digest | varint to - from | varint bytes of the edits | edits.
// An edit: varint of its sequence minus the one before it, of the first minus `from` | varint bytes
// of the descriptor | descriptor.
void put_entry_head(ByteWriter& out, EntryForm form, const Version& version, const Digest& digest) {
  out.u8(static_cast<std::uint8_t>(form));
  put_version(out, version);
  put_digest(out, digest);
}

Bytes encode_missing_edits(std::span<const MissingEdit> edits, Sequence from) {
  Bytes bytes;
  ByteWriter out(bytes);
  for (const MissingEdit& missing : edits) {
    RUNSTONE_ASSERT(missing.seq > from);
    const Bytes edit = encode(missing.edit);
    out.varint(missing.seq - from);
    out.varint(edit.size());
    out.bytes(edit);
    from = missing.seq;
  }
  return bytes;
}

Result<std::vector<MissingEdit>> decode_missing_edits(ByteView bytes, Sequence from) {
  return entries_of<MissingEdit>(bytes, kChunkEditsMax, [&from](ByteReader& in) {
    MissingEdit missing;
    const Sequence step = in.varint_max(kSequenceMax - from, "sequence exceeds 63 bits");
    if (in.ok() && step == 0) in.reject(ErrorCode::not_canonical, "sequences do not ascend");
    const std::uint64_t size = in.varint_max(kDescriptorBytesMax, "descriptor is too long");
    const ByteView edit = in.bytes(static_cast<std::size_t>(size));
    if (!in.ok()) return missing;
    auto decoded = decode_voxel_edit(edit);
    if (!decoded) {
      in.reject(decoded.error().code, decoded.error().what);
    } else {
      missing.edit = *std::move(decoded);
    }
    missing.seq = from = from + step;
    return missing;
  });
}

/// Reads an entry behind its key. `in` is rejected with the errors of what it contains.
class EntryReader {
 public:
  explicit EntryReader(std::int32_t chunk_edge) : chunk_edge_(chunk_edge) {}

  ChunkAnswer take(ByteReader& in, const ChunkKey& key) const {
    const std::uint8_t form = in.u8();
    if (form > static_cast<std::uint8_t>(EntryForm::edits))
      in.reject(ErrorCode::unknown_kind, "unknown form of a chunk entry");
    const Version version = take_version(in);
    const Digest digest = take_digest(in);
    if (key.lod != 0 && form == static_cast<std::uint8_t>(EntryForm::edits))
      in.reject(ErrorCode::bad_value, "a tile is not a snapshot");
    if (!in.ok() || form == static_cast<std::uint8_t>(EntryForm::snapshot))
      return take_snapshot(in, key, version, digest);
    return take_edits(in, key, version, digest);
  }

 private:
  ChunkSnapshot take_snapshot(ByteReader& in, const ChunkKey& key, const Version& version,
                              const Digest& digest) const {
    ChunkSnapshot snapshot;
    snapshot.key = key;
    snapshot.chunk.version = version;
    snapshot.chunk.digest = digest;
    const auto size =
        static_cast<std::size_t>(in.varint_max(kChunkBytesMax, "chunk exceeds the largest one"));
    const ByteView data = in.bytes(size);
    if (!in.ok()) return snapshot;
    auto voxels = chunk_edge_ == 0
                      ? decode_chunk(data)
                      : decode_chunk(data, Extent::cube(static_cast<unsigned>(chunk_edge_)));
    if (voxels) {
      snapshot.chunk.voxels = *std::move(voxels);
    } else {
      in.reject(voxels.error().code, voxels.error().what);
    }
    return snapshot;
  }

  static ChunkEdits take_edits(ByteReader& in, const ChunkKey& key, const Version& to,
                               const Digest& digest) {
    ChunkEdits answer;
    answer.key = key;
    answer.to = to;
    answer.digest = digest;
    const std::uint64_t back = in.varint_max(to.seq, "chunk edits start before the log");
    if (in.ok() && back == 0) in.reject(ErrorCode::bad_value, "chunk edits end where they start");
    answer.from = to.seq - back;
    const auto size = static_cast<std::size_t>(
        in.varint_max(kServerChunkBytesMax, "chunk edits exceed a message"));
    const ByteView bytes = in.bytes(size);
    if (!in.ok()) return answer;
    auto edits = decode_missing_edits(bytes, answer.from);
    if (!edits) {
      in.reject(edits.error().code, edits.error().what);
      return answer;
    }
    answer.edits = *std::move(edits);
    if (answer.edits.back().seq != to.seq)
      in.reject(ErrorCode::bad_value, "chunk edits do not end at the version of the chunk");
    return answer;
  }

  std::int32_t chunk_edge_;
};

}  // namespace

ChunkEntry encode_snapshot(const ChunkKey& key, const Chunk& chunk, ChunkEncoding encoding) {
  const Bytes data = encode_chunk(chunk.voxels, encoding);
  auto bytes = std::make_shared<Bytes>();
  ByteWriter out(*bytes);
  put_entry_head(out, EntryForm::snapshot, chunk.version, chunk.digest);
  out.varint(data.size());
  out.bytes(data);
  return {key, std::move(bytes), chunk.voxels.runs.size()};
}

ChunkEntry encode_chunk_edits(const ChunkEdits& edits) {
  RUNSTONE_ASSERT(!edits.edits.empty() && edits.edits.size() <= kChunkEditsMax);
  RUNSTONE_ASSERT(edits.edits.back().seq == edits.to.seq && edits.from < edits.to.seq);
  const Bytes list = encode_missing_edits(edits.edits, edits.from);
  auto bytes = std::make_shared<Bytes>();
  ByteWriter out(*bytes);
  put_entry_head(out, EntryForm::edits, edits.to, edits.digest);
  out.varint(edits.to.seq - edits.from);
  out.varint(list.size());
  out.bytes(list);
  return {edits.key, std::move(bytes), 0};
}

bool ChunksBuilder::fits(const ChunkEntry& entry) const {
  if (entries_.empty()) return true;
  return entry.key.lod == entries_.front().key.lod && entries_.size() < kChunksPerMessageMax &&
         runs_ + entry.runs <= kRunsPerMessageMax && bytes_ + entry.bytes->size() <= kBytesMax &&
         std::none_of(
             entries_.begin(), entries_.end(),
             [&](const ChunkEntry& other) { return other.key == entry.key; });
}

void ChunksBuilder::add(ChunkEntry entry) {
  RUNSTONE_ASSERT(fits(entry));
  bytes_ += entry.bytes->size();
  runs_ += entry.runs;
  entries_.push_back(std::move(entry));
}

EncodedMessage ChunksBuilder::take(std::uint32_t view) {
  std::sort(entries_.begin(), entries_.end(),
            [](const ChunkEntry& a, const ChunkEntry& b) { return a.key < b.key; });
  EncodedMessage message = join_entries(view, entries_);
  entries_.clear();
  bytes_ = runs_ = 0;
  return message;
}

ChunkEntry encode_answer(const ChunkAnswer& answer) {
  if (const auto* edits = std::get_if<ChunkEdits>(&answer)) return encode_chunk_edits(*edits);
  const auto& snapshot = std::get<ChunkSnapshot>(answer);
  return encode_snapshot(snapshot.key, snapshot.chunk, ChunkEncoding::raw);
}

Bytes list_of(std::span<const ChunkEntry> entries) {
  RUNSTONE_ASSERT(!entries.empty() && entries.size() <= kChunksPerMessageMax);
  Bytes list;
  ByteWriter out(list);
  KeyWriter keys(entries.front().key.lod);
  std::size_t runs = 0;
  for (const ChunkEntry& entry : entries) {
    keys.put(out, entry.key);
    out.bytes(*entry.bytes);
    runs += entry.runs;
  }
  RUNSTONE_ASSERT(entries.size() == 1 || runs <= kRunsPerMessageMax);
  return list;
}

Result<std::vector<ChunkAnswer>> decode_answers(ByteView bytes, std::uint8_t level,
                                                std::int32_t key_edge, std::int32_t chunk_edge) {
  KeyReader keys(key_edge, level);
  const EntryReader entries(chunk_edge);
  std::size_t runs = 0;
  bool is_first = true;
  return entries_of<ChunkAnswer>(bytes, kChunksPerMessageMax, [&](ByteReader& in) -> ChunkAnswer {
    const ChunkKey key = keys.take(in);
    ChunkAnswer answer = entries.take(in, key);
    // A few bytes can be many runs, so the bytes alone do not bound what a message unpacks to.
    if (const auto* snapshot = std::get_if<ChunkSnapshot>(&answer))
      runs += snapshot->chunk.voxels.runs.size();
    if (!std::exchange(is_first, false) && runs > kRunsPerMessageMax)
      in.reject(ErrorCode::limit_exceeded, "chunks of one message have too many runs");
    return answer;
  });
}

}  // namespace runstone
