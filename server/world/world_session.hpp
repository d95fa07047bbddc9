// WorldSession: the state of one connection on the world strand. Its stages are greeting,
// authenticating and open, in this order. A session that is closed is removed at once.
#pragma once
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/core/address_block.hpp"
#include "common/core/bytes.hpp"
#include "common/core/channel_binding.hpp"
#include "common/core/token_bucket.hpp"
#include "protocol/codec/message_table.hpp"
#include "server/interest/cache_claims.hpp"
#include "server/interest/tile_interest.hpp"
#include "server/limits/followed_position.hpp"
#include "server/world/world_environment.hpp"

namespace runstone {

/// Views that were replaced before they took effect. Beyond so many, every chunk counts as dropped
/// by the client.
inline constexpr std::size_t kSkippedViewsMax = 8;
/// Uniform chunks are sent when so many are due.
inline constexpr std::size_t kUniformPerMessage = 256;
/// Uniform chunks that may be due while the session's queue is full. Further chunks stay wanted.
inline constexpr std::size_t kUniformWaitingMax = 1024;
static_assert(kUniformWaitingMax <= kUniformChunksMax);
/// The rate of commands is low because an undo reads the log.
inline constexpr std::uint64_t kCommandsPerSecond = 10, kCommandBurst = 20;

/// A session gets so many lines that say why its own lines are not passed on.
inline constexpr std::uint64_t kChatAnswersPerSecond = 1, kChatAnswerBurst = 3;

/// Previews that a session may send, and that it is sent, each second.
inline constexpr std::uint64_t kPreviewsPerSecond = 6, kPreviewBurst = 12;
inline constexpr std::uint64_t kPreviewsReadPerSecond = 20, kPreviewsReadBurst = 40;

/// A session's view of the past.
struct HistoryView {
  HistoryNumber number{};
  Sequence seq = 0;   // the last edit that it contains
  TimeUs utc_us = 0;  // when that edit was ordered
  // Chunks of the past that the session has. They are not sent again while the view stays.
  std::map<ChunkKey, Version> sent;
  std::size_t loading = 0;  // chunks that workers make for this view
};

/// What a session knows of rights (protected_ground.hpp).
struct SentGround {
  std::optional<Permissions> permissions;  // sent last
  bool are_permissions_due = false;
  TimeUs restricted_until_us = 0;  // when a restriction of the player ends, UTC; 0: none does
  std::map<Sequence, bool> boxes;  // sent, by the record of each; whether it admits the player
  bool are_boxes_due = false;
};

/// Times are of the steady clock.
struct WorldSession {
  SessionStage state = SessionStage::greeting;
  std::uint64_t features = 0;       // in force, from welcome on
  std::size_t materials_known = 0;  // rows of the material table that it has, from welcome on
  Epoch epoch = 0;                  // that it knows, from welcome on
  TimeUs connected_us = 0;
  TimeUs last_message_us = 0;
  AddressBlock address{};
  std::optional<ChannelBinding> binding;  // of an encrypted connection
  PublicKey key{};
  ClientInstance instance = 0;
  std::string name;
  /// The session is connected to another server, which sends it terrain and commits
  /// (followers.hpp).
  bool is_relayed = false;
  Bytes auth_transcript;          // the bytes that the client must sign; empty in other stages
  bool is_authenticated = false;  // the session opens when the claim of its name is on disk
  std::string no_role;  // why the player's invite or password gave no role, until it is told
  AuthorId author = 0;  // valid when open
  Pose pose;
  bool pose_changed = false;     // since poses were sent last
  FollowedPosition position;     // the reach of edits is measured from there
  bool has_player_list = false;  // it got the full player list and all changes since
  // Durable watermark.
  Sequence durable_sent = 0;  // the last one sent; welcome sends the first
  bool read_only_sent = false;
  Sequence awaits_durable =
      0;  // the client's last edit; the session gets the watermark at once until then
  // The last action of which an edit was refused, and why: its later edits are refused as well. A move
  // then does not clear a place whose copy was refused.
  ClientSequence refused_action = 0;
  RejectReason refused_reason = RejectReason::busy;
  // While another server owns the world (following.hpp).
  bool is_at_owner = false;        // the owner knows of the session
  std::optional<ClientAuth> join;  // authenticated, until the owner has let the player in
  // The server that orders the edits has changed, or was out of reach. Edits of the client are ignored
  // until it has answered every Resume.
  bool needs_resume = false;
  std::uint32_t resumes_unanswered = 0;
  std::uint64_t servers_sent = 0;  // number of the last list of servers (listed_servers.hpp)
  // Rejects that did not fit the session's queue, in order. They are sent when it drains.
  std::vector<Reject> pending_rejects;
  TokenBucket commands{kCommandsPerSecond, kCommandBurst};
  std::optional<std::uint32_t> command;  // id of the command under way
  TokenBucket chat_answers{kChatAnswersPerSecond, kChatAnswerBurst};
  // Previews (preview_handlers.hpp).
  TokenBucket previews{kPreviewsPerSecond, kPreviewBurst};                // that it sends
  TokenBucket previews_read{kPreviewsReadPerSecond, kPreviewsReadBurst};  // that it is sent
  std::vector<SessionId> preview_readers;  // sessions that show its last preview, ascending
  // Views (view_scheduler.hpp).
  std::uint32_t view_number = 0;          // of the newest view that the client sent
  std::optional<View> next_view;          // the newest view, until it takes effect
  std::optional<TimeUs> view_applied_us;  // when a view took effect last
  std::vector<View> skipped_views;    // replaced before they took effect, at most kSkippedViewsMax
  bool has_skipped_too_many = false;  // there were more
  SentGround ground;
  // Tiles (tile_handlers.hpp).
  std::optional<TileInterest> tiles;  // nullopt: no view had tiles yet
  // Past tiles (past_tiles.hpp).
  std::optional<Sequence> tiles_at;      // the moment that they show; nullopt: the live world
  std::size_t past_tiles_in_flight = 0;  // with workers, those of earlier moments included
  TimeUs past_tiles_retry_us = 0;        // none is requested before
  // Cached chunks (cached_chunk_handlers.hpp).
  CacheClaims claims;
  std::vector<UnmodifiedChunk> not_modified_due;  // subscribed, and not answered yet
  // Chunks of one material that are subscribed at these versions and not sent yet. While loads are
  // under way, a few wait for more, to be sent in one message.
  std::vector<UniformChunk> uniform;
  // Time travel (time_travel.hpp).
  std::optional<HistoryRequest> next_history_request;  // the newest request, until it is answered
  bool is_opening_history = false;                     // a worker opens a request
  TimeUs history_due_us = 0;                           // when the next request may take effect
  std::optional<HistoryView> history;                  // nullopt: the session sees the live world
  std::uint32_t history_request = 0;                   // the newest one that was answered
  // Marks of the log (log_mark_handlers.hpp).
  std::optional<LogMarksRequest> next_log_marks;  // the newest request, until it is read
  bool is_reading_log_marks = false;
  TimeUs log_marks_due_us = 0;  // when the next request may take effect
  // Reports that precede the session's next chunk, in this order.
  std::optional<ViewState> begins_due, refused_due, complete_due;
  bool is_view_complete = true;  // of the view in force it was reported, or there is no view
  // When the session's queue was full. No chunks are sent until it drains or the retry interval has
  // passed.
  std::optional<TimeUs> stalled_us;
};

}  // namespace runstone
