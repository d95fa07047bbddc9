#include "common/rights/change_rules.hpp"

#include <algorithm>
#include <limits>

namespace runstone {
namespace {

using Refusal = std::optional<std::string>;

constexpr const char* kGrantsFull =
    "As many players have a role as the world can hold: one of them must lose it first (revoke "
    "PLAYER).";

std::string quoted(std::string_view text) { return "\"" + std::string(text) + "\""; }

std::optional<RightSet> built_in_rights(const std::string& role) {
  for (const Role& built_in : built_in_roles()) {
    if (built_in.name == role) return built_in.rights;
  }
  return std::nullopt;
}

/// The roles, grants and bans as they are, or as they would be after a change.
class Outlook {
 public:
  Outlook(const RightsState& state, const RightsChange* change, TimeUs now_us)
      : state_(state), change_(change), now_us_(now_us) {}

  bool has_administrator() const {
    if (default_administers()) return true;
    for (const auto& [key, grant] : state_.grants()) {
      if (administers(key, grant.value)) return true;
    }
    const auto* grant = kind<GrantRole>();
    return grant != nullptr && administers(grant->key, grant->role);
  }

 private:
  /// An administrator who may not join is none.
  static bool is_administrator(RightSet rights) {
    return rights.includes({Right::administer, Right::see});
  }
  template <class T>
  const T* kind() const {
    return std::get_if<T>(change_);
  }
  /// Returns nullopt if there is no such role.
  std::optional<RightSet> rights_of(const std::string& role) const {
    const auto* define = kind<DefineRole>();
    if (define != nullptr && define->role.name == role) return define->role.rights;
    const auto* remove = kind<RemoveRole>();
    if (remove != nullptr && remove->role == role) return built_in_rights(role);
    const Decided<Role>* found = state_.find_role(role);
    return found == nullptr ? std::nullopt : std::optional(found->value.rights);
  }
  bool default_administers() const {
    const auto* change = kind<SetDefaultRole>();
    const auto rights = rights_of(change == nullptr ? state_.default_role().value : change->role);
    return is_administrator(rights.value_or(rights_of(kVisitorRole).value_or(RightSet{})));
  }
  /// Returns true if the grant, which the change may replace, makes the key an administrator who
  /// may join. Requires that the default role does not administer.
  bool administers(const PublicKey& key, const std::string& granted) const {
    const auto* grant = kind<GrantRole>();
    const std::string& role = grant != nullptr && grant->key == key ? grant->role : granted;
    if (!is_administrator(rights_of(role).value_or(RightSet{}))) return false;
    const auto* restricted = kind<Restrict>();
    if (restricted != nullptr && restricted->kind == RestrictionKind::ban &&
        restricted->subject == RestrictionSubject{key}) {
      return false;
    }
    return state_.restriction(RestrictionKind::ban, key, now_us_) == nullptr;
  }

  const RightsState& state_;
  const RightsChange* change_;  // null: none
  TimeUs now_us_;
};

/// IPv6 prefixes of up to /48 and IPv4 prefixes of up to /24 are often those of one subscriber.
bool is_wide(const AddressRange& range) {
  const bool is_v4 = range.bits >= 32 && static_cast<std::uint64_t>(range.first) >> 32 == 0xffff;
  return range.bits < (is_v4 ? 32 + 24 : 48);
}

/// Returns the role of a player without a role for some time.
const Role& lasting_role_of(const RightsState& state, const PublicKey& key) {
  return state.role_of(key, std::numeric_limits<TimeUs>::max());
}

/// Checks one change of one actor.
class ChangeCheck {
 public:
  ChangeCheck(const RightsState& state, const RightsActor& actor, TimeUs now_us)
      : state_(state), actor_(actor), now_us_(now_us) {
    has_all_ = !actor.key || actor.is_operator;
    rights_ = has_all_ ? RightSet::all() : state.role_of(*actor.key, now_us).rights;
  }

  Refusal refused(const RightsChange& change) const {
    if (!has_all_ && state_.restriction(RestrictionKind::ban, *actor_.key, now_us_) != nullptr) {
      return "You are banned.";
    }
    return std::visit([this](const auto& kind) { return refused_kind(kind); }, change);
  }

 private:
  Refusal refused_kind(const DefineRole& change) const {
    if (auto lacks = needs(Right::administer)) return lacks;
    const Decided<Role>* old = state_.find_role(change.role.name);
    if (old == nullptr && state_.roles().size() >= kRolesMax) {
      return "The world has as many roles as it can have. Remove one first (role remove NAME).";
    }
    return refused_gift(change.role.rights, old == nullptr ? RightSet{} : old->value.rights);
  }

