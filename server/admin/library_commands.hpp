// The commands of the library of builds: `builds list`, `show`, `import`, `export`, `picture`,
// `place`, `cancel` and `remove`.
#pragma once
#include <span>

#include "server/admin/command_row.hpp"

namespace runstone {

std::span<const CommandRow> library_commands();

}  // namespace runstone
