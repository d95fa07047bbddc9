#include <utility>

#include "protocol/codec/body_reader.hpp"
#include "protocol/codec/chunk_entries.hpp"
#include "protocol/codec/chunk_lists.hpp"
#include "protocol/codec/key_list.hpp"
#include "protocol/codec/uniform_list.hpp"

namespace runstone {
namespace {

// Lists of chunks answer a view, and views are counted from 1.
constexpr const char* kNoView = "chunks answer view 0";
constexpr const char* kNoLevel = "chunks have a level of detail above 8";

}  // namespace

Result<Message> BodyReader::read(const wire::View& t) const {
  View m{t.number(), {}, t.radius_h(), t.radius_v(), t.yaw(), t.pitch(), t.cone(), t.levels()};
  if (m.number == 0) return bad("views are numbered from 1");
  if (m.cone > kViewConeMax) return bad("view cone exceeds half a turn");
  if (!take_coord(t.x(), t.y(), t.z(), key_edge(), m.centre))
    return bad("view centre is outside the world");
  if (m.radius_h > kViewRadiusMax || m.radius_v > kViewRadiusMax)
    return bad("view radius exceeds 64 chunks");
  if (m.levels > kTileLevelMax) return bad("view has more than 8 levels of tiles");
  return m;
}

Result<Message> BodyReader::read(const wire::ChunkRequest& t) const {
  auto keys = decode_keys(view_of(t.chunks()), kChunkRequestKeysMax, key_edge());
  if (!keys) return failure(keys.error());
  return Message{ChunkRequest{*std::move(keys)}};
}

Result<Message> BodyReader::read(const wire::CachedChunks& t) const {
  if (t.level() > kTileLevelMax) return bad(kNoLevel);
  auto chunks = decode_cached_chunks(view_of(t.chunks()), t.level(), key_edge());
  if (!chunks) return failure(chunks.error());
  return Message{CachedChunks{*std::move(chunks)}};
}

Result<Message> BodyReader::read(const wire::Chunks& t) const {
  if (t.view() == 0) return bad(kNoView);
  if (t.level() > kTileLevelMax) return bad(kNoLevel);
  auto chunks = decode_answers(view_of(t.chunks()), t.level(), key_edge(), chunk_edge);
  if (!chunks) return failure(chunks.error());
  return Message{Chunks{t.view(), *std::move(chunks)}};
}

Result<Message> BodyReader::read(const wire::UniformChunks& t) const {
  if (t.view() == 0) return bad(kNoView);
  if (t.level() > kTileLevelMax) return bad(kNoLevel);
  auto chunks = decode_uniform(view_of(t.chunks()), t.level(), key_edge());
  if (!chunks) return failure(chunks.error());
  return Message{UniformChunks{t.view(), *std::move(chunks)}};
}

Result<Message> BodyReader::read(const wire::ChunksNotModified& t) const {
  if (t.view() == 0) return bad(kNoView);
  if (t.level() > kTileLevelMax) return bad(kNoLevel);
  auto chunks = decode_unmodified(view_of(t.chunks()), t.level(), key_edge());
  if (!chunks) return failure(chunks.error());
  return Message{ChunksNotModified{t.view(), *std::move(chunks)}};
}

Result<Message> BodyReader::read(const wire::ChunkUnavailable& t) const {
  if (t.view() == 0) return bad(kNoView);
  if (t.reason() == 0) return bad("unavailable reason is 0");
  auto keys = decode_keys(view_of(t.chunks()), kUnavailableKeysMax, key_edge());
  if (!keys) return failure(keys.error());
  // Readers accept reasons that they do not know.
  return Message{
      ChunkUnavailable{t.view(), *std::move(keys), static_cast<UnavailableReason>(t.reason())}};
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

Result<Message> BodyReader::read(const wire::ViewState& t) const {
  ViewState m;
  if (t.phase() == 0 || t.phase() > kViewPhaseMax) return bad("view state phase is unknown");
  const bool is_asked = t.past() || t.phase() == static_cast<std::uint8_t>(ViewPhase::refused);
  if (is_asked && t.request() == 0) return bad("view state answers no history request");
  if (t.phase() == static_cast<std::uint8_t>(ViewPhase::complete) && t.view() == 0)
    return bad("view state completes view 0");
  if (t.seq() > kSequenceMax || (!t.past() && t.seq() != 0))
    return bad("view state sequence is out of range");
  if (!is_time(t.utc_us()) || (t.seq() == 0 && t.utc_us() != 0))
    return bad("view state time is out of range, or not 0 before the first edit");
  m.request = t.request();
  m.view = t.view();
  m.phase = static_cast<ViewPhase>(t.phase());
  m.past = t.past();
  m.seq = t.seq();
  m.utc_us = t.utc_us();
  if (!take_text(t.text(), 0, kTextBytesMax, m.text))
    return bad("view state text is not 0 .. 256 bytes of text");
  return m;
}

Result<Message> BodyReader::read(const wire::DigestCheck& t) const {
  auto entries = decode_digest_checks(view_of(t.chunks()), key_edge());
  if (!entries) return failure(entries.error());
  return Message{DigestCheck{*std::move(entries)}};
}

}  // namespace runstone
