// WorldState: all that belongs to the world strand, as plain parts. The steps (handshake, requests, delivery,
// broadcast) are free functions over it; WorldServer is its face.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "server/interest/interest.hpp"
#include "server/world/authority.hpp"
#include "server/world/checkpointer.hpp"
#include "server/world/load_queue.hpp"
#include "server/world/players.hpp"
#include "server/world/world_config.hpp"
#include "server/world/world_counters.hpp"
#include "server/world/world_environment.hpp"
#include "server/world/world_session.hpp"

namespace runstone {

struct WorldState {
  WorldState(WorldConfig config_, const WorldStart& start, WorldEnvironment& ports_,
             RandomBytes random_);

  WorldConfig config;
  WorldEnvironment& ports;
  RandomBytes random;
  Authority authority;
  Checkpointer keeper;
  Interest interest;
  LoadQueue loads;
  Players players;
  std::map<SessionId, WorldSession>
      sessions;                        // by number: who receives first never depends on a hash
  std::vector<AuthorId> gone_authors;  // of sessions that ended since the last tick
  WorldCounters counters;
  Sequence durable = 0;
  bool accepts_edits = true;  // false: rejected busy (stopping, or the log failed)
  bool is_stopping = false;
  bool roster_changed = false;
  std::map<AuthorId, std::string> roster;  // as it was told
  TimeUs poses_us = 0, durable_us = 0;     // when everybody was told
  SessionId pose_served = 0;               // whose pose was told last
  TimeUs audits_us = 0;                    // of the last turn
  SessionId audit_served = 0;              // whose turn that was
  std::size_t view_chunks_left;            // of this tick's
  bool views_wait = false;                 // some had to be left for the next tick
  std::uint32_t visits = 0;                // to the past, ever
  std::size_t moments_opening = 0;         // by workers (time_travel.hpp)
  SessionId view_served = 0;               // whose view took effect last on a tick

  std::vector<SessionId> open_sessions() const {
    std::vector<SessionId> open;
    for (const auto& [id, session] : sessions) {
      if (session.state == SessionStage::open) open.push_back(id);
    }
    return open;
  }
  WorldSession* find(SessionId session) {
    const auto found = sessions.find(session);
    return found == sessions.end() ? nullptr : &found->second;
  }
};

/// Sends goodbye with a reason and forgets the session. Unknown sessions are allowed.
void close_session(WorldState& world, SessionId session, GoodbyeReason reason,
                   const std::string& text);
/// Once no edit is queued: forgets what only authors without a row and without a session have left.
void forget_gone_authors(WorldState& world);
/// Forgets a session that is gone.
void forget_session(WorldState& world, SessionId session);
/// Sends a message the session must not miss: closes the session if its queue is full. True if it is queued.
bool send_or_close(WorldState& world, SessionId session, const Message& message);
/// Answers an edit. What does not fit is owed and sent later, in order; a session that is owed too much is
/// closed.
void answer(WorldState& world, SessionId session, Reject reject);
/// Sends what the session is owed, as far as it fits: answers, then the durable watermark if it waits for it.
void send_owed(WorldState& world, SessionId session);
/// Tells the session what is on disk; `encoded` says it. Not before the answers it is owed: the watermark speaks of
/// them. What does not fit is sent by a later turn.
void tell_durable(WorldState& world, SessionId session, const EncodedMessage& encoded);
/// Sends a message that a later one of its kind replaces: a full queue only counts.
bool send_or_skip(WorldState& world, SessionId session, const EncodedMessage& message);

}  // namespace runstone
