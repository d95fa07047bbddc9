// WorldState: the data of the world strand, as plain parts. The handlers and schedulers beside it
// are free functions over it. WorldServer is its interface.
#pragma once
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "common/rights/rights_state.hpp"
#include "server/interest/interest.hpp"
#include "server/limits/address_ledger.hpp"
#include "server/limits/budget_ledger.hpp"
#include "server/limits/recent_refusals.hpp"
#include "server/world/authority.hpp"
#include "server/world/chat_state.hpp"
#include "server/world/checkpointer.hpp"
#include "server/world/followers.hpp"
#include "server/world/following.hpp"
#include "server/world/key_deposits.hpp"
#include "server/world/large_edit_pace.hpp"
#include "server/world/listed_servers.hpp"
#include "server/world/load_queue.hpp"
#include "server/world/load_retries.hpp"
#include "server/world/name_claims.hpp"
#include "server/world/owner_choice.hpp"
#include "server/world/players.hpp"
#include "server/world/session_output.hpp"
#include "server/world/session_turns.hpp"
#include "server/world/tile_queue.hpp"
#include "server/world/tile_resends.hpp"
#include "server/world/unwritten_log.hpp"
#include "server/world/world_config.hpp"
#include "server/world/world_counters.hpp"
#include "server/world/world_environment.hpp"
#include "server/world/world_session.hpp"

namespace runstone {

/// Why edits are rejected, for players and operators: while disk_is_full, and while
/// is_memory_full().
inline constexpr const char* kDiskIsFull = "the world's disk is full";
/// A claim of a name costs its address so much, of names_per_address units a second: an hour's worth.
inline constexpr std::uint64_t kClaimPrice = 3'600;
/// A wrong password or device code costs its address so much of kGuessBudget, and so does a key that
/// is left for another device: ten at once, then one a minute. People mistype less often, and whoever
/// guesses gets nowhere. A setting would only serve to weaken it.
inline constexpr std::uint64_t kGuessPrice = 60;
inline constexpr Budget kGuessBudget{1, 10 * kGuessPrice};
/// A player who joins with the password for the first time costs the address one of these: a school
/// class at once, then one a second. Otherwise new keys of one address could use up all grants.
inline constexpr Budget kJoinBudget{1, 60};
inline constexpr const char* kTooManyGuesses =
    "too many wrong passwords or codes came from your network: wait a minute";
inline constexpr const char* kMemoryIsFull = "the server's memory is full (memory_mib)";

/// The facts in the player list about a player, besides the key.
struct ListedEntry {
  std::string name, role;
  friend bool operator==(const ListedEntry&, const ListedEntry&) = default;
};

/// A state of a tile. Two tiles with equal states have the same voxels and the same version.
struct TileState {
  Version version;
  Digest digest;             // of the voxels
  bool is_complete = false;  // MadeTile::is_complete()
  friend bool operator==(const TileState&, const TileState&) = default;
};

/// The sessions that have a tile.
struct TileReceivers {
  std::vector<SessionId> sessions;  // ascending
  std::optional<TimeUs> made_us;    // when it was made last
  /// The state in which it was made last, and MadeTile::through of that. All of them have it, or one
  /// that they claimed, or get it from TileResends. A session that sees the past may have an earlier
  /// one.
  std::optional<TileState> state;
  Sequence through = 0;
};

/// Tiles (tile_handlers.hpp).
struct WorldTiles {
  TileQueue queue;
  TileResends resends;
  std::size_t past_in_flight = 0;         // past tiles with workers (past_tiles.hpp)
  std::map<ChunkKey, Payer> payers;       // of the tiles that workers make because a session waits
  ChunkHashMap<TileReceivers> receivers;  // no entry is without sessions for long
  // Chunks that commits touched since the tiles above them were last made stale. They may repeat.
  std::vector<ChunkKey> edited;
};

struct WorldState {
  WorldState(WorldConfig config_, const WorldStart& start, WorldEnvironment& environment_,
             RandomBytes random_);

