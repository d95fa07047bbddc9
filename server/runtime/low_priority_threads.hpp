// Pools of threads for work that may wait.
#pragma once
#include <asio/thread_pool.hpp>
#include <cstddef>
#include <memory>

namespace runstone {

/// Makes a pool of threads of low priority (common/os/low_priority.hpp). On a machine with few
/// cores, small edits run before terrain, large messages, history and queries of the log.
std::unique_ptr<asio::thread_pool> low_priority_threads(std::size_t count);

}  // namespace runstone
