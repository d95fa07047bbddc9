#include "server/world/handshake_handlers.hpp"

#include <string>
#include <utility>
#include <vector>

#include "protocol/codec/key_fingerprint.hpp"
#include "server/world/chat_handlers.hpp"
#include "server/world/followers.hpp"
#include "server/world/following.hpp"
#include "server/world/material_handlers.hpp"
#include "server/world/name_rules.hpp"
#include "server/world/presence.hpp"
#include "server/world/protected_ground.hpp"
#include "server/world/quotas.hpp"
#include "server/world/rights_handlers.hpp"

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

/// Tiles are `coded` where chunks are `packed`, if the client reads that: it takes fewer bytes and more
/// time to read. A player waits for chunks near the eye, and less for far ground.
ChunkEncoding choose_tile_encoding(ChunkEncoding of_chunks, std::uint8_t offered) {
  const bool is_coded = of_chunks == ChunkEncoding::packed && offers(offered, ChunkEncoding::coded);
  return is_coded ? ChunkEncoding::coded : of_chunks;
}

Welcome welcome_of(const WorldState& world, const PublicKey& key) {
  const WorldConfig& config = world.config;
  Welcome welcome;
  welcome.world_id = config.world_id;
  welcome.epoch = world.authority.epoch();
  welcome.durable = world.durable;
  welcome.head = world.authority.head();
  welcome.chunk_edge = config.chunk_edge;
  welcome.heights = config.heights;
  welcome.spawn = config.spawn;
  welcome.materials = config.materials;
  welcome.server_key = config.server_keys.public_key;
  welcome.edit_volume_max = config.edit_volume_max;
  welcome.edit_budget = edit_budget_of(world, key);
  welcome.view_radius_max = view_radius_max_of(world, key);
  welcome.tile_levels_max = config.tile_levels_max;
  return welcome;
}

/// Returns why the server has no seat for the session, or an empty string. Only open sessions
/// count, so that sockets which never authenticate do not keep players out, and not the session
/// that this one replaces.
std::string no_seat(const WorldState& world, const WorldSession& mine) {
  std::size_t all = 0, of_key = 0, of_address = 0;
  for (const auto& [id, theirs] : world.sessions) {
    const bool is_replaced = theirs.key == mine.key && theirs.instance == mine.instance;
    if (theirs.state != SessionStage::open || is_replaced) continue;
    ++all;
    if (theirs.key == mine.key) ++of_key;
    if (theirs.address == mine.address) ++of_address;
  }
  const WorldConfig& config = world.config;
  const auto text = [](const char* who, std::size_t count) {
    return who + std::to_string(count) + " sessions at most";
  };
  if (all >= config.sessions_max) return text("the server holds ", config.sessions_max);
  if (config.sessions_per_key != 0 && of_key >= config.sessions_per_key)
    return text("a key has ", config.sessions_per_key);
  if (config.sessions_per_address != 0 && of_address >= config.sessions_per_address)
    return text("an address has ", config.sessions_per_address);
  return "";
}

bool close_if_no_seat(WorldState& world, SessionId session) {
  const std::string why = no_seat(world, *world.find(session));
  if (why.empty()) return false;
  close_session(world, session, GoodbyeReason::server_full, why);
  return true;
}

bool close_if_no_name(WorldState& world, SessionId session) {
  const auto why = name_refusal(world, *world.find(session));
  if (!why) return false;
  close_session(world, session, GoodbyeReason::name_refused, *why);
  return true;
}

/// Closes a session from a banned address. A ban of its key is told later, to the owner of the key.
bool close_if_banned(WorldState& world, SessionId session) {
  const WorldSession& mine = *world.find(session);
  const auto why = address_refusal(world, mine.key, mine.address);
  if (!why) return false;
  close_session(world, session, GoodbyeReason::not_admitted, *why);
  return true;
}

/// Gives a player without a granted role the role of an invite or, if there is none, of the password.
/// Returns why nothing was granted, or nullopt. The session may be closed on return.
std::optional<std::string> accept_credentials(WorldState& world, SessionId session,
                                              const ClientAuth& auth, const Clocks& now) {
  if (world.rights.grants().contains(world.find(session)->key)) return std::nullopt;
  std::optional<std::string> no_invite;
  if (!auth.ticket.empty()) no_invite = accept_invite(world, session, auth.ticket, now);
  const bool is_decided = !auth.ticket.empty() && !no_invite;
  if (is_decided || !auth.password_key) return no_invite;
  const auto no_password = accept_password(world, session, *auth.password_key, now);
  if (!no_password || !no_invite) return no_password;
  if (no_invite->ends_with('.')) no_invite->pop_back();
  return *no_invite + "; " + *no_password;
}

