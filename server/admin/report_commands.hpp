// The commands `report` of players, and `reports` and `reports close` of moderators.
#pragma once
#include <span>

#include "server/admin/command_row.hpp"

namespace runstone {

std::span<const CommandRow> report_commands();

}  // namespace runstone
