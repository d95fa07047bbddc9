// The limit of open files and sockets of this process.
#pragma once
#include <cstddef>

namespace runstone {

/// Raises the soft limit to `needed`, or to the hard limit if that is lower. Never lowers the
/// limit. Returns the limit in force, or 0 if it is unknown. Makes system calls only, so it may be
/// called between fork() and exec().
std::size_t allow_open_files(std::size_t needed);

}  // namespace runstone
