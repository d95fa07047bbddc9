#include "server/admin/rights_change_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <utility>
#include <variant>

#include "common/core/key_text.hpp"
#include "common/core/utc_text.hpp"
#include "common/rights/restriction_text.hpp"
#include "protocol/codec/key_fingerprint.hpp"
#include "server/admin/address_range_text.hpp"
#include "server/admin/edit_budget_text.hpp"

namespace runstone {
namespace {

std::string line_for(const DefineRole& change) {
  return "role " + change.role.name + " := " + role_text(change.role);
}
std::string line_for(const RemoveRole& change) { return "role " + change.role + " removed"; }
std::string line_for(const GrantRole& change) {
  const std::string player = key_fingerprint(change.key);
  if (change.role.empty()) return "took the role of " + player + " back";
  return "gave " + player + " the role " + change.role +
         (change.until_us == 0 ? "" : " until " + utc_text(change.until_us));
}
std::string line_for(const SetDefaultRole& change) { return "default role " + change.role; }
std::string line_for(const Restrict& change) {
  const std::string what = restricted_text(change.kind);
  return restriction_text(what + " " + subject_text(change.subject), change);
}
std::string line_for(const Lift& change) {
  return "no longer " + std::string(restricted_text(change.kind)) + ": " +
         subject_text(change.subject);
}
std::string line_for(const Protect& change) {
  return "protected " + change.box.name + " " + box_text(change.box);
}
std::string line_for(const Unprotect& change) { return "no longer protected: " + change.box; }
std::string line_for(const CreateInvite& change) {
  return "made the invite " + invite_text(change.invite);
}
std::string line_for(const AcceptInvite& change) {
  return key_fingerprint(change.key) + " accepted the invite " + invite_id_text(change.invite);
}
std::string line_for(const CancelInvite& change) {
  return "cancelled the invite " + invite_id_text(change.invite);
}
std::string line_for(const SetPassword& change) {
  if (!change.password) return "removed the password";
  return "set a password for the role " + change.password->role;
}
std::string line_for(const AcceptPassword& change) {
  return key_fingerprint(change.key) + " joined with the password";
}
std::string line_for(const CorrectTime& change) {
  const bool is_back = change.step_us < 0;
  // The smallest step has no opposite.
  const TimeUs us = std::abs(std::max(change.step_us, -std::numeric_limits<TimeUs>::max()));
  return "set the time of the log " + std::string(is_back ? "back" : "forward") + " by " +
         apart_text(us);
}

}  // namespace

std::string apart_text(TimeUs us) {
  constexpr std::array<std::pair<TimeUs, char>, 4> kUnits = {
      {{86'400'000'000, 'd'}, {3'600'000'000, 'h'}, {60'000'000, 'm'}, {1'000'000, 's'}}};
  std::string text;
  std::size_t units = 0;
  for (const auto& [unit_us, letter] : kUnits) {
    const TimeUs count = us / unit_us;
    us %= unit_us;
    units += count != 0 || units != 0 ? 1 : 0;
    if (count != 0 && units <= 2) text += std::to_string(count) + letter;
  }
  return text.empty() ? "less than 1s" : text;
}

std::string rights_text(RightSet rights) {
  std::string text;
  for (std::size_t i = 0; i < kRightCount; ++i) {
    const auto right = static_cast<Right>(i);
    if (rights.has(right)) text += (text.empty() ? "" : ",") + std::string(name_of(right));
  }
  return text.empty() ? "none" : text;
}

std::string role_text(const Role& role) {
  std::string text = rights_text(role.rights);
  if (role.edit_volume_max != 0) text += " volume " + std::to_string(role.edit_volume_max);
  if (role.claims_max != 0) text += " claims " + std::to_string(role.claims_max);
  if (role.claim_volume_max != 0) text += " claim-volume " + std::to_string(role.claim_volume_max);
  if (role.edit_budget.is_limited()) text += " edits " + text_of(role.edit_budget);
  if (role.view_radius_max != 0) text += " view " + std::to_string(role.view_radius_max);
  if (role.chunk_loads_per_second != 0)
    text += " loads " + std::to_string(role.chunk_loads_per_second);
  return text;
}

std::string ground_text(const VoxelBox& box) {
  const VoxelPos last{box.max.x - 1, box.max.y - 1, box.max.z - 1};
  if (box.min.y == -kWorldLimit && box.max.y == kWorldLimit) {
    return "columns " + std::to_string(box.min.x) + " " + std::to_string(box.min.z) + " to " +
           std::to_string(last.x) + " " + std::to_string(last.z);
  }
  return text_of(box.min) + " to " + text_of(last);
}

const char* restricted_text(RestrictionKind kind) {
  switch (kind) {
    case RestrictionKind::ban:
      return "banned";
    case RestrictionKind::mute:
      return "muted";
    case RestrictionKind::freeze:
      return "frozen";
  }
  return "?";
}

std::string subject_text(const RestrictionSubject& subject) {
  if (const auto* key = std::get_if<PublicKey>(&subject)) return key_fingerprint(*key);
  return text_of(std::get<AddressRange>(subject));
}

std::string box_text(const ProtectedBox& box) {
  std::string text = ground_text(box.box);
  if (box.priority != 0) text += " priority " + std::to_string(box.priority);
  if (box.owner) text += " owner " + key_fingerprint(*box.owner);
  std::string members;
  for (const PublicKey& key : box.members)
    members += (members.empty() ? " members " : ",") + key_fingerprint(key);
  std::string roles;
  for (const std::string& role : box.roles) roles += (roles.empty() ? " roles " : ",") + role;
  return text + members + roles;
}

std::string invite_id_text(InviteId invite) { return fmt::format("{:016x}", invite); }

std::string invite_text(const Invite& invite) {
  return invite_id_text(invite.id) + ": role " + invite.role + ", " + std::to_string(invite.uses) +
         (invite.uses == 1 ? " use" : " uses") + ", until " + utc_text(invite.until_us);
}

std::string rights_change_text(const RightsChange& change) {
  return std::visit([](const auto& kind) { return line_for(kind); }, change);
}

}  // namespace runstone