  WorldConfig config;
  WorldEnvironment& environment;
  SessionOutput output;
  RandomBytes random;
  Authority authority;
  Checkpointer checkpointer;
  Interest interest;
  LoadQueue loads;
  LoadRetries load_retries;
  Players players;
  NameClaims names;
  RightsState rights;
  ClientInstance change_instance = 0;    // of the changes of rights and materials of this run
  ClientSequence change_client_seq = 0;  // of the last one
  Sequence rights_seq = 0;               // of the last change of rights; 0: none in this run
  Sequence materials_seq = 0;            // likewise, of new materials
  BudgetLedger edit_ledger;
  BudgetLedger load_ledger;  // a unit is a chunk that is generated or read for a view
  AddressLedger claim_ledger;
  AddressLedger guess_ledger{kGuessBudget}, deposit_ledger{kGuessBudget};
  AddressLedger join_ledger{kJoinBudget};
  KeyDeposits key_deposits;
  RecentRefusals refusals;
  ChatState chat;
  LargeEditPace large_edits;
  WorldTiles tiles;
  std::map<SessionId, WorldSession> sessions;  // ordered, so that no result depends on a hash
  // The open sessions that are connected here, by their client.
  std::map<std::pair<AuthorId, ClientInstance>, SessionId> clients;
  std::map<SessionId, Follower> followers;  // other servers, by their session (followers.hpp)
  // Set while another server owns the world, and this one follows it (following.hpp).
  std::unique_ptr<Following> following;
  std::uint64_t edits_here = 0;  // of players here, accepted since this server owns the world
  OwnerChoice owner_choice;
  std::optional<SessionId> better_owner;  // as WorldServer::take_better_owner() returns it
  UnwrittenLog unwritten;                 // of the owner, if it may be followed
  ListedServers listed;
  std::vector<AuthorId> gone_authors;  // of sessions that ended since the last tick
  WorldCounters counters;
  Sequence durable = 0;
  bool accepts_edits =
      true;  // false: edits are rejected busy, because the server stops or the log failed
  bool disk_is_full = false;  // edits are rejected busy until there is space again
  // As of the last tick:
  bool is_memory_short = false;  // all sessions wait for memory to load chunks
  // Sessions for which no chunk is loaded until the next tick, because their address sees more than
  // its share of the memory, or because a budget is used up.
  std::set<SessionId> loads_wait;
  bool is_stopping = false;
  bool hands_over = false;  // a stop is under way, and another server takes the world over
  TimeUs stop_due_us = 0;   // when a stop that is under way begins no more snapshots
  // Presence.
  bool player_list_changed = false;
  std::map<AuthorId, ListedEntry> sent_player_list;
  TimeUs poses_us = 0;           // when poses were sent last
  SessionId pose_sent_last = 0;  // the session whose pose was sent last
  TimeUs durable_due_us = 0;     // when every session gets the durable watermark next
  // Digest checks.
  TimeUs digest_checks_us = 0;      // up to this time, all that were due are sent
  SessionId digest_check_last = 0;  // the session served last
  bool are_runs_short = false;      // not all chunks of the last checks were hashed
  // Delivery.
  SessionTurns deliveries;  // sessions whose delivery goes on in a task of its own
  // Views.
  std::size_t view_chunks_left;     // that views may still visit on this tick
  bool views_wait = false;          // some views had to wait for the next tick
  SessionId view_applied_last = 0;  // the session whose view took effect last on a tick
  SessionId ground_sent_last = 0;   // the session whose protected ground was sent last on a tick
  // Time travel.
  std::uint32_t history_count = 0;    // history views since the start
  std::size_t histories_opening = 0;  // requests that workers open
  std::size_t log_mark_reads = 0;     // requests for marks that readers read

  std::vector<SessionId> open_sessions() const {
    std::vector<SessionId> open;
    for (const auto& [id, session] : sessions) {
      if (session.state == SessionStage::open) open.push_back(id);
    }
    return open;
  }
  /// Returns the session, or null if there is none.
  WorldSession* find(SessionId session) {
    const auto found = sessions.find(session);
    return found == sessions.end() ? nullptr : &found->second;
  }
  const WorldSession* find(SessionId session) const {
    const auto found = sessions.find(session);
    return found == sessions.end() ? nullptr : &found->second;
  }
};

/// Returns false if this server orders no edits: it stops, its log has failed, or another server owns
/// the world.
inline bool accepts_edits(const WorldState& world) {
  return world.accepts_edits && !world.following;
}
/// Sends goodbye with a reason and removes the session, if there is one.
void close_session(WorldState& world, SessionId session, GoodbyeReason reason,
                   const std::string& text);
/// Removes authors without a row and without a session from players and watermarks. Does nothing
/// while edits are queued.
void forget_gone_authors(WorldState& world);
/// Describes an open session for the operator's log.
PlayerVisit visit_of(const WorldState& world, SessionId session, const WorldSession& mine);
/// Removes a session that has disconnected, or is closed.
void forget_session(WorldState& world, SessionId session);
/// Sends a message that the session must not miss. Closes the session if its queue is full. Returns
/// true if the message is queued.
bool send_or_close(WorldState& world, SessionId session, const Message& message);
/// Sends a reject. If the session's queue is full, the reject is sent later, in order. A session
/// with too many pending rejects is closed.
void send_reject(WorldState& world, SessionId session, Reject reject);
/// Sends pending rejects as far as they fit, then the durable watermark if the session awaits it.
void send_pending_rejects(WorldState& world, SessionId session);
/// Returns the durable watermark.
EncodedMessage encoded_durable(const WorldState& world);
/// Sends the durable watermark, which `encoded` holds, unless the session has it. Does nothing
/// while rejects are pending, because they precede it. If the session's queue is full, a later call
/// sends it.
void send_durable(WorldState& world, SessionId session, const EncodedMessage& encoded);
/// Sends a message that a later one of its kind replaces. Returns false, and only counts, if the
/// session's queue is full.
bool send_or_skip(WorldState& world, SessionId session, const EncodedMessage& message);

}  // namespace runstone
