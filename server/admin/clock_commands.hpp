// The commands about the time of the log: clock, clock correct.
#pragma once
#include <span>

#include "server/admin/command_row.hpp"

namespace runstone {

std::span<const CommandRow> clock_commands();

}  // namespace runstone
