// Joining: the handshake. Hello is answered with welcome, client auth with session accepted. The
// server sends nothing of the world before session accepted.
// Thread: the world strand.
#pragma once
#include <map>
#include <optional>
#include <string>

#include "server/limits/player_addresses.hpp"
#include "server/world/order/receipts.hpp"
#include "server/world/people/chat_room.hpp"
#include "server/world/people/credentials.hpp"
#include "server/world/people/names.hpp"
#include "server/world/people/player_places.hpp"
#include "server/world/people/presence.hpp"
#include "server/world/people/visits.hpp"

namespace runstone {

/// The parts of the protocol that a server does not offer while it follows: they need what only the
/// owner has in memory.
inline constexpr std::uint64_t kFeaturesOfOwner =
    kFeatureKeyTransfer | kFeatureRestorePreview | kFeaturePreviews | kFeatureStrokes;

class Joining {
 public:
  /// The parts of the world that joining uses. All must outlive the object.
  struct World {
    const WorldConfig& config;
    WorldEnvironment& environment;
    Sessions& sessions;
    Order& order;
    Receipts& receipts;
    Rights& rights;
    const Quotas& quotas;
    Ground& ground;
    Changes& changes;
    Names& names;
    Presence& presence;
    ChatRoom& chat;
    Visits& visits;
    PlayerPlaces& places;
    PlayerAddresses& addresses;
  };
  Joining(const World& world, RandomBytes random);

  /// Sends a signed welcome, or closes the session: wrong_protocol (the text names both versions)
  /// or server_full, name_refused or not_admitted.
  void on_hello(Session& session, const Hello& hello);
  /// Returns true if the client auth proves the session's key. Otherwise closes the session.
  bool proves_key(Session& session, const ClientAuth& auth);
  /// Returns true for another server of the world. Requires that the features are in force.
  bool is_server(const Session& session) const;
  /// Closes the session of another server that cannot read the log (wrong_protocol): it lacks the
  /// feature time corrections and the time of this world was corrected, or another feature of
  /// records that this world has. Returns true if it closed the session.
  bool close_if_old_server(Session& session);
  /// Lets an authenticated player in, at once or when the claim of the name is on disk, or closes
  /// the session: closing (another server may own the world), server_full, name_refused or
  /// not_admitted. Closes an older session of the key and client instance (already_connected). The
  /// signature shows that both are the same client, and the older connection is usually dead
  /// without a sign of it.
  void let_in(Session& session, const JoinCredentials& brought, const Clocks& now);
  /// Handles the session of a player at another server, which has authenticated the player: lets
  /// the player in, or closes the session. A session of a player whom an earlier owner let in goes
  /// on.
  void join_relayed(Session& session, const RelayOpen& open, const Clocks& now);
  /// Opens an authenticated session whose player the owner of the world has let in.
  void open_let_in(Session& session, const SessionAccepted& accepted, const Clocks& now);
  /// Opens the sessions that wait for nothing any more.
  void open_authenticated(const Clocks& now);
  /// Returns the optional parts of the protocol that this server offers now.
  std::uint64_t offered_features() const {
    return world_.order.is_following() ? world_.config.features & ~kFeaturesOfOwner
                                       : world_.config.features;
  }
  /// Notes that the key is proved, and the rest is decided elsewhere or later.
  void set_authenticated(Session& session);

  /// Sends the sealed key of a slot and removes it, or closes the session: not_admitted, or
  /// flooding after too many requests for empty slots. Whoever has the code may take the key, so
  /// the player needs no rights. The session ends in any case.
  void on_key_request(Session& session, const KeyRequest& request, const Clocks& now);
  /// Keeps a sealed key of a player who may join, or answers why not. The session ends in any case,
  /// and closes with not_authenticated or not_admitted if the player may not join.
  void on_key_deposit(Session& session, const KeyDeposit& deposit, const Clocks& now);
  void forget(SessionId session) { handshakes_.erase(session); }

 private:
  struct Handshake {
    Bytes transcript;     // the bytes that the client must sign; empty in other stages
    std::string no_role;  // why the player's invite or password gave no role, until it is told
  };
  Welcome welcome_of(const PublicKey& key) const;
  std::string no_seat(const Session& session) const;
  /// Notes where the open sessions of the player are.
  void note_place_of(const PublicKey& key);
  Session* other_session_of(const Session& session);
  // Each closes the session and returns true if the condition holds.
  bool close_if_no_seat(Session& session);
  bool close_if_no_name(Session& session);
  bool close_if_address_banned(Session& session);
  bool close_if_not_admitted(Session& session, const JoinCredentials& brought, const Clocks& now);
  bool close_if_authenticated(Session& session);
  bool close_if_forged(Session& session, const Signature& signature);

  void enter(Session& session, AuthorId author, bool is_listed, const Clocks& now);
  bool send_accepted(Session& session, ClientSequence resolved, const std::optional<Pose>& place,
                     const Clocks& now);
  void open(Session& session, const Clocks& now);

  World world_;
  RandomBytes random_;
  Credentials credentials_;
  std::map<SessionId, Handshake> handshakes_;  // of the sessions that have sent hello
};

}  // namespace runstone
