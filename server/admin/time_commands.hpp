// The commands about the time of day of the world: time, time HH:MM, time rate N.
#pragma once
#include <span>

#include "server/admin/command_row.hpp"

namespace runstone {

std::span<const CommandRow> time_commands();

}  // namespace runstone
