// View memory: what the queues of views may take. It lies outside of memory_mib, which bounds chunks
// and edits, so a host is warned if it could be more than that.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "server/admin/server_config.hpp"

namespace runstone {

/// Returns about how many bytes the server keeps for a session whose view has this radius in all
/// directions: an entry of its queue for each chunk (SessionInterest), and the room with which the
/// queue grows. Cost: O(radius).
std::size_t view_bytes(std::uint64_t radius);

/// Returns a warning if the views of all sessions could take more than memory_mib, or nullopt.
std::optional<std::string> view_memory_warning(const ServerConfig& config);

}  // namespace runstone