  Refusal refused_kind(const RemoveRole& change) const {
    if (auto lacks = needs(Right::administer)) return lacks;
    const Decided<Role>* old = state_.find_role(change.role);
    if (old == nullptr) return no_role(change.role);
    // A built-in role stays, whoever uses it.
    if (const auto rights = built_in_rights(change.role)) {
      if (old->by.seq == 0)
        return "The role " + quoted(change.role) + " is built in, and nothing was changed of it.";
      return refused_gift(*rights, old->value.rights);
    }
    if (state_.default_role().value == change.role) {
      return "The role " + quoted(change.role) +
             " is the default role: make another one the default first (role default NAME).";
    }
    for (const auto& [key, grant] : state_.grants()) {
      if (grant.value == change.role)
        return "A player has the role " + quoted(change.role) +
               ": give the players with it another one first (grants lists them).";
    }
    for (const auto& [key, grant] : state_.timed_grants()) {
      if (grant.value.role == change.role && state_.timed_grant(key, now_us_) != nullptr)
        return "A player has the role " + quoted(change.role) +
               " for some time: wait, or give the player another one first (grants lists them).";
    }
    return std::nullopt;
  }

  Refusal refused_kind(const GrantRole& change) const {
    if (!rights_.has(Right::administer)) {
      if (auto lacks = needs(Right::grant)) return lacks;
    }
    const std::string& name = change.role.empty() ? state_.default_role().value : change.role;
    const Decided<Role>* role = state_.find_role(name);
    if (role == nullptr) return no_role(name);
    if (auto reason = refused_target(change.key)) return reason;
    if (auto reason = refused_gift(role->value.rights, {})) return reason;
    if (change.until_us != 0) return refused_end(change);
    if (!change.role.empty() && !state_.grants().contains(change.key) &&
        state_.grants().size() >= kGrantsMax) {
      return kGrantsFull;
    }
    return std::nullopt;
  }

  Refusal refused_end(const GrantRole& change) const {
    if (change.until_us <= now_us_) return "The grant would have ended already.";
    const auto& timed = state_.timed_grants();
    const auto in_force = std::count_if(timed.begin(), timed.end(), [this](const auto& grant) {
      return state_.timed_grant(grant.first, now_us_) != nullptr;
    });
    if (!timed.contains(change.key) && static_cast<std::size_t>(in_force) >= kTimedGrantsMax) {
      return "As many players have a role for some time as the world can hold: revoke one first "
             "(grants lists them).";
    }
    return std::nullopt;
  }

  Refusal refused_kind(const SetDefaultRole& change) const {
    if (auto lacks = needs(Right::administer)) return lacks;
    const Decided<Role>* role = state_.find_role(change.role);
    if (role == nullptr) return no_role(change.role);
    return refused_gift(role->value.rights, {});
  }

  Refusal refused_kind(const Restrict& change) const {
    if (auto reason = refused_subject(change.subject)) return reason;
    if (state_.find_restriction(change.kind, change.subject) == nullptr &&
        state_.restriction_count() >= kRestrictionsMax) {
      return "The world has as many restrictions as it can hold. Lift some that have ended (bans lists "
             "them).";
    }
    return std::nullopt;
  }

  Refusal refused_kind(const Lift& change) const {
    if (auto reason = refused_subject(change.subject)) return reason;
    if (state_.find_restriction(change.kind, change.subject) == nullptr) {
      return "There is no such restriction (bans lists them).";
    }
    return std::nullopt;
  }

  Refusal refused_kind(const Protect& change) const {
    const ProtectedBox& box = change.box;
    const Decided<ProtectedBox>* found = state_.find_box(box.name);
    const ProtectedBox* old = found == nullptr ? nullptr : &found->value;
    const std::size_t boxes_max = rights_.has(Right::protect) ? kBoxesMax : kClaimedBoxesMax;
    if (old == nullptr && state_.boxes().size() >= boxes_max) {
      return "The world has as many protected boxes as it can have. Remove one first (unprotect "
             "NAME).";
    }
    for (const std::string& role : box.roles) {
      const bool is_old =
          old != nullptr && std::binary_search(old->roles.begin(), old->roles.end(), role);
      if (!is_old && state_.find_role(role) == nullptr) return no_role(role);
    }
    if (rights_.has(Right::protect)) return std::nullopt;
    return old == nullptr ? refused_claim(box) : refused_change_of_own(*old, box);
  }

  Refusal refused_kind(const Unprotect& change) const {
    const Decided<ProtectedBox>* box = state_.find_box(change.box);
    if (box == nullptr)
      return "There is no protected box " + quoted(change.box) + " (protected lists them).";
    if (rights_.has(Right::protect)) return std::nullopt;
    if (!box->value.owner || box->value.owner != actor_.key) return needs(Right::protect);
    return refused_while_frozen();
  }

