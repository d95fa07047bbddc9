// How many files and sockets this process may hold.
#pragma once
#include <cstddef>

namespace runstone {

/// Raises the soft limit to `needed`, or as far as the hard limit lets it. Returns the limit now in force.
std::size_t allow_open_files(std::size_t needed);

}  // namespace runstone
