#include <utility>

#include "protocol/codec/body_reader.hpp"
#include "protocol/codec/chunk_lists.hpp"
#include "protocol/codec/uniform_list.hpp"

namespace runstone {
namespace {

/// Copies 1 .. count_max keys. Returns false if there are too few or too many, or if one lies
/// outside the world.
bool take_keys(const flatbuffers::Vector<const wire::Key*>* from, std::size_t count_max,
               std::int32_t edge, std::vector<ChunkKey>& to) {
  const auto count = count_of(from, count_max);
  if (!count || *count == 0) return false;
  to.resize(*count);
  for (std::uint32_t i = 0; i < *count; ++i) {
    if (!take_key(from->Get(i), edge, to[i])) return false;
  }
  return true;
}

}  // namespace

Result<Message> BodyReader::read(const wire::View& t) const {
  View m{{}, t.radius_h(), t.radius_v(), t.yaw(), t.pitch(), t.cone()};
  if (m.cone > kViewConeMax) return bad("view cone exceeds half a turn");
  if (!take_coord(t.x(), t.y(), t.z(), key_edge(), m.centre))
    return bad("view centre is outside the world");
  if (m.radius_h > kViewRadiusMax || m.radius_v > kViewRadiusMax)
    return bad("view radius exceeds 64 chunks");
  return m;
}

Result<Message> BodyReader::read(const wire::ChunkRequest& t) const {
  ChunkRequest m;
  if (!take_keys(t.keys(), kChunkRequestKeysMax, key_edge(), m.keys)) {
    return bad("chunk request has not 1 .. 64 keys inside the world");
  }
  return m;
}

Result<Message> BodyReader::read(const wire::CachedChunks& t) const {
  auto chunks = decode_cached_chunks(view_of(t.chunks()), key_edge());
  if (!chunks) return Unexpected<Error>{chunks.error()};
  return Message{CachedChunks{*std::move(chunks)}};
}

Result<Message> BodyReader::read(const wire::Chunk& t) const {
  ChunkSnapshot m;
  if (!take_key(t.key(), key_edge(), m.key))
    return bad("chunk key is missing or outside the world");
  if (!take_version(t.version(), m.chunk.version))
    return bad("chunk version is missing or half zero");
  if (!take_digest(t.digest(), m.chunk.digest))
    return bad("chunk digest is missing or not reduced");
  const ByteView data = view_of(t.data());
  auto voxels = chunk_edge == 0
                    ? decode_chunk(data)
                    : decode_chunk(data, Extent::cube(static_cast<unsigned>(chunk_edge)));
  if (!voxels) return Unexpected<Error>{voxels.error()};
  m.chunk.voxels = *std::move(voxels);
  return Message{std::move(m)};
}

Result<Message> BodyReader::read(const wire::UniformChunks& t) const {
  auto chunks = decode_uniform(view_of(t.data()), key_edge());
  if (!chunks) return Unexpected<Error>{chunks.error()};
  return Message{UniformChunks{*std::move(chunks)}};
}

Result<Message> BodyReader::read(const wire::ChunksNotModified& t) const {
  auto chunks = decode_unmodified(view_of(t.chunks()), key_edge());
  if (!chunks) return Unexpected<Error>{chunks.error()};
  return Message{ChunksNotModified{*std::move(chunks)}};
}

Result<Message> BodyReader::read(const wire::ChunkEdits& t) const {
  ChunkEdits m;
  if (!take_key(t.key(), key_edge(), m.key))
    return bad("chunk key is missing or outside the world");
  if (!take_version(t.to(), m.to)) return bad("chunk version is missing or half zero");
  if (!take_digest(t.digest(), m.digest)) return bad("chunk digest is missing or not reduced");
  m.from = t.from();
  if (m.from >= m.to.seq || m.to.seq > kSequenceMax)
    return bad("chunk edits do not end behind their start, or exceed 63 bits");
  auto edits = decode_missing_edits(view_of(t.edits()), m.from);
  if (!edits) return Unexpected<Error>{edits.error()};
  m.edits = *std::move(edits);
  if (m.edits.back().seq != m.to.seq)
    return bad("chunk edits do not end at the version of the chunk");
  return Message{std::move(m)};
}

Result<Message> BodyReader::read(const wire::ChunkUnavailable& t) const {
  ChunkUnavailable m;
  if (!take_keys(t.keys(), kUnavailableKeysMax, key_edge(), m.keys)) {
    return bad("unavailable chunks are not 1 .. 64 keys inside the world");
  }
  if (t.reason() == 0) return bad("unavailable reason is 0");
  // Readers accept reasons that they do not know.
  m.reason = static_cast<UnavailableReason>(t.reason());
  return m;
}

Result<Message> BodyReader::read(const wire::HistoryRequest& t) const {
  if (t.request() == 0) return bad("history requests start at 1");
  if (t.to() > kHistoryTargetMax) return bad("history request has an unknown target");
  const auto to = static_cast<HistoryTarget>(t.to());
  if (t.seq() > kSequenceMax || (to != HistoryTarget::sequence && t.seq() != 0)) {
    return bad("history request has a sequence that is out of range or not 0 for its target");
  }
  if (!is_time(t.utc_us()) || (to != HistoryTarget::time && t.utc_us() != 0)) {
    return bad("history request has a time that is out of range or not 0 for its target");
  }
  return HistoryRequest{t.request(), to, t.seq(), t.utc_us()};
}

Result<Message> BodyReader::read(const wire::HistoryState& t) const {
  HistoryState m;
  if (t.request() == 0) return bad("history state answers request 0");
  if (t.phase() == 0 || t.phase() > kHistoryPhaseMax) return bad("history state phase is unknown");
  if (t.seq() > kSequenceMax || (!t.past() && t.seq() != 0))
    return bad("history state sequence is out of range");
  if (!is_time(t.utc_us())) return bad("history state time is out of range");
  m.request = t.request();
  m.phase = static_cast<HistoryPhase>(t.phase());
  m.past = t.past();
  m.seq = t.seq();
  m.utc_us = t.utc_us();
  if (!take_text(t.text(), 0, kTextBytesMax, m.text))
    return bad("history state text is not 0 .. 256 bytes of text");
  return m;
}

Result<Message> BodyReader::read(const wire::DigestCheck& t) const {
  const auto count = count_of(t.entries(), kDigestCheckEntriesMax);
  if (!count) return bad("digest check has more than 1024 entries");
  DigestCheck m;
  m.entries.resize(*count);
  for (std::uint32_t i = 0; i < *count; ++i) {
    const wire::DigestCheckEntry& e = *t.entries()->Get(i);
    DigestCheckEntry& out = m.entries[i];
    if (!take_key(e.key(), key_edge(), out.key) || !take_version(e.version(), out.version) ||
        !take_digest(e.digest(), out.digest)) {
      return bad("digest check entry has a bad key, version or digest");
    }
  }
  return m;
}

}  // namespace runstone
