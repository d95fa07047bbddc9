// Sessions: the connections of players, here and through other servers, and what is sent to them. A
// session that is closed is marked, and removed when the task of the world strand ends. So a
// reference stays valid as long as the task that found it, and whoever keeps one looks at
// Session::is_closed. A closed session accepts everything: its messages are dropped.
//
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "server/world/environment/world_counters.hpp"
#include "server/world/environment/world_environment.hpp"
#include "server/world/sessions/session.hpp"
#include "server/world/sessions/session_output.hpp"

namespace runstone {

class Sessions {
 public:
  /// `environment` and `counters` must outlive the object.
  Sessions(WorldEnvironment& environment, WorldCounters& counters)
      : environment_(environment), counters_(counters), output_(environment) {}

  /// Adds a connection. Requires that the number is new.
  Session& add(SessionId session, TimeUs now_us);
  /// Adds a session at another server, which has a number here, too.
  Session& add_relayed(const RelayedSession& relayed, TimeUs now_us);
  /// Returns the session, or null if there is none or it is closed.
  Session* find(SessionId session);
  const Session* find(SessionId session) const;
  /// Returns the sessions that are not closed, ascending, so that no result depends on a hash.
  std::vector<Session*> all();
  std::vector<const Session*> all() const;
  /// Returns the open sessions, ascending.
  std::vector<Session*> open();
  std::vector<const Session*> open() const;
  /// Returns the number of sessions in any stage that are not closed.
  std::size_t count() const { return sessions_.size() - closed_.size(); }
  /// Returns the open session of a client that is connected here, or null.
  Session* of_client(AuthorId author, ClientInstance instance) const;
  /// Returns where the session is connected, or null if it is connected here.
  const RelayedSession* relayed(SessionId session) const { return output_.relayed(session); }

  /// Makes the session one of the world, under this author number.
  void enter(Session& session, AuthorId author, TimeUs now_us);
  /// Sends goodbye with a reason and closes the session. Does nothing if it is closed already.
  void close(Session& session, GoodbyeReason reason, const std::string& text);
  /// Closes the session of a connection that has ended.
  void leave(Session& session);
  /// Removes a connection that is no player's any more, without closing it.
  void release(Session& session) { mark_closed(session); }
  /// Returns the sessions that were closed and are still known, in the order in which they were
  /// closed.
  const std::vector<Session*>& closed() const { return closed_; }
  /// Removes the closed sessions. No reference to one may be in use.
  void remove_closed();

  /// Queues a message. Returns false if the session's queue is full; the message is dropped then.
  bool send(const Session& session, const EncodedMessage& message);
  /// Sends a message that the session must not miss. Closes the session if its queue is full.
  /// Returns true if the message is queued.
  bool send_or_close(Session& session, const EncodedMessage& message);
  bool send_or_close(Session& session, const Message& message) {
    return send_or_close(session, encode_message(message));
  }
  /// Sends a message that a later one of its kind replaces. Returns false, and only counts, if the
  /// session's queue is full.
  bool send_or_skip(const Session& session, const EncodedMessage& message);
  /// Sends a message to sessions. Counts and returns those whose queue is full.
  std::vector<SessionId> send_to_all(std::span<const SessionId> sessions,
                                     const EncodedMessage& message);
  /// Closes the session because its queue is full.
  void close_slow(Session& session);
  /// Counts bytes as read from the session, beyond those of its messages.
  void charge_reading(const Session& session, std::size_t bytes);

 private:
  void mark_closed(Session& session);
  PlayerVisit visit_of(const Session& session) const;

  WorldEnvironment& environment_;
  WorldCounters& counters_;
  SessionOutput output_;
  std::map<SessionId, Session> sessions_;
  // The open sessions that are connected here, by their client.
  std::map<std::pair<AuthorId, ClientInstance>, Session*> clients_;
  std::vector<Session*> closed_;
};

}  // namespace runstone