  Refusal refused_kind(const CreateInvite& change) const {
    if (!rights_.has(Right::administer)) {
      if (auto lacks = needs(Right::grant)) return lacks;
    }
    if (auto reason = refused_joining_role(change.invite.role)) return reason;
    if (change.invite.until_us <= now_us_) return "The invite would have ended already.";
    if (state_.invites().contains(change.invite.id)) return "There is such an invite already.";
    const auto usable =
        std::count_if(state_.invites().begin(), state_.invites().end(), [this](const auto& invite) {
          return state_.usable_invite(invite.first, now_us_) != nullptr;
        });
    if (static_cast<std::size_t>(usable) >= kInvitesMax) {
      return "The world has as many invites as it can have. Cancel some (invite cancel ID).";
    }
    return std::nullopt;
  }

  Refusal refused_kind(const AcceptInvite& change) const {
    if (actor_.key != change.key) return "Nobody accepts an invite for somebody else.";
    const auto found = state_.invites().find(change.invite);
    if (found == state_.invites().end()) {
      return "The invite was cancelled, has ended, or is of another world.";
    }
    const OpenInvite& open = found->second.value;
    if (open.invite.until_us <= now_us_) return "The invite has ended.";
    if (open.accepted >= open.invite.uses) return "The invite was used as often as it may be.";
    return refused_first_grant(change.key, open.invite.role);
  }

  Refusal refused_kind(const SetPassword& change) const {
    if (auto lacks = needs(Right::administer)) return lacks;
    if (change.password) return refused_joining_role(change.password->role);
    if (!state_.password().value) return "The world has no password.";
    return std::nullopt;
  }

  Refusal refused_kind(const AcceptPassword& change) const {
    if (actor_.key != change.key) return "Nobody joins with a password for somebody else.";
    const std::optional<JoinPassword>& password = state_.password().value;
    if (!password) return "The world has no password.";
    return refused_first_grant(change.key, password->role);
  }

  Refusal refused_kind(const CorrectTime& /*change*/) const { return needs(Right::administer); }

  Refusal refused_kind(const CancelInvite& change) const {
    if (!rights_.has(Right::administer)) {
      if (auto lacks = needs(Right::grant)) return lacks;
    }
    if (!state_.invites().contains(change.invite))
      return "There is no such invite (invites lists them).";
    return std::nullopt;
  }

  /// Checks a role that players get when they join.
  Refusal refused_joining_role(const std::string& name) const {
    const Decided<Role>* role = state_.find_role(name);
    if (role == nullptr) return no_role(name);
    if (auto reason = refused_gift(role->value.rights, {})) return reason;
    if (role->value.rights.has(Right::see)) return std::nullopt;
    return "Players with the role " + quoted(name) +
           " may not join: choose a role with the right see (roles lists them).";
  }

  /// Checks the role that a player gets on joining.
  Refusal refused_first_grant(const PublicKey& key, const std::string& role) const {
    if (state_.grants().contains(key)) return "You have a role already.";
    if (state_.find_role(role) == nullptr) return no_role(role);
    if (state_.grants().size() >= kGrantsMax) return kGrantsFull;
    return std::nullopt;
  }

  Refusal refused_claim(const ProtectedBox& box) const {
    if (!rights_.has(Right::claim)) return needs(Right::protect);
    if (box.owner != actor_.key)
      return "Without the right to protect you claim ground for yourself.";
    if (box.priority != 0) return "Without the right to protect a box has the priority 0.";
    return refused_place(nullptr, box);
  }

  Refusal refused_change_of_own(const ProtectedBox& old, const ProtectedBox& box) const {
    if (!old.owner || old.owner != actor_.key) {
      return "The box " + quoted(old.name) + " belongs to somebody else.";
    }
    if (box.owner != old.owner) return "Without the right to protect the owner of a box stays.";
    if (box.priority != old.priority) {
      return "Without the right to protect the priority of a box stays.";
    }
    // A changed box is the newest one, so even a change of members may take ground.
    if (box.box == old.box) return refused_ground(box);
    if (auto lacks = needs(Right::claim)) return lacks;
    return refused_place(&old, box);
  }

  Refusal refused_while_frozen() const {
    if (has_all_ || state_.restriction(RestrictionKind::freeze, *actor_.key, now_us_) == nullptr)
      return std::nullopt;
    return "You may not edit now.";
  }

