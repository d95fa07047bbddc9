#include "server/world/rights/rights.hpp"

#include <utility>
#include <variant>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/rights/restriction_text.hpp"
#include "protocol/rules/refusal_text.hpp"

namespace runstone {
namespace {

RightsDecision granted_by_settings() {
  RightsDecision out;
  out.is_allowed = true;
  return out;
}

constexpr const char* kMayNotEdit = "you may not edit";

/// Returns the player whom a change is about, or null.
const PublicKey* target_of(const RightsChange& change) {
  if (const auto* grant = std::get_if<GrantRole>(&change)) return &grant->key;
  if (const auto* restricted = std::get_if<Restrict>(&change))
    return std::get_if<PublicKey>(&restricted->subject);
  return nullptr;
}

/// Adds the ground that the change affects: that of the box before and after it. Call it before the
/// change is applied.
void add_changed_ground(const RightsState& rights, const RightsChange& change,
                        std::vector<VoxelBox>& ground) {
  const auto add_box_of = [&](const std::string& name) {
    if (const auto* box = rights.find_box(name)) ground.push_back(box->value.box);
  };
  if (const auto* protect = std::get_if<Protect>(&change)) {
    add_box_of(protect->box.name);
    ground.push_back(protect->box.box);
  } else if (const auto* unprotect = std::get_if<Unprotect>(&change)) {
    add_box_of(unprotect->box);
  }
}

}  // namespace

Rights::Rights(const WorldConfig& config, const WorldStart& start, const Order& order,
               Sessions& sessions)
    : config_(config), order_(order), sessions_(sessions) {
  for (const RightsRecord& record : start.rights) state_.apply(record.change, record.origin);
}

std::string Rights::refusal_text(const PublicKey& key, const RightsDecision& no) const {
  const auto restricted = [&](RestrictionKind kind, const char* what) {
    const auto* found = state_.restriction(kind, key, time());
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

std::optional<std::string> Rights::change_refusal(const RightsChange& change,
                                                  const RightsActor& actor) const {
  if (const auto invalid = validate(change); !invalid) return invalid.error().what;
  const PublicKey* target = target_of(change);
  if (target != nullptr && actor.key && is_operator(*target))
    return "the player is an operator by the server's settings";
  if (auto why = why_refused(state_, actor, change, time())) return why;
  const auto* restricted = std::get_if<Restrict>(&change);
  const auto* range =
      restricted == nullptr ? nullptr : std::get_if<AddressRange>(&restricted->subject);
  const bool has_all =
      !actor.key || actor.is_operator || decide(*actor.key, Right::administer).is_allowed;
  if (range == nullptr || has_all) return std::nullopt;
  for (const Session* session : std::as_const(sessions_).open()) {
    if (!range->contains(session->address)) continue;
    const Restrict alone{RestrictionKind::ban, session->key, restricted->until_us, ""};
    if (change_refusal(alone, actor))
      return "A player is here from there to whom you cannot do this: " + session->name + ".";
  }
  return std::nullopt;
}

RightsDecision Rights::decide(const PublicKey& key, Right right) const {
  if (is_operator(key)) return granted_by_settings();
  return state_.decide(key, right, time());
}

std::optional<std::string> Rights::freeze_text(const PublicKey& key) const {
  const auto* found = state_.restriction(RestrictionKind::freeze, key, time());
  if (found == nullptr) return std::nullopt;
  return restriction_text(kMayNotEdit, found->value);
}

std::optional<std::string> Rights::chat_refusal(const PublicKey& key) const {
  const RightsDecision decision = decide(key, Right::chat);
  if (decision.is_allowed) return std::nullopt;
  return refusal_text(key, decision);
}

std::optional<std::string> Rights::address_refusal(const PublicKey& key,
                                                   AddressBlock address) const {
  if (is_operator(key) || state_.role_of(key).rights.has(Right::administer)) return std::nullopt;
  const auto* ban = state_.address_ban(address, time());
  if (ban == nullptr) return std::nullopt;
  return restriction_text("your address is banned", ban->value);
}

std::optional<std::string> Rights::ban_refusal(const PublicKey& key, AddressBlock address) const {
  if (is_operator(key)) return std::nullopt;
  if (auto refused = address_refusal(key, address)) return refused;
  const auto* ban = state_.restriction(RestrictionKind::ban, key, time());
  if (ban != nullptr) return restriction_text("you are banned", ban->value);
  return std::nullopt;
}

std::optional<std::string> Rights::join_refusal(const PublicKey& key, AddressBlock address) const {
  if (auto banned = ban_refusal(key, address)) return banned;
  const RightsDecision decision = decide(key, Right::see);
  if (decision.is_allowed) return std::nullopt;
  return "only invited players may join: your role is " + decision.role;
}

std::optional<std::string> Rights::edit_refusal(const PublicKey& key,
                                                const EditDescriptor& edit) const {
  if (is_operator(key)) return std::nullopt;
  const Role& role = state_.role_of(key);
  if (role.edit_volume_max != 0 && counted_voxels(edit) > role.edit_volume_max)
    return refused_by_volume(role.edit_volume_max);
  const RightsDecision decision = state_.decide_edit(
      key, bounding_box(edit), [&edit](const VoxelBox& box) { return touches(edit, box); }, time());
  if (decision.is_allowed) return std::nullopt;
  return refusal_text(key, decision);
}

std::optional<std::string> Rights::edit_refusal(AuthorId author, const EditDescriptor& edit) const {
  if (author == 0) return std::nullopt;
  const auto key = order_.players().key_of(author);
  return key ? edit_refusal(*key, edit) : "the player has left";
}

std::optional<std::vector<VoxelBox>> Rights::apply(const std::vector<EditRecord>& records) {
  std::optional<std::vector<VoxelBox>> ground;
  for (const EditRecord& record : records) {
    const RightsChange* change = rights_change_of(record.edit);
    if (change == nullptr) continue;
    if (!ground) ground.emplace();
    add_changed_ground(state_, *change, *ground);
    state_.apply(*change, {record.version.seq, record.op.author, record.time_us});
    newest_ = record.version.seq;
  }
  if (ground) ++revision_;
  return ground;
}

std::vector<GrantRole> Rights::end_grants() {
  const TimeUs now_us = time();
  state_.set_time(now_us);
  const TimeUs since_us = std::exchange(grants_ended_us_, now_us).value_or(now_us);
  std::vector<GrantRole> ended = state_.grants_ended(since_us, now_us);
  if (!ended.empty()) ++revision_;
  return ended;
}

void Rights::close_refused() {
  std::vector<std::pair<Session*, std::string>> refused;
  for (Session* session : sessions_.all()) {
    if (session->stage == SessionStage::greeting) continue;
    if (session->awaits_owner) continue;  // the owner of the world decides
    // A player who has not proved the key yet may bring an invite.
    auto why = session->is_authenticated ? join_refusal(session->key, session->address)
                                         : address_refusal(session->key, session->address);
    if (why) refused.emplace_back(session, *std::move(why));
  }
  for (const auto& [session, why] : refused)
    sessions_.close(*session, GoodbyeReason::not_admitted, why);
}

}  // namespace runstone
