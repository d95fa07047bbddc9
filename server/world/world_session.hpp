// WorldSession: what the world strand knows of one connection. Its stage goes from greeting over authenticating to
// open. Closing forgets it at once.
#pragma once
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/core/bytes.hpp"
#include "protocol/codec/message_table.hpp"
#include "server/interest/held_claims.hpp"
#include "server/limits/token_bucket.hpp"

namespace runstone {

inline constexpr std::size_t kPassedViewsMax = 8;
inline constexpr std::size_t kUniformGathered = 256;     // then they go
inline constexpr std::size_t kUniformWaitingMax = 1024;  // for a queue with room: then chunks wait
static_assert(kUniformWaitingMax <= kUniformChunksMax);
/// An undo reads the log, so a session may not ask for very many.
inline constexpr std::uint64_t kCommandsPerSecond = 10, kCommandBurst = 20;

/// A session's stay in the past.
struct HistoryView {
  std::uint32_t number = 0;  // of all visits of the server: what workers bring belongs to it
  std::uint32_t request = 0;
  Sequence seq = 0;  // the last edit it sees
  std::map<ChunkKey, Version>
      sent;                  // what it has of the past: need not be sent again while the view stays
  std::size_t loading = 0;   // chunks that workers are at for this request
  bool is_complete = false;  // it was told that all of its view was sent
};

struct WorldSession {
  SessionStage state = SessionStage::greeting;
  std::uint64_t features = 0;  // in force, from Welcome on
  TimeUs connected_us = 0;     // steady clock, as the others
  TimeUs heard_us = 0;         // last message
  PublicKey key{};
  ClientInstance instance = 0;
  std::string name;
  Bytes proof_transcript;  // what the client has to sign; empty outside of authenticating
  AuthorId author = 0;     // from open on
  Pose pose;
  bool pose_changed = false;  // since the last poses
  bool has_roster = false;    // it knows who was here when the roster was last told
  Sequence durable_told = 0;  // the last watermark it got, by welcome at first
  Sequence awaits_durable =
      0;  // its own edits reach up to here: it is told at once when that is on disk
  std::vector<Reject> owed;  // answers that did not fit its queue, in order: again when it drains
  TokenBucket edits{0, 0};
  TokenBucket commands{kCommandsPerSecond, kCommandBurst};
  std::optional<std::uint32_t> command;  // id of the one under way
  // Views (view_turns.hpp).
  std::optional<View> next_view;    // the newest, while it has not taken effect
  std::optional<TimeUs> viewed_us;  // when the last one did
  std::vector<View>
      passed_views;  // that next_view replaced before they did: kPassedViewsMax at most,
  bool has_passed_too_many = false;  // more of them count as having left everything
  // What it holds already (held_steps.hpp).
  HeldClaims claims;
  std::vector<UnmodifiedChunk> same_due;  // subscribed, but not told yet
  // Chunks of one material that were counted as sent, at these versions, and go in one message soon: a few
  // wait for more while loads are under way.
  std::vector<UniformChunk> uniform;
  // Time travel (time_travel.hpp).
  std::optional<HistoryRequest> next_travel;  // the newest wish that nothing was done for yet
  bool opens_moment = false;                  // a worker is at one
  std::optional<HistoryView> visit;           // nothing: it sees the live world
  std::optional<HistoryState> begins_due;     // to be sent before any further chunk
  std::optional<HistoryState> word_due;       // after it: all was sent, or a wish was refused
  std::optional<TimeUs>
      stalled_us;  // its queue was full then: no snapshots until drained or the retry interval
};

}  // namespace runstone
