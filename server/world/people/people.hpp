// People: the players: how they join, under which names, who is here, what they write, and what
// they ask for. Its parts stand in files of their own.
// Thread: the world strand.
#pragma once
#include <string>
#include <vector>

#include "server/world/people/commands.hpp"
#include "server/world/people/edit_requests.hpp"
#include "server/world/people/joining.hpp"
#include "server/world/people/previews.hpp"

namespace runstone {

struct OnlinePlayer {
  SessionId session = 0;
  AuthorId author = 0;
  std::string name;
  PublicKey key{};
  WorldPos at;
  AddressBlock from{};  // of the session
};

class People {
 public:
  /// The parts of the world that people use. All must outlive the object.
  struct World {
    const WorldConfig& config;
    WorldEnvironment& environment;
    WorldCounters& counters;
    Sessions& sessions;
    Order& order;
    Receipts& receipts;
    Rights& rights;
    Quotas& quotas;
    Ground& ground;
    Changes& changes;
  };
  People(const World& world, const WorldStart& start, const RandomBytes& random);

  Joining& joining() { return joining_; }
  Names& names() { return names_; }
  Presence& presence() { return presence_; }
  ChatRoom& chat() { return chat_; }
  Commands& commands() { return commands_; }
  const Commands& commands() const { return commands_; }
  Previews& previews() { return previews_; }
  Visits& visits() { return visits_; }
  PlayerPlaces& places() { return places_; }
  const PlayerAddresses& addresses() const { return addresses_; }
  EditRequests& edits() { return edits_; }

  /// Returns the players with open sessions, ordered by session.
  std::vector<OnlinePlayer> online() const;
  /// Closes the sessions of a key, or of a range of addresses. Returns their number.
  std::size_t kick(const RestrictionSubject& who, const std::string& reason);
  /// Returns a random number for a new invite.
  InviteId new_invite_id();
  /// Returns the link with which players accept an invite.
  std::string invite_link(InviteId invite) const;
  /// Tells players and the operator that grants have ended.
  void grants_ended(const std::vector<GrantRole>& grants, const Clocks& now);
  /// Notes the places of the players with open sessions.
  void note_places();
  /// Closes the sessions that have sent nothing for too long.
  void close_silent(const Clocks& now);
  /// Removes authors without a row and without a session from players and watermarks.
  void forget_gone_authors();
  void forget(const Session& session);

 private:
  World world_;
  RandomBytes random_;
  Names names_;
  Presence presence_;
  ChatRoom chat_;
  Visits visits_;
  PlayerPlaces places_;
  PlayerAddresses addresses_;
  Commands commands_;
  Previews previews_;
  EditRequests edits_;
  Joining joining_;
};

}  // namespace runstone
