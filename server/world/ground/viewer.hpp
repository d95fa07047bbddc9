// Viewer: what an open session sees of the world, and what it was sent. Each record belongs to one
// part of the ground.
#pragma once
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "server/interest/cache_claims.hpp"
#include "server/interest/tile_interest.hpp"
#include "server/world/environment/world_environment.hpp"
#include "server/world/sessions/session.hpp"

namespace runstone {

/// Messages that are due to a session (chunk_sending.hpp).
struct ChunksDue {
  CacheClaims claims;
  std::vector<UnmodifiedChunk> not_modified;  // subscribed, and not answered yet
  // Chunks of one material that are subscribed at these versions and not sent yet. While loads are
  // under way, a few wait for more, to be sent in one message.
  std::vector<UniformChunk> uniform;
  // Reports that precede the session's next chunk, in this order.
  std::optional<ViewState> begins, refused, complete;
  bool is_view_complete = true;  // of the view in force it was reported, or there is no view
  // When the session's queue was full. No chunks are sent until it drains or the retry interval has
  // passed.
  std::optional<TimeUs> stalled_us;
};

/// A session's view of the past.
struct HistoryView {
  HistoryNumber number{};
  Sequence seq = 0;   // the last edit that it contains
  TimeUs utc_us = 0;  // when that edit was ordered
  // Chunks of the past that the session has. They are not sent again while the view stays.
  std::map<ChunkKey, Version> sent;
  std::size_t loading = 0;  // chunks that workers make for this view
};

/// Time travel (time_travel.hpp).
struct PastSeen {
  std::optional<HistoryRequest> next;  // the newest request, until it is answered
  bool is_opening = false;             // a worker opens a request
  TimeUs due_us = 0;                   // when the next request may take effect
  std::optional<HistoryView> view;     // nullopt: the session sees the live world
  std::uint32_t request = 0;           // the newest one that was answered
};

/// Tiles (tiles.hpp, past_tiles.hpp).
struct TilesSeen {
  std::optional<TileInterest> interest;  // nullopt: no view had tiles yet
  std::optional<Sequence> at;            // the moment that they show; nullopt: the live world
  std::size_t past_in_flight = 0;  // past tiles with workers, those of earlier moments included
  TimeUs past_retry_us = 0;        // none is requested before
};

/// Views that were replaced before they took effect. Beyond so many, every chunk counts as dropped
/// by the client.
inline constexpr std::size_t kSkippedViewsMax = 8;

/// Views (views.hpp).
struct ViewDue {
  std::uint32_t number = 0;           // of the newest view that the client sent
  std::optional<View> next;           // the newest view, until it takes effect
  std::optional<TimeUs> applied_us;   // when a view took effect last
  std::vector<View> skipped;          // replaced before they took effect, at most kSkippedViewsMax
  bool has_skipped_too_many = false;  // there were more
};

/// Rights and protected boxes of which a session knows (ground_rules.hpp).
struct GroundSent {
  std::optional<Permissions> permissions;  // sent last
  bool are_permissions_due = false;
  TimeUs restricted_until_us = 0;  // when a restriction of the player ends, UTC; 0: none does
  std::map<Sequence, bool> boxes;  // sent, by the record of each; whether it admits the player
  bool are_boxes_due = false;
};

/// Marks of the log (log_marks.hpp).
struct LogMarksDue {
  std::optional<LogMarksRequest> next;  // the newest request, until it is read
  bool is_reading = false;
  TimeUs due_us = 0;  // when the next request may take effect
};

struct Viewer {
  explicit Viewer(Session& session_) : session(session_) {}
  SessionId id() const { return session.id; }
  bool sees_past() const { return past.view.has_value(); }

  Session& session;
  ChunksDue chunks;
  PastSeen past;
  TilesSeen tiles;
  ViewDue view;
  GroundSent ground;
  LogMarksDue marks;
};

}  // namespace runstone
