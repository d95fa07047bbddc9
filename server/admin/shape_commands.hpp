// The command `materials shapes`: cubes whose names say a shape get it.
#pragma once
#include <span>

#include "server/admin/command_row.hpp"

namespace runstone {

std::span<const CommandRow> shape_commands();

}  // namespace runstone
