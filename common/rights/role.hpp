// Role: a named set of rights with limits. A player has one role. Five roles are built in; a world
// may define them otherwise and add its own.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/budget.hpp"
#include "common/rights/right.hpp"

namespace runstone {

inline constexpr std::size_t kRightsNameBytesMax = 32;
/// Returns true for a name of a role or a protected box: 1 .. kRightsNameBytesMax characters of
/// a-z, 0-9, "_", "-" and ".".
bool is_rights_name(std::string_view name);

struct Role {
  std::string name;
  RightSet rights;
  std::uint64_t edit_volume_max = 0;   // voxels of one edit; 0: as the server allows
  std::uint32_t claims_max = 0;        // boxes of one's own
  std::uint64_t claim_volume_max = 0;  // voxels of all of them together
  // Quotas instead of those in the server's settings; 0: the settings count.
  // At most kBudgetPerSecondMax and kBudgetBurstMax; both numbers are 0, or none is.
  Budget edit_budget{};
  std::uint8_t view_radius_max = 0;          // chunks; the settings' one counts if it is smaller
  std::uint32_t chunk_loads_per_second = 0;  // at most kBudgetPerSecondMax
  /// Returns true if the role has a quota of its own.
  bool has_quotas() const {
    return edit_budget.is_limited() || view_radius_max != 0 || chunk_loads_per_second != 0;
  }
  friend bool operator==(const Role&, const Role&) = default;
};

inline constexpr const char* kNobodyRole = "nobody";  // no rights: for a world of invited players
inline constexpr const char* kVisitorRole = "visitor";
inline constexpr const char* kBuilderRole = "builder";
inline constexpr const char* kModeratorRole = "moderator";
inline constexpr const char* kAdministratorRole = "administrator";

/// Returns the roles of a world whose log defines none, each with more rights than those before:
/// nobody, visitor, builder, moderator, administrator.
std::vector<Role> built_in_roles();

}  // namespace runstone
