#include "server/world/rights_handlers.hpp"

#include <variant>
#include <vector>

#include "common/core/utc_text.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "protocol/codec/invite_token.hpp"
#include "protocol/codec/password_key.hpp"
#include "protocol/rules/refusal_text.hpp"
#include "server/world/broadcast.hpp"
#include "server/world/protected_ground.hpp"
#include "server/world/server_edits.hpp"

namespace runstone {
namespace {

bool is_operator(const WorldState& world, const PublicKey& key) {
  return world.config.operators.contains(key);
}

RightsDecision granted_by_settings() {
  RightsDecision out;
  out.is_allowed = true;
  return out;
}

constexpr const char* kMayNotEdit = "you may not edit";

/// Returns text such as "you are banned until 2026-12-01T00:00:00Z: griefing".
std::string restriction_text(const char* what, const Restrict& restriction) {
  std::string text = what;
  if (restriction.until_us != 0) text += " until " + utc_text(restriction.until_us);
  if (!restriction.reason.empty()) text += ": " + restriction.reason;
  return text;
}

std::string refusal_text(const WorldState& world, const PublicKey& key, const RightsDecision& no) {
  const auto restricted = [&](RestrictionKind kind, const char* what) {
    const auto* found = world.rights.restriction(kind, key, rights_time(world));
    return found == nullptr ? std::string(what) : restriction_text(what, found->value);
  };
  switch (no.reason) {
    case RightsDecision::Reason::ban:
      return restricted(RestrictionKind::ban, "you are banned");
    case RightsDecision::Reason::mute:
      return restricted(RestrictionKind::mute, "you are muted");
    case RightsDecision::Reason::freeze:
      return restricted(RestrictionKind::freeze, kMayNotEdit);
    case RightsDecision::Reason::box:
      return refused_by_box(no.box->name);
    case RightsDecision::Reason::role:
    case RightsDecision::Reason::default_role:
      break;
  }
  return refused_by_role(no.role);
}

/// Returns true for those whose changes take rights from others.
bool has_power(const WorldState& world, const RightsActor& actor) {
  if (!actor.key || actor.is_operator) return true;
  const RightSet rights = world.rights.role_of(*actor.key).rights;
  return rights.has(Right::moderate) || rights.has(Right::protect) || rights.has(Right::grant) ||
         rights.has(Right::administer);
}

void commit_all_edits(WorldState& world, const Clocks& now) {
  while (commit_and_broadcast(world, LargeEdits::all, now)) {
  }
}

/// Makes the change that gives the player of the session a role. Returns why it was refused, as a
/// sentence, or nullopt.
std::optional<std::string> take_role(WorldState& world, const WorldSession& mine,
                                     const RightsChange& change, const Clocks& now) {
  const PublicKey key = mine.key;
  const AuthorId author = world.players.enter(key, mine.name);
  const auto accepted = change_rights(world, change, actor_of(world, key), author, now);
  if (accepted) return std::nullopt;
  world.gone_authors.push_back(author);
  return accepted.error();
}

/// Returns the player whom a change is about, or null.
const PublicKey* target_of(const RightsChange& change) {
  if (const auto* grant = std::get_if<GrantRole>(&change)) return &grant->key;
  if (const auto* restricted = std::get_if<Restrict>(&change))
    return std::get_if<PublicKey>(&restricted->subject);
  return nullptr;
}

}  // namespace

std::optional<std::string> change_refusal(const WorldState& world, const RightsActor& actor,
                                          const RightsChange& change) {
  if (const auto invalid = validate(change); !invalid) return invalid.error().what;
  const PublicKey* target = target_of(change);
  if (target != nullptr && actor.key && is_operator(world, *target))
    return "the player is an operator by the server's settings";
  if (auto why = why_refused(world.rights, actor, change, rights_time(world))) return why;
  const auto* restricted = std::get_if<Restrict>(&change);
  const auto* range =
      restricted == nullptr ? nullptr : std::get_if<AddressRange>(&restricted->subject);
  const bool has_all =
      !actor.key || actor.is_operator || decide(world, *actor.key, Right::administer).is_allowed;
  if (range == nullptr || has_all) return std::nullopt;
  for (const auto& [id, session] : world.sessions) {
    if (session.state != SessionStage::open || !range->contains(session.address)) continue;
    const Restrict alone{RestrictionKind::ban, session.key, restricted->until_us, ""};
    if (change_refusal(world, actor, alone))
      return "A player is here from there to whom you cannot do this: " + session.name + ".";
  }
  return std::nullopt;
}

TimeUs rights_time(const WorldState& world) { return world.authority.log_clock().time(); }

RightsActor actor_of(const WorldState& world, const PublicKey& key) {
  return {key, is_operator(world, key)};
}

RightsDecision decide(const WorldState& world, const PublicKey& key, Right right) {
  if (is_operator(world, key)) return granted_by_settings();
  return world.rights.decide(key, right, rights_time(world));
}

std::optional<std::string> freeze_text(const WorldState& world, const PublicKey& key) {
  const auto* found = world.rights.restriction(RestrictionKind::freeze, key, rights_time(world));
  if (found == nullptr) return std::nullopt;
  return restriction_text(kMayNotEdit, found->value);
}

std::optional<std::string> chat_refusal(const WorldState& world, const PublicKey& key) {
  const RightsDecision decision = decide(world, key, Right::chat);
  if (decision.is_allowed) return std::nullopt;
  return refusal_text(world, key, decision);
}

std::optional<std::string> address_refusal(const WorldState& world, const PublicKey& key,
                                           AddressBlock address) {
  if (is_operator(world, key) || world.rights.role_of(key).rights.has(Right::administer))
    return std::nullopt;
  const auto* ban = world.rights.address_ban(address, rights_time(world));
  if (ban == nullptr) return std::nullopt;
  return restriction_text("your address is banned", ban->value);
}

std::optional<std::string> ban_refusal(const WorldState& world, const PublicKey& key,
                                       AddressBlock address) {
  if (is_operator(world, key)) return std::nullopt;
  if (auto refused = address_refusal(world, key, address)) return refused;
  const auto* ban = world.rights.restriction(RestrictionKind::ban, key, rights_time(world));
  if (ban != nullptr) return restriction_text("you are banned", ban->value);
  return std::nullopt;
}

std::optional<std::string> join_refusal(const WorldState& world, const PublicKey& key,
                                        AddressBlock address) {
  if (auto banned = ban_refusal(world, key, address)) return banned;
  const RightsDecision decision = decide(world, key, Right::see);
  if (decision.is_allowed) return std::nullopt;
  return "only invited players may join: your role is " + decision.role;
}

std::optional<std::string> edit_refusal(const WorldState& world, const PublicKey& key,
                                        const EditDescriptor& edit) {
  if (is_operator(world, key)) return std::nullopt;
  const Role& role = world.rights.role_of(key);
  if (role.edit_volume_max != 0 && counted_voxels(edit) > role.edit_volume_max)
    return refused_by_volume(role.edit_volume_max);
  const RightsDecision decision = world.rights.decide_edit(
      key, bounding_box(edit), [&edit](const VoxelBox& box) { return touches(edit, box); },
      rights_time(world));
  if (decision.is_allowed) return std::nullopt;
  return refusal_text(world, key, decision);
}

Result<Sequence, std::string> change_rights(WorldState& world, const RightsChange& change,
                                            const RightsActor& actor, AuthorId author,
                                            const Clocks& now) {
  if (auto why = change_refusal(world, actor, change)) return Unexpected<std::string>{*why};
  if (author != 0 && !world.players.key_of(author))
    return Unexpected<std::string>{"the player has left"};
  // What waits was allowed, and is ordered before the change that may forbid it. A claim does not
  // hurry: players could use it to send large edits faster than others.
  if (has_power(world, actor)) commit_all_edits(world, now);
  const OperationId op{author, world.change_instance, ++world.change_client_seq};
  const EditOffer offer{op, Cause::rights, now.steady_us, rights_edit(change), 0};
  const ServerEditsResult ordered = order_server_edits(world, {offer}, author, now);
  if (ordered.state == ServerEditsResult::State::ordered) return world.rights_seq;
  if (ordered.state == ServerEditsResult::State::closed)
    return Unexpected<std::string>{"the world takes no changes any more"};
  return Unexpected<std::string>{std::string(ordered.reason) + ": try again later"};
}

std::optional<std::string> accept_invite(WorldState& world, SessionId session,
                                         const std::string& ticket, const Clocks& now) {
  const WorldConfig& config = world.config;
  const auto invite = invite_of(ticket, config.world_id, config.server_keys.public_key);
  if (!invite) return "the invite is not one of this world";
  const WorldSession& mine = *world.find(session);
  return take_role(world, mine, AcceptInvite{*invite, mine.key}, now);
}

std::optional<std::string> accept_password(WorldState& world, SessionId session,
                                           const PasswordKey& key, const Clocks& now) {
  const WorldSession& mine = *world.find(session);
  const std::optional<JoinPassword>& password = world.rights.password().value;
  if (!password) return "the world has no password";
  if (!mine.binding) return "a password needs an encrypted connection";
  if (!world.guess_ledger.has(mine.address, kGuessPrice, now.steady_us)) return kTooManyGuesses;
  if (is_key_of(*password, key)) {
    // Each new player is a record that stays, and the number of grants has a bound.
    if (!world.join_ledger.take(mine.address, 1, now.steady_us))
      return "too many players joined with the password from your network: wait a minute";
    return take_role(world, mine, AcceptPassword{mine.key}, now);
  }
  world.guess_ledger.take(mine.address, kGuessPrice, now.steady_us);
  return "the password is wrong";
}

void apply_rights(WorldState& world, const std::vector<EditRecord>& records) {
  bool has_changed = false;
  std::vector<VoxelBox> ground;
  for (const EditRecord& record : records) {
    const RightsChange* change = rights_change_of(record.edit);
    if (change == nullptr) continue;
    add_changed_ground(world.rights, *change, ground);
    world.rights.apply(*change, {record.version.seq, record.op.author, record.time_us});
    world.rights_seq = record.version.seq;
    has_changed = true;
  }
  if (!has_changed) return;
  std::vector<std::pair<SessionId, std::string>> refused;
  for (const auto& [id, session] : world.sessions) {
    if (session.state == SessionStage::greeting) continue;
    if (session.join) continue;  // the owner of the world decides
    // A player who has not proved the key yet may bring an invite.
    auto why = session.is_authenticated ? join_refusal(world, session.key, session.address)
                                        : address_refusal(world, session.key, session.address);
    if (why) refused.emplace_back(id, *std::move(why));
  }
  for (const auto& [id, why] : refused) close_session(world, id, GoodbyeReason::not_admitted, why);
  rights_changed(world, ground);
}

std::size_t kick(WorldState& world, const RestrictionSubject& who, const std::string& reason) {
  std::vector<SessionId> kicked;
  for (const auto& [id, session] : world.sessions) {
    if (session.state != SessionStage::open) continue;
    const auto* key = std::get_if<PublicKey>(&who);
    const bool is_meant = key != nullptr ? session.key == *key
                                         : std::get<AddressRange>(who).contains(session.address);
    if (is_meant) kicked.push_back(id);
  }
  const std::string text = reason.empty() ? "you were kicked" : "you were kicked: " + reason;
  for (const SessionId id : kicked) close_session(world, id, GoodbyeReason::not_admitted, text);
  return kicked.size();
}

}  // namespace runstone