/// Closes a session whose player may not see the world. An invite or a password is used only if that
/// helps: a player who has a role keeps it.
bool close_if_not_admitted(WorldState& world, SessionId session, const ClientAuth& auth,
                           const Clocks& now) {
  const PublicKey key = world.find(session)->key;
  const AddressBlock address = world.find(session)->address;
  const auto no_role = accept_credentials(world, session, auth, now);
  if (world.find(session) == nullptr) return true;  // the new role closed it
  auto why = join_refusal(world, key, address);
  if (!why) {
    if (no_role) {
      world.refusals.add(key, "role: " + *no_role, now.utc_us);
      world.find(session)->no_role = *no_role;
    }
    return false;
  }
  if (no_role) *why += " (" + *no_role + ")";
  world.refusals.add(key, kRefusedJoin + *why, now.utc_us);
  close_session(world, session, GoodbyeReason::not_admitted, *why);
  return true;
}

/// Closes a session that has proved its key already.
bool close_if_authenticated(WorldState& world, SessionId session) {
  if (!world.find(session)->is_authenticated) return false;
  close_session(world, session, GoodbyeReason::unexpected_message, "client auth came twice");
  return true;
}

/// Returns the other open session of the session's client, of which there is one at most.
std::optional<SessionId> other_session_of(const WorldState& world, SessionId session) {
  const WorldSession& mine = *world.find(session);
  for (const auto& [other, theirs] : world.sessions) {
    if (other == session || theirs.state != SessionStage::open) continue;
    if (theirs.key == mine.key && theirs.instance == mine.instance) return other;
  }
  return std::nullopt;
}

std::vector<SessionId> sessions_that_join(const WorldState& world) {
  std::vector<SessionId> joining;
  for (const auto& [id, session] : world.sessions) {
    if (session.join) joining.push_back(id);
  }
  return joining;
}

/// Closes a session that goes on if its client has connected again meanwhile.
bool close_if_replaced(WorldState& world, SessionId session) {
  if (!other_session_of(world, session)) return false;
  close_session(world, session, GoodbyeReason::already_connected,
                "the same client connected again");
  return true;
}

bool close_if_forged(WorldState& world, SessionId session, const Signature& signature) {
  const WorldSession& mine = *world.find(session);
  if (verify(mine.key, mine.auth_transcript, signature)) return false;
  close_session(world, session, GoodbyeReason::not_authenticated,
                "the signature does not match the key");
  return true;
}

/// Makes the session one of the world, under this author number.
void enter(WorldState& world, SessionId session, AuthorId author, const Clocks& now) {
  WorldSession& mine = *world.find(session);
  mine.state = SessionStage::open;
  mine.author = author;
  mine.pose_changed = true;
  mine.position.start(mine.pose.at, now.steady_us);
  mine.last_message_us = now.steady_us;
  if (!mine.is_relayed) world.clients[{mine.author, mine.instance}] = session;
  world.interest.open(session);
  ++world.counters.sessions_opened;
  world.environment.player_came(visit_of(world, session, mine));
}

/// Sends session accepted and, unless another server does it, what the player has to know at first.
/// Returns false if the session is closed.
bool send_accepted(WorldState& world, SessionId session, const SessionAccepted& accepted) {
  if (!send_or_close(world, session, accepted)) return false;
  if (world.find(session)->is_relayed) return true;
  send_epoch(world, session);  // if it began since Welcome
  if (world.find(session) == nullptr) return false;
  send_materials(world, session);  // those that were added since Welcome
  if (world.find(session) == nullptr) return false;
  start_ground(world, session);
  return true;
}

/// Returns true for another server of the world. Requires that the features are in force.
bool is_server(const WorldState& world, const WorldSession& mine) {
  return mine.key == world.config.server_keys.public_key && (mine.features & kFeatureServers) != 0;
}

