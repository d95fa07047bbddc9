// PlayersAtOwner: the players of a server that follows. What they do goes to the owner of the
// world: to join, to edit, to move, to write a line, to give a command. Bounds: edits whose wait is
// measured: kForwardedMax.
// Thread: the world strand.
#pragma once
#include <map>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "server/world/cluster/owner_link.hpp"
#include "server/world/people/edit_requests.hpp"
#include "server/world/people/joining.hpp"

namespace runstone {

/// The fate of a message of a player at a server that follows.
enum class PassedOn {
  no,    // the message is for this server
  yes,   // it is dealt with: sent, dropped, or answered
  full,  // the owner takes nothing: the connection must end
};

class PlayersAtOwner {
 public:
  PlayersAtOwner(Sessions& sessions, Order& order, OwnerLink& link, Joining& joining,
                 EditRequests& edits, Presence& presence)
      : sessions_(sessions),
        order_(order),
        link_(link),
        joining_(joining),
        edits_(edits),
        presence_(presence) {}

  /// Takes an authenticated player to the owner, now or when there is one. Returns false if the
  /// owner takes nothing.
  [[nodiscard]] bool join(Session& session, const ClientAuth& auth);
  /// Tells the owner of all sessions. Returns false if it takes nothing.
  [[nodiscard]] bool send_all();
  /// Handles a message of a player that is for the owner.
  [[nodiscard]] PassedOn on_message(Session& session, const Message& message, const Clocks& now);
  /// The owner has closed the session. It need not be told.
  void closed_by_owner(const Session& session) { known_.erase(session.id); }
  /// The owner has let the player in, or the session goes on.
  void accepted(const Session& session) { joins_.erase(session.id); }
  /// Measures how long edits of players here have waited.
  void add_waits(std::span<const LogPartRecord> records, const Clocks& now);
  /// The owner has rejected an edit.
  void rejected(const OperationId& op) { forwarded_.erase(op); }
  /// The connection with the owner has ended.
  void disconnected();
  /// Reports the end of a session to the owner, if it knows of the session. Returns false if the
  /// owner takes nothing.
  [[nodiscard]] bool forget(const Session& session);
  /// Returns the players who wait for an owner, and forgets them here, because this server has
  /// become the owner.
  std::vector<std::pair<Session*, JoinCredentials>> take_joining();

 private:
  bool send_session(const Session& session);
  PassedOn pass_on(const Session& session, const Message& message);

  Sessions& sessions_;
  Order& order_;
  OwnerLink& link_;
  Joining& joining_;
  EditRequests& edits_;
  Presence& presence_;
  std::set<SessionId> known_;  // sessions of which the owner knows
  std::map<SessionId, JoinCredentials>
      joins_;  // authenticated, until the owner has let the player in
  // Edits of players here that the owner got, until it answers: when they came (steady clock).
  std::map<OperationId, TimeUs> forwarded_;
};

}  // namespace runstone
