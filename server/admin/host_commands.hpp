// The commands of administrators and of the host: names release, materials add, say, backup,
// reload, servers, handover, stop.
#pragma once
#include <span>

#include "server/admin/command_row.hpp"

namespace runstone {

std::span<const CommandRow> host_commands();

}  // namespace runstone