void open_session(WorldState& world, SessionId session, const Clocks& now) {
  WorldSession& mine = *world.find(session);
  // Its player joined at another server, and has been there since before this server owned the world, or
  // since before the connection with that server broke.
  const bool goes_on = mine.author != 0;
  if (const auto other = other_session_of(world, session))
    close_session(world, *other, GoodbyeReason::already_connected,
                  "the same client connected again");
  if (close_if_no_seat(world, session)) return;
  if (!goes_on) mine.pose.at = world.config.spawn;
  enter(world, session, world.players.enter(mine.key, mine.name), now);
  if (world.players.is_renamed(mine.author) &&
      world.environment.log_has_room(world.authority.queue().size() + 1)) {
    append_players(world, {*world.players.take_unsaved(mine.author)});
  }
  world.player_list_changed = true;
  const bool has_tiles = (mine.features & kFeatureTiles) != 0;
  const SessionAccepted accepted{mine.author,
                                 world.authority.resolved().of(mine.author, mine.instance),
                                 has_tiles ? world.config.tile_rules : 0};
  if (!send_accepted(world, session, accepted) || goes_on) return;
  send_all_poses_to(world, session);
  send_recent_chat(world, session, now);
  // A player who is let in without the invite must not believe that it has worked.
  const std::string no_role = std::exchange(world.find(session)->no_role, {});
  if (!no_role.empty()) tell(world, session, "you were given no role: " + no_role, now);
}

/// Lets an authenticated player in, at once or when the claim of the name is on disk, or closes the
/// session.
void let_in(WorldState& world, SessionId session, const ClientAuth& auth, const Clocks& now) {
  if (!world.environment.owns_world())
    return close_session(world, session, GoodbyeReason::closing, kConnectAgain);
  // The name may have been claimed since hello. A session without a seat claims nothing.
  if (close_if_no_seat(world, session) || close_if_no_name(world, session) ||
      close_if_not_admitted(world, session, auth, now))
    return;
  WorldSession& mine = *world.find(session);
  mine.auth_transcript = {};
  mine.is_authenticated = true;
  // Connections without a key no longer replace it.
  if (!mine.is_relayed) world.environment.opened(session);
  claim_name(world, session, now.steady_us);
  if (!waits_for_claim(world, *world.find(session))) open_session(world, session, now);
}

}  // namespace

void on_hello(WorldState& world, SessionId session, const Hello& hello) {
  WorldSession& mine = *world.find(session);
  if (hello.protocol != kProtocolVersion) {
    close_session(world, session, GoodbyeReason::wrong_protocol,
                  "client speaks protocol " + std::to_string(hello.protocol) + ", server " +
                      std::to_string(kProtocolVersion));
    return;
  }
  mine.key = hello.key;
  mine.instance = hello.instance;
  mine.name = hello.name;
  mine.features = (world.config.features | kFeatureServers) & hello.features;
  if (!is_server(world, mine)) mine.features &= ~kFeatureServers;
  // Before any signature: a banned address costs little.
  if (close_if_banned(world, session)) return;
  if (!is_server(world, mine)) {
    if (close_if_no_seat(world, session) || close_if_no_name(world, session)) return;
  } else if (world.following) {
    return close_session(world, session, GoodbyeReason::closing,
                         "this server does not own the world");
  }
  Welcome welcome = welcome_of(world, mine.key);
  welcome.encoding = choose_encoding(world.config, hello.encodings);
  welcome.features = mine.features;
  mine.materials_known = welcome.materials.size();
  mine.epoch = welcome.epoch;
  // A client sends what it makes of the password on encrypted connections only.
  const std::optional<JoinPassword>& password = world.rights.password().value;
  if (password && mine.binding) welcome.password_salt = password->salt;
  world.random(welcome.challenge);
  welcome.signature =
      sign(world.config.server_keys, server_transcript(hello, welcome, mine.binding));
  mine.auth_transcript = client_transcript(hello, welcome, mine.binding);
  mine.durable_sent = welcome.durable;
  mine.state = SessionStage::authenticating;
  world.environment.set_encodings(
      session, {welcome.encoding, choose_tile_encoding(welcome.encoding, hello.encodings)});
  world.environment.set_features(session, welcome.features);
  send_or_close(world, session, welcome);
}

void on_client_auth(WorldState& world, SessionId session, const ClientAuth& auth,
                    const Clocks& now) {
  if (close_if_authenticated(world, session) || close_if_forged(world, session, auth.signature))
    return;
  WorldSession& mine = *world.find(session);
  if (is_server(world, mine)) return admit_follower(world, session, now);
  if (world.following) return join_at_owner(world, session, auth);
  let_in(world, session, auth, now);
}

