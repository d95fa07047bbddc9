#include "common/rights/role.hpp"

#include <algorithm>

namespace runstone {

bool is_rights_name(std::string_view name) {
  const auto is_allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
  };
  return !name.empty() && name.size() <= kRightsNameBytesMax &&
         std::all_of(name.begin(), name.end(), is_allowed);
}

std::vector<Role> built_in_roles() {
  constexpr std::uint32_t kClaims = 5;
  constexpr std::uint64_t kClaimVolume = 5 * 64 * 64 * 64;
  Role visitor{kVisitorRole, {Right::see, Right::chat, Right::look_back}, 0, 0, 0};
  Role builder = visitor;
  builder.name = kBuilderRole;
  builder.claims_max = kClaims;
  builder.claim_volume_max = kClaimVolume;
  for (const Right right : {Right::build, Right::claim, Right::undo}) builder.rights.add(right);
  Role moderator = builder;
  moderator.name = kModeratorRole;
  for (const Right right :
       {Right::build_protected, Right::roll_back, Right::moderate, Right::protect}) {
    moderator.rights.add(right);
  }
  Role administrator = moderator;
  administrator.name = kAdministratorRole;
  administrator.rights = RightSet::all();
  return {Role{kNobodyRole, {}, 0, 0, 0}, visitor, builder, moderator, administrator};
}

}  // namespace runstone
