// How many files and sockets this process may hold.
#pragma once
#include <cstddef>

namespace runstone {

/// Raises the soft limit to `needed`, or as far as the hard limit lets it; never lowers it. Returns the limit now in force, 0 if
/// the system does not tell. Nothing but system calls: may be called between fork() and exec().
std::size_t allow_open_files(std::size_t needed);

}  // namespace runstone
