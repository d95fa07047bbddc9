#include "server/world/people/joining.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "protocol/codec/key_fingerprint.hpp"

namespace runstone {
namespace {

/// Returns true if Hello::encodings has this encoding.
bool offers(std::uint8_t encodings, ChunkEncoding encoding) {
  return (encodings >> (static_cast<unsigned>(encoding) - 1) & 1U) != 0;
}

ChunkEncoding choose_encoding(const WorldConfig& config, std::uint8_t offered) {
  if (offers(offered, config.preferred_encoding)) return config.preferred_encoding;
  for (const ChunkEncoding e : {ChunkEncoding::packed, ChunkEncoding::raw}) {
    if (offers(offered, e)) return e;
  }
  return ChunkEncoding::coded;
}

/// Tiles are `coded` where chunks are `packed`, if the client reads that: it takes fewer bytes and
/// more time to read. A player waits for chunks near the eye, and less for far ground.
ChunkEncoding choose_tile_encoding(ChunkEncoding of_chunks, std::uint8_t offered) {
  const bool is_coded = of_chunks == ChunkEncoding::packed && offers(offered, ChunkEncoding::coded);
  return is_coded ? ChunkEncoding::coded : of_chunks;
}

/// The number of seats that a range of addresses, for example of a household, has at least. It does
/// not hold for the last seats (LastSeats).
constexpr std::uint64_t kSeatsOfRangeMin = 8;

/// Returns how many seats the addresses of one range may take while sessions from elsewhere take
/// `elsewhere`: a share of those that the others leave.
std::uint64_t seats_of_range(const WorldConfig& config, std::size_t elsewhere) {
  const std::uint64_t left = config.sessions_max - std::min(elsewhere, config.sessions_max);
  return std::max(kSeatsOfRangeMin, (left * config.range_seats_percent + 99) / 100);
}

/// The last seats of a server. If each range may take half of the free seats, a few ranges take nearly
/// all of them. Therefore the last eighth of the seats is for ranges without a session. Half of this
/// eighth is for wide networks without a session, because the ranges of one provider cost little.
/// Example: of 256 seats, three ranges take 224, then 16 further ranges take one each, then 16 further
/// networks take one each.
struct LastSeats {
  std::uint64_t for_new_ranges = 0, for_new_networks = 0;
};

/// A host who gives a range more than seven eighths of the seats keeps fewer.
LastSeats last_seats_of(const WorldConfig& config) {
  const std::uint64_t percent_left = 100 - config.range_seats_percent;
  const std::uint64_t kept =
      std::min(config.sessions_max / 8, config.sessions_max * percent_left / 100);
  return {kept, kept / 2};
}

/// The open sessions from the surroundings of an address.
struct NearSessions {
  std::size_t of_range = 0, of_network = 0;
};

/// Returns why an address may not take one more of the seats, of which `all` are taken, or an empty
/// string.
std::string no_seat_for_range(const WorldConfig& config, std::size_t all,
                              const NearSessions& near) {
  constexpr const char* kWayOn =
      " (range_seats_percent): come back later, or ask the server's host";
  const std::uint64_t free = config.sessions_max - std::min(all, config.sessions_max);
  const LastSeats last = last_seats_of(config);
  const auto kept = [](std::uint64_t seats, const std::string& whom) {
    return "the last " + std::to_string(seats) + " seats are for " + whom + " without a session" +
           kWayOn;
  };
  if (near.of_network > 0 && free <= last.for_new_networks)
    return kept(last.for_new_networks, "networks (/16 of IPv4, /32 of IPv6)");
  if (near.of_range > 0 && free <= last.for_new_ranges)
    return kept(last.for_new_ranges, "ranges of addresses (/24 of IPv4, /48 of IPv6)");
  const std::uint64_t range_max = seats_of_range(config, all - near.of_range);
  if (near.of_range < range_max) return "";
  return "while few seats are free, your range of addresses has " + std::to_string(range_max) +
         " sessions at most" + kWayOn;
}

}  // namespace

Joining::Joining(const World& world, RandomBytes random)
    : world_(world),
      random_(std::move(random)),
      credentials_(world.config, world.order, world.rights, world.changes) {}

Welcome Joining::welcome_of(const PublicKey& key) const {
  const WorldConfig& config = world_.config;
  Welcome welcome;
  welcome.world_id = config.world_id;
  welcome.epoch = world_.order.epoch();
  welcome.durable = world_.order.durable();
  welcome.head = world_.order.head();
  welcome.chunk_edge = config.chunk_edge;
  welcome.heights = config.heights;
  welcome.spawn = config.spawn;
  welcome.materials = world_.order.materials();
  welcome.server_key = config.server_keys.public_key;
  welcome.edit_volume_max = config.edit_volume_max;
  welcome.edit_budget = world_.quotas.edit_budget_of(key);
  welcome.view_radius_max = world_.quotas.view_radius_max_of(key);
  welcome.tile_levels_max = config.tile_levels_max;
  return welcome;
}

/// Returns why the server has no seat for the session, or an empty string. Only open sessions
/// count, so that sockets which never authenticate do not keep players out, and not the session
/// that this one replaces.
std::string Joining::no_seat(const Session& session) const {
  std::size_t all = 0, of_key = 0, of_address = 0;
  NearSessions near;
  for (const Session* other : world_.sessions.open()) {
    if (other->key == session.key && other->instance == session.instance) continue;
    ++all;
    if (other->key == session.key) ++of_key;
    if (other->address == session.address) ++of_address;
    if (address_range_of(other->address) == address_range_of(session.address)) ++near.of_range;
    if (wide_network_of(other->address) == wide_network_of(session.address)) ++near.of_network;
  }
  const WorldConfig& config = world_.config;
  const auto text = [](const char* who, std::size_t count) {
    return who + std::to_string(count) + " sessions at most";
  };
  if (all >= config.sessions_max) return text("the server holds ", config.sessions_max);
  if (config.sessions_per_key != 0 && of_key >= config.sessions_per_key)
    return text("a key has ", config.sessions_per_key);
  if (config.sessions_per_address != 0 && of_address >= config.sessions_per_address)
    return text("an address has ", config.sessions_per_address);
  // Without a limit for addresses the host does not count by networks.
  const bool counts_ranges =
      config.sessions_per_address != 0 && !is_of_local_network(session.address);
  return counts_ranges ? no_seat_for_range(config, all, near) : "";
}

bool Joining::close_if_no_seat(Session& session) {
  const std::string why = no_seat(session);
  if (why.empty()) return false;
  world_.sessions.close(session, GoodbyeReason::server_full, why);
  return true;
}

bool Joining::close_if_no_name(Session& session) {
  const auto why = world_.names.refusal(session);
  if (!why) return false;
  world_.sessions.close(session, GoodbyeReason::name_refused, *why);
  return true;
}

/// Closes a session from a banned address. A ban of the key is checked in close_if_not_admitted(), when
/// the client has proved the key.
bool Joining::close_if_address_banned(Session& session) {
  const auto why = world_.rights.address_refusal(session.key, session.address);
  if (!why) return false;
  world_.sessions.close(session, GoodbyeReason::not_admitted, *why);
  return true;
}

/// Closes a session whose player is banned or may not see the world. First it uses the invite or the
/// password, unless the player is banned or has a role.
bool Joining::close_if_not_admitted(Session& session, const JoinCredentials& brought,
                                    const Clocks& now) {
  auto why = world_.rights.ban_refusal(session.key, session.address);
  Result<void, std::string> accepted;
  if (!why) {
    accepted = credentials_.accept(session, brought, now);
    if (session.is_closed) return true;  // the new role closed it
    why = world_.rights.join_refusal(session.key, session.address);
  }
  if (!why) {
    if (!accepted) {
      world_.rights.note_refusal(session.key, "role: " + accepted.error(), now.utc_us);
      handshakes_[session.id].no_role = accepted.error();
    }
    return false;
  }
  if (!accepted) *why += " (" + accepted.error() + ")";
  world_.rights.note_refusal(session.key, kRefusedJoin + *why, now.utc_us);
  world_.sessions.close(session, GoodbyeReason::not_admitted, *why);
  return true;
}

/// Closes a session that has proved its key already.
bool Joining::close_if_authenticated(Session& session) {
  if (!session.is_authenticated) return false;
  world_.sessions.close(session, GoodbyeReason::unexpected_message, "client auth came twice");
  return true;
}

bool Joining::close_if_forged(Session& session, const Signature& signature) {
  if (verify(session.key, handshakes_[session.id].transcript, signature)) return false;
  world_.sessions.close(session, GoodbyeReason::not_authenticated,
                        "the signature does not match the key");
  return true;
}

void Joining::note_place_of(const PublicKey& key) {
  for (const Session* other : std::as_const(world_.sessions).open()) {
    if (other->key == key && other->has(kFeatureVisits)) world_.places.note(key, other->pose);
  }
}

/// Returns the other open session of the session's client, of which there is one at most, or null.
Session* Joining::other_session_of(const Session& session) {
  for (Session* other : world_.sessions.open()) {
    if (other != &session && other->key == session.key && other->instance == session.instance)
      return other;
  }
  return nullptr;
}

bool Joining::is_server(const Session& session) const {
  return session.key == world_.config.server_keys.public_key && session.has(kFeatureServers);
}

bool Joining::close_if_old_server(Session& session) {
  if (!is_server(session)) return false;
  const char* why = nullptr;
  if (!session.has(kFeatureTimeCorrections) && world_.rights.state().is_time_corrected())
    why = "the time of this world was corrected: start a version that can read this";
  if (!session.has(kFeatureLibrary) && world_.order.library().has_changed_ever())
    why = "this world has a library of builds: start a version that can read this";
  if (!session.has(kFeatureShapeRecords) && world_.order.has_shapes())
    why = "this world has materials with shapes: start a version that can read this";
  if (!session.has(kFeatureTextureRecords) && !world_.order.textures().table().empty())
    why = "this world has textures: start a version that can read this";
  if (!session.has(kFeatureClockRecords) && world_.order.clock().is_set())
    why = "the clock of this world was set: start a version that can read this";
  if (!session.has(kFeatureTimedGrants) && world_.rights.state().has_timed_grants_ever())
    why = "this world has roles for some time: start a version that can read this";
  if (why == nullptr) return false;
  world_.sessions.close(session, GoodbyeReason::wrong_protocol, why);
  return true;
}

/// Makes the session one of the world, under this author number. `is_listed`: this server makes the
/// list of players.
void Joining::enter(Session& session, AuthorId author, bool is_listed, const Clocks& now) {
  world_.sessions.enter(session, author, now.steady_us);
  world_.ground.add(session);
  world_.presence.enter(session, is_listed);
}

/// Sends session accepted and, unless another server does it, what the player has to know at first.
/// `place`: where the player begins, if that is not the spawn. Returns false if the session is
/// closed.
bool Joining::send_accepted(Session& session, ClientSequence resolved,
                            const std::optional<Pose>& place, const Clocks& now) {
  session.tile_rules = session.has(kFeatureTiles) ? world_.order.tile_rules() : 0;
  if (!world_.sessions.send_or_close(
          session, SessionAccepted{session.author, resolved, session.tile_rules, place}))
    return false;
  if (session.is_relayed) return true;
  world_.receipts.send_epoch(session);      // if it began since Welcome
  world_.receipts.send_materials(session);  // those that were added since Welcome
  if (session.is_closed) return false;
  world_.ground.send_permissions(session);
  world_.receipts.send_time(session, now);
  return !session.is_closed;
}

void Joining::open(Session& session, const Clocks& now) {
  // Its player joined at another server, and has been there since before this server owned the
  // world, or since before the connection with that server broke.
  const bool goes_on = session.author != 0;
  // Before an older session of the player is closed: its place is where this one begins.
  note_place_of(session.key);
  if (Session* const other = other_session_of(session))
    world_.sessions.close(*other, GoodbyeReason::already_connected,
                          "the same client connected again");
  if (close_if_no_seat(session)) return;
  std::optional<Pose> place;
  if (!goes_on && session.has(kFeatureVisits)) place = world_.places.find(session.key);
  if (!goes_on) session.pose = place.value_or(Pose{world_.config.spawn});
  Players& players = world_.order.players();
  enter(session, players.enter(session.key, session.name), true, now);
  if (players.is_renamed(session.author) && world_.order.log_has_room())
    world_.order.append_players({*players.take_unsaved(session.author)});
  const ClientSequence resolved = world_.order.resolved(session.author, session.instance);
  const bool is_open = send_accepted(session, resolved, place, now);
  world_.visits.joined(session, goes_on, now);
  world_.addresses.note(session.key, session.address,
                        [&](const PublicKey& key) { return players.author_of(key).has_value(); });
  if (!is_open || goes_on) return;
  world_.presence.send_all_poses_to(session);
  world_.chat.send_recent(session, now);
  // A player who is let in without the invite must not believe that it has worked.
  const std::string no_role = std::exchange(handshakes_[session.id].no_role, {});
  if (!no_role.empty()) world_.chat.tell(session, "you were given no role: " + no_role, now);
}

void Joining::set_authenticated(Session& session) {
  handshakes_[session.id].transcript = {};
  session.is_authenticated = true;
  // Connections without a key no longer replace it.
  if (!session.is_relayed) world_.environment.opened(session.id);
}

void Joining::let_in(Session& session, const JoinCredentials& brought, const Clocks& now) {
  if (!world_.environment.owns_world())
    return world_.sessions.close(session, GoodbyeReason::closing, kConnectAgain);
  // The name may have been claimed since hello. A session without a seat claims nothing.
  if (close_if_no_seat(session) || close_if_no_name(session) ||
      close_if_not_admitted(session, brought, now))
    return;
  set_authenticated(session);
  world_.names.claim(session, now.steady_us);
  if (!world_.names.is_claim_unwritten(session)) open(session, now);
}

void Joining::on_hello(Session& session, const Hello& hello) {
  if (hello.protocol != kProtocolVersion) {
    return world_.sessions.close(session, GoodbyeReason::wrong_protocol,
                                 "client speaks protocol " + std::to_string(hello.protocol) +
                                     ", server " + std::to_string(kProtocolVersion));
  }
  const WorldConfig& config = world_.config;
  session.key = hello.key;
  session.instance = hello.instance;
  session.name = hello.name;
  session.features = (offered_features() | kFeaturesOfServers) & hello.features;
  if (!is_server(session)) session.features &= ~kFeaturesOfServers;
  // Before any signature: a banned address costs little.
  if (close_if_address_banned(session)) return;
  if (!is_server(session)) {
    if (close_if_no_seat(session) || close_if_no_name(session)) return;
  } else if (world_.order.is_following()) {
    return world_.sessions.close(session, GoodbyeReason::closing,
                                 "this server does not own the world");
  } else if (close_if_old_server(session)) {
    return;
  }
  Welcome welcome = welcome_of(session.key);
  welcome.encoding = choose_encoding(config, hello.encodings);
  welcome.features = session.features;
  if (session.has(kFeatureLargeActions)) {
    welcome.waiting_edits_max = kWaitingEditsMax;
    welcome.waiting_edit_bytes_max = kWaitingEditBytesMax;
  }
  // A client sends what it makes of the password on encrypted connections only.
  const std::optional<JoinPassword>& password = world_.rights.state().password().value;
  if (password && session.binding) welcome.password_salt = password->salt;
  random_(welcome.challenge);
  welcome.signature = sign(config.server_keys, server_transcript(hello, welcome, session.binding));
  handshakes_[session.id].transcript = client_transcript(hello, welcome, session.binding);
  world_.receipts.welcomed(session, welcome);
  session.stage = SessionStage::authenticating;
  world_.environment.set_encodings(
      session.id, {welcome.encoding, choose_tile_encoding(welcome.encoding, hello.encodings)});
  world_.environment.set_features(session.id, welcome.features);
  world_.sessions.send_or_close(session, welcome);
}

bool Joining::proves_key(Session& session, const ClientAuth& auth) {
  return !close_if_authenticated(session) && !close_if_forged(session, auth.signature);
}

void Joining::join_relayed(Session& session, const RelayOpen& open_, const Clocks& now) {
  session.address = AddressBlock{open_.address};
  if (open_.is_encrypted) session.binding.emplace();
  session.key = open_.key;
  session.instance = open_.instance;
  session.name = open_.name;
  session.features = world_.config.features & open_.features;
  session.stage = SessionStage::authenticating;
  if (open_.author == 0) return let_in(session, {open_.ticket, open_.password_key}, now);
  if (!world_.environment.owns_world() ||
      !world_.order.players().adopt({open_.author, open_.key, open_.name}))
    return world_.sessions.close(session, GoodbyeReason::closing, kConnectAgain);
  if (close_if_not_admitted(session, {}, now)) return;
  if (other_session_of(session) != nullptr)
    return world_.sessions.close(session, GoodbyeReason::already_connected,
                                 "the same client connected again");
  session.is_authenticated = true;
  session.author = open_.author;
  session.pose = open_.pose;
  open(session, now);
}

void Joining::open_let_in(Session& session, const SessionAccepted& accepted, const Clocks& now) {
  session.awaits_owner = false;
  if (!world_.order.players().adopt({accepted.author, session.key, session.name}))
    return world_.sessions.close(session, GoodbyeReason::closing, kConnectAgain);
  const auto place = session.has(kFeatureVisits) ? accepted.place : std::nullopt;
  session.pose = place.value_or(Pose{world_.config.spawn});
  enter(session, accepted.author, false, now);
  send_accepted(session, accepted.resolved, place, now);
}

void Joining::open_authenticated(const Clocks& now) {
  if (world_.order.is_following()) return;  // the owner of the world lets players in
  std::vector<Session*> ready;
  for (Session* session : world_.sessions.all()) {
    if (session->stage == SessionStage::authenticating && session->is_authenticated &&
        !world_.names.is_claim_unwritten(*session))
      ready.push_back(session);
  }
  for (Session* session : ready) {
    if (!session->is_closed) open(*session, now);
  }
}

void Joining::on_key_request(Session& session, const KeyRequest& request, const Clocks& now) {
  if (close_if_authenticated(session)) return;
  auto sealed = credentials_.take_key(session, request.slot, now);
  if (!sealed) return world_.sessions.close(session, sealed.error().reason, sealed.error().text);
  if (world_.sessions.send_or_close(session, SealedKey{*std::move(sealed)}))
    world_.sessions.close(session, GoodbyeReason::closing, "the key was sent");
}

void Joining::on_key_deposit(Session& session, const KeyDeposit& deposit, const Clocks& now) {
  if (close_if_authenticated(session) || close_if_forged(session, deposit.signature) ||
      close_if_not_admitted(session, {}, now))
    return;
  const auto kept = credentials_.leave_key(session, deposit, now);
  constexpr auto kSeconds = static_cast<std::uint32_t>(kDepositUs / 1'000'000);
  const KeyDeposited answer = kept ? KeyDeposited{kSeconds, ""} : KeyDeposited{0, kept.error()};
  if (world_.sessions.send_or_close(session, answer))
    world_.sessions.close(session, GoodbyeReason::closing, "that is all");
}

}  // namespace runstone
