#include "server/runtime/low_priority_threads.hpp"

#include <thread>

#include "common/os/low_priority.hpp"

namespace runstone {

std::unique_ptr<asio::thread_pool> low_priority_threads(std::size_t count) {
  std::unique_ptr<asio::thread_pool> threads;
  const auto start = [&] {
    lower_priority();  // threads inherit the priority of the thread that starts them
    threads = std::make_unique<asio::thread_pool>(count);
  };
  std::thread(start).join();
  return threads;
}

}  // namespace runstone
