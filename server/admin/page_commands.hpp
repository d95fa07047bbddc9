// The commands for the operators' page of runstone-web: page link, page list, page revoke.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "common/rights/right.hpp"
#include "common/rights/rights_state.hpp"
#include "server/admin/command_row.hpp"

namespace runstone {

/// The path of the page that exchanges a link, below the pages of a gateway.
inline constexpr std::string_view kPageEnterPath = "/operators/enter";

/// The rights with which the page has something to do.
inline constexpr RightSet kPageRights = {Right::protect, Right::roll_back, Right::moderate,
                                         Right::grant, Right::administer};

struct PageLinkCommand {
  std::string player;
  RightSet scope = RightSet::all();
  friend bool operator==(const PageLinkCommand&, const PageLinkCommand&) = default;
};
/// Whose tokens end: that of a number, those of a player, or all of them.
struct PageRevokeCommand {
  std::optional<std::uint64_t> number;
  std::string player;  // empty and no number: all
  friend bool operator==(const PageRevokeCommand&, const PageRevokeCommand&) = default;
};

/// Returns the rights with which a player may use the page now, or none: those of kPageRights that
/// are in the scope and that the player has. An operator of the settings has all of them.
RightSet page_rights(const RightsState& state, const RightsActor& actor, RightSet scope,
                     TimeUs now_us);

std::span<const CommandRow> page_commands();

}  // namespace runstone
