#include "server/world/handshake_handlers.hpp"

#include <algorithm>
#include <string>

#include "server/world/presence.hpp"

namespace runstone {
namespace {

ChunkEncoding choose_encoding(const WorldConfig& config, std::uint8_t offered) {
  const auto offers = [&](ChunkEncoding e) {
    return (offered >> (static_cast<unsigned>(e) - 1) & 1U) != 0;
  };
  if (offers(config.preferred_encoding)) return config.preferred_encoding;
  for (const ChunkEncoding e : {ChunkEncoding::packed, ChunkEncoding::raw}) {
    if (offers(e)) return e;
  }
  return ChunkEncoding::coded;
}

Welcome welcome_of(const WorldState& world) {
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
  welcome.view_radius_max = config.view_radius_max;
  return welcome;
}

/// Closes the session if the server is full. Only open sessions count, so that sockets which never
/// authenticate do not keep players out.
bool close_if_full(WorldState& world, SessionId session) {
  const auto open = static_cast<std::size_t>(
      std::count_if(world.sessions.begin(), world.sessions.end(),
                    [](const auto& s) { return s.second.state == SessionStage::open; }));
  if (open < world.config.sessions_max) return false;
  close_session(
      world, session, GoodbyeReason::server_full,
      "the server holds " + std::to_string(world.config.sessions_max) + " sessions at most");
  return true;
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
  if (close_if_full(world, session)) return;
  Welcome welcome = welcome_of(world);
  welcome.encoding = choose_encoding(world.config, hello.encodings);
  welcome.features = world.config.features & hello.features;
  world.random(welcome.challenge);
  welcome.signature = sign(world.config.server_keys, server_transcript(hello, welcome));
  mine.key = hello.key;
  mine.instance = hello.instance;
  mine.name = hello.name;
  mine.auth_transcript = client_transcript(hello, welcome);
  mine.durable_sent = welcome.durable;
  mine.state = SessionStage::authenticating;
  mine.features = welcome.features;
  world.environment.set_encoding(session, welcome.encoding);
  world.environment.set_features(session, welcome.features);
  send_or_close(world, session, welcome);
}

void on_client_auth(WorldState& world, SessionId session, const ClientAuth& auth,
                    const Clocks& now) {
  WorldSession& mine = *world.find(session);
  if (!verify(mine.key, mine.auth_transcript, auth.signature)) {
    close_session(world, session, GoodbyeReason::not_authenticated,
                  "the signature does not match the key");
    return;
  }
  for (const auto& [other, theirs] : world.sessions) {
    if (other == session || theirs.state != SessionStage::open) continue;
    if (theirs.key != mine.key || theirs.instance != mine.instance) continue;
    close_session(world, other, GoodbyeReason::already_connected,
                  "the same client connected again");
    break;  // there is at most one, and closing it invalidates the iterators
  }
  if (close_if_full(world, session)) return;
  mine.auth_transcript = {};
  mine.state = SessionStage::open;
  mine.author = world.players.enter(mine.key, mine.name);
  if (world.players.is_renamed(mine.author) &&
      world.environment.log_has_room(world.authority.queued() + 1)) {
    world.environment.log_append({*world.players.take_unsaved(mine.author)}, {});
  }
  mine.pose.at = world.config.spawn;
  mine.pose_changed = true;
  mine.edits = TokenBucket(world.config.edits_per_second, world.config.edit_burst);
  mine.last_message_us = now.steady_us;
  world.interest.open(session);
  world.environment.opened(session);
  ++world.counters.sessions_opened;
  world.environment.report(OperatorLogLevel::info,
                           "session=" + std::to_string(session) + " open author=" +
                               std::to_string(mine.author) + " name=\"" + mine.name + "\"");
  world.player_list_changed = true;
  const SessionAccepted accepted{mine.author,
                                 world.authority.resolved().of(mine.author, mine.instance)};
  if (send_or_close(world, session, accepted)) send_all_poses_to(world, session);
}

}  // namespace runstone