  /// Requires an actor with a key. `old` is the box that this one replaces, or null.
  Refusal refused_place(const ProtectedBox* old, const ProtectedBox& box) const {
    const Role& role = state_.role_of(*actor_.key, now_us_);
    const RightsState::Holding others = state_.holding_of(*actor_.key, old);
    if (others.boxes >= role.claims_max) {
      return "Your role allows " + std::to_string(role.claims_max) +
             " boxes: remove one of yours first (unprotect NAME).";
    }
    const std::uint64_t volume = volume_of(box.box);
    if (volume > role.claim_volume_max || others.volume > role.claim_volume_max - volume) {
      return "Your role allows boxes of " + std::to_string(role.claim_volume_max) +
             " voxels together: make it smaller, or remove one of yours first (unprotect NAME).";
    }
    return refused_ground(box);
  }

  /// Checks the ground of a box that becomes the newest one of its priority.
  Refusal refused_ground(const ProtectedBox& box) const {
    if (auto frozen = refused_while_frozen()) return frozen;
    for (const auto* other : state_.boxes_in(box.box)) {
      if (other->value.priority <= box.priority && other->value.owner != actor_.key) {
        return "The box " + quoted(other->value.name) + " of somebody else lies there.";
      }
    }
    const auto touches = [&](const VoxelBox& part) { return overlaps(part, box.box); };
    const RightsDecision decision = state_.decide_edit(*actor_.key, box.box, touches, now_us_);
    if (decision.is_allowed) return std::nullopt;
    if (decision.box == nullptr) return "You may not build there.";
    return "You may not change the ground of the box " + quoted(decision.box->name) + ".";
  }

  Refusal needs(Right right) const {
    if (rights_.has(right)) return std::nullopt;
    return "You need the right " + quoted(name_of(right)) + ".";
  }

  static Refusal no_role(const std::string& role) {
    return "There is no role " + quoted(role) + " (roles lists them).";
  }

  /// Checks rights that the actor gives. Those that the receiver has already are `old`.
  Refusal refused_gift(RightSet given, RightSet old) const {
    for (std::size_t i = 0; i < kRightCount; ++i) {
      const auto right = static_cast<Right>(i);
      if (given.has(right) && !old.has(right) && !rights_.has(right)) {
        return "You lack the right " + quoted(name_of(right)) +
               " and cannot give it: ask an administrator, or the host.";
      }
    }
    return std::nullopt;
  }

  Refusal refused_target(const PublicKey& target) const {
    if (actor_.key == target)
      return "You cannot do this to yourself: another administrator can, or the host at the console.";
    if (has_all_ || rights_.has(Right::administer)) return std::nullopt;
    // A player with a role for some time is protected at least as well as by the role that counts
    // afterwards.
    const auto has_fewer = [this](RightSet theirs) {
      return rights_.includes(theirs) && theirs != rights_;
    };
    if (has_fewer(state_.role_of(target, now_us_).rights) &&
        has_fewer(lasting_role_of(state_, target).rights)) {
      return std::nullopt;
    }
    return "You can do this only to players who have fewer rights than you: ask an administrator, or "
           "the host.";
  }

  Refusal refused_subject(const RestrictionSubject& subject) const {
    if (auto lacks = needs(Right::moderate)) return lacks;
    if (const auto* key = std::get_if<PublicKey>(&subject)) return refused_target(*key);
    return is_wide(std::get<AddressRange>(subject)) ? needs(Right::administer) : std::nullopt;
  }

  const RightsState& state_;
  const RightsActor& actor_;
  TimeUs now_us_;
  bool has_all_ = false;
  RightSet rights_;
};

/// Returns true if the change may take the right `administer` from a key.
bool may_take_administer(const RightsState& state, const RightsChange& change, TimeUs now_us) {
  const auto administers = [&](const PublicKey& key) {
    return state.role_of(key, now_us).rights.has(Right::administer) ||
           lasting_role_of(state, key).rights.has(Right::administer);
  };
  if (const auto* grant = std::get_if<GrantRole>(&change)) return administers(grant->key);
  if (const auto* restricted = std::get_if<Restrict>(&change)) {
    const auto* key = std::get_if<PublicKey>(&restricted->subject);
    return key != nullptr && restricted->kind == RestrictionKind::ban && administers(*key);
  }
  return std::holds_alternative<DefineRole>(change) || std::holds_alternative<RemoveRole>(change) ||
         std::holds_alternative<SetDefaultRole>(change);
}

}  // namespace

Refusal why_refused(const RightsState& state, const RightsActor& actor, const RightsChange& change,
                    TimeUs now_us) {
  if (auto reason = ChangeCheck(state, actor, now_us).refused(change)) return reason;
  if (may_take_administer(state, change, now_us) &&
      Outlook(state, nullptr, now_us).has_administrator() &&
      !Outlook(state, &change, now_us).has_administrator()) {
    return "The world would have no administrator any more: give another player a role with the "
           "rights see and administer first (grant PLAYER administrator).";
  }
  return std::nullopt;
}

}  // namespace runstone
