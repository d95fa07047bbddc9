// The command that gives materials the textures of a folder.
#pragma once
#include <span>

#include "server/admin/command_row.hpp"

namespace runstone {

std::span<const CommandRow> texture_commands();

}  // namespace runstone
