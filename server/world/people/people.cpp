#include "server/world/people/people.hpp"

#include <array>
#include <set>
#include <utility>
#include <variant>

#include "protocol/codec/invite_token.hpp"
#include "protocol/codec/key_fingerprint.hpp"
#include "protocol/codec/server_link.hpp"

namespace runstone {

People::People(const World& world, const WorldStart& start, const RandomBytes& random)
    : world_(world),
      random_(random),
      names_(world.config, world.environment, world.order, world.rights),
      presence_(world.config, world.sessions, world.order, world.rights),
      chat_(world.config, start, world.environment, world.sessions, world.order, world.rights),
      visits_(world.sessions, chat_),
      places_(start.saved.places),
      commands_(world.environment, world.sessions, world.ground),
      previews_(world.config, world.sessions, world.order, world.receipts, world.ground),
      edits_(world.config, world.environment, world.counters, world.sessions, world.order,
             world.receipts, world.rights, world.quotas),
      joining_({world.config, world.environment, world.sessions, world.order, world.receipts,
                world.rights, world.quotas, world.ground, world.changes, names_, presence_, chat_,
                visits_, places_, addresses_},
               random) {}

std::vector<OnlinePlayer> People::online() const {
  std::vector<OnlinePlayer> out;
  for (const Session* session : std::as_const(world_.sessions).open())
    out.push_back({session->id, session->author, session->name, session->key, session->pose.at,
                   session->address});
  return out;
}

InviteId People::new_invite_id() {
  std::array<std::uint8_t, sizeof(InviteId)> bytes{};
  random_(bytes);
  return ByteReader(bytes).u64();
}

std::string People::invite_link(InviteId invite) const {
  const WorldConfig& config = world_.config;
  const std::string token = invite_token(invite, config.world_id, config.server_keys);
  return text_of(ServerLink{config.link_address, token});
}

std::size_t People::kick(const RestrictionSubject& who, const std::string& reason) {
  const std::string text = reason.empty() ? "you were kicked" : "you were kicked: " + reason;
  std::size_t kicked = 0;
  for (Session* session : world_.sessions.open()) {
    const auto* key = std::get_if<PublicKey>(&who);
    const bool is_meant = key != nullptr ? session->key == *key
                                         : std::get<AddressRange>(who).contains(session->address);
    if (!is_meant) continue;
    world_.sessions.close(*session, GoodbyeReason::not_admitted, text);
    ++kicked;
  }
  return kicked;
}

void People::grants_ended(const std::vector<GrantRole>& grants, const Clocks& now) {
  for (const GrantRole& grant : grants) {
    const std::string& role = world_.rights.state().role_of(grant.key).name;
    chat_.tell_those([&](const PublicKey& player) { return player == grant.key; },
                     "your role " + grant.role + " has ended: your role is " + role + " now", now);
    world_.environment.report(OperatorLogLevel::info,
                              "the role " + grant.role + " of " + key_fingerprint(grant.key) +
                                  " has ended: its role is " + role + " now");
  }
}

void People::note_places() {
  for (const Session* session : world_.sessions.open()) {
    if (session->has(kFeatureVisits)) places_.note(session->key, session->pose);
  }
}

void People::close_silent(const Clocks& now) {
  for (Session* session : world_.sessions.all()) {
    if (session->is_relayed) continue;  // the server that it is connected to closes it
    const bool is_open = session->is_open();
    const TimeUs since = is_open ? session->last_message_us : session->connected_us;
    const TimeUs limit = is_open ? world_.config.idle_us_max : world_.config.handshake_us_max;
    if (now.steady_us - since < limit) continue;
    world_.sessions.close(*session, GoodbyeReason::timed_out,
                          is_open ? "no message for too long" : "the handshake took too long");
  }
}

void People::forget_gone_authors() {
  if (!world_.order.has_gone_authors()) return;
  std::set<AuthorId> present;
  for (const Session* session : world_.sessions.open()) present.insert(session->author);
  world_.order.forget_gone_authors(present);
}

void People::forget(const Session& session) {
  if (session.stage == SessionStage::open) {
    world_.order.author_left(session.author);
    visits_.left(session);
    // Another session of the player, which goes on, has the newer place.
    if (session.has(kFeatureVisits) && !visits_.is_here(session.key))
      places_.note(session.key, session.pose);
  }
  presence_.forget(session);
  chat_.forget(session.id);
  commands_.forget(session.id);
  previews_.forget(session.id);
  edits_.forget(session.id);
  joining_.forget(session.id);
}

}  // namespace runstone
