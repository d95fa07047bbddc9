// The lines about a copy of a world that the programs of this folder print.
#pragma once
#include <iosfwd>
#include <string>

#include "server/backup/world_backup.hpp"

namespace runstone {

/// Returns text such as "4.2 s".
std::string seconds_text(double seconds);

/// Prints the world, the moment, the bytes, what was verified, and what is left out, a line each.
void print_copy(const WorldBackup& backup, std::ostream& out);

}  // namespace runstone
