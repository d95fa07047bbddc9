// The free space of a file system.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

namespace runstone {

/// Returns the bytes that this user may still write to the file system that holds `path`. Returns
/// nullopt if the system does not say.
std::optional<std::uint64_t> free_bytes(const std::string& path);

}  // namespace runstone