void join_relayed(WorldState& world, SessionId session, const RelayOpen& open, const Clocks& now) {
  WorldSession& mine = *world.find(session);
  mine.address = AddressBlock{open.address};
  if (open.is_encrypted) mine.binding.emplace();
  mine.key = open.key;
  mine.instance = open.instance;
  mine.name = open.name;
  mine.features = world.config.features & open.features;
  mine.state = SessionStage::authenticating;
  if (open.author == 0) return let_in(world, session, {{}, open.ticket, open.password_key}, now);
  if (!world.environment.owns_world() || !world.players.adopt({open.author, open.key, open.name}))
    return close_session(world, session, GoodbyeReason::closing, kConnectAgain);
  if (close_if_not_admitted(world, session, {}, now) || close_if_replaced(world, session)) return;
  mine.is_authenticated = true;
  mine.author = open.author;
  mine.pose = open.pose;
  open_session(world, session, now);
}

void open_let_in(WorldState& world, SessionId session, const SessionAccepted& accepted,
                 const Clocks& now) {
  WorldSession& mine = *world.find(session);
  mine.join.reset();
  if (!world.players.adopt({accepted.author, mine.key, mine.name}))
    return close_session(world, session, GoodbyeReason::closing, kConnectAgain);
  mine.pose.at = world.config.spawn;
  enter(world, session, accepted.author, now);
  const bool has_tiles = (mine.features & kFeatureTiles) != 0;
  send_accepted(world, session,
                {accepted.author, accepted.resolved, has_tiles ? world.config.tile_rules : 0});
}

void let_waiting_in(WorldState& world, const Clocks& now) {
  for (const SessionId session : sessions_that_join(world)) {
    if (WorldSession* mine = world.find(session))
      let_in(world, session, *std::exchange(mine->join, std::nullopt), now);
  }
}

void on_key_request(WorldState& world, SessionId session, const KeyRequest& request,
                    const Clocks& now) {
  if (close_if_authenticated(world, session)) return;
  const AddressBlock address = world.find(session)->address;
  if (!world.guess_ledger.has(address, kGuessPrice, now.steady_us))
    return close_session(world, session, GoodbyeReason::flooding, kTooManyGuesses);
  auto sealed = world.key_deposits.take(request.slot, now.steady_us);
  if (!sealed) {
    world.guess_ledger.take(address, kGuessPrice, now.steady_us);
    return close_session(world, session, GoodbyeReason::not_admitted,
                         "no key is here for this code: it was mistyped, used before, or too old");
  }
  if (send_or_close(world, session, SealedKey{*std::move(sealed)}))
    close_session(world, session, GoodbyeReason::closing, "the key was sent");
}

void on_key_deposit(WorldState& world, SessionId session, const KeyDeposit& deposit,
                    const Clocks& now) {
  if (close_if_authenticated(world, session) ||
      close_if_forged(world, session, deposit.signature) ||
      close_if_not_admitted(world, session, {}, now))
    return;
  const WorldSession& mine = *world.find(session);
  std::optional<std::string> why;
  if (!world.deposit_ledger.take(mine.address, kGuessPrice, now.steady_us)) {
    why = "too many keys were left from your network: wait a minute";
  } else {
    why = world.key_deposits.put(mine.key, mine.address, deposit, now.steady_us);
  }
  if (why) world.refusals.add(mine.key, "key for another device: " + *why, now.utc_us);
  constexpr auto kSeconds = static_cast<std::uint32_t>(kDepositUs / 1'000'000);
  const KeyDeposited answer{why ? 0 : kSeconds, why.value_or("")};
  if (send_or_close(world, session, answer))
    close_session(world, session, GoodbyeReason::closing, "that is all");
}

void open_authenticated(WorldState& world, const Clocks& now) {
  if (world.following) return;  // the owner of the world lets players in
  std::vector<SessionId> ready;
  for (const auto& [id, session] : world.sessions) {
    if (session.state == SessionStage::authenticating && session.is_authenticated &&
        !waits_for_claim(world, session))
      ready.push_back(id);
  }
  for (const SessionId id : ready) {
    if (world.find(id) != nullptr) open_session(world, id, now);
  }
}

}  // namespace runstone
