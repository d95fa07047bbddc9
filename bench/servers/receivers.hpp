// Receivers: clients that connect, and then read and discard all input. They share one thread.
// They decrypt nothing, so that a benchmark measures the sender.
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "bench/network/descriptor.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

class Receivers {
 public:
  /// Starts the thread, which connects `count` clients to this port of the loopback, one after
  /// another.
  Receivers(std::uint16_t port, std::size_t count, bool is_encrypted);
  /// Ends the thread.
  ~Receivers();
  Receivers(const Receivers&) = delete;
  Receivers& operator=(const Receivers&) = delete;

  /// Waits for the connections. Fails if one cannot be made, with the reason. Thread: any.
  Result<void, std::string> wait() const;

 private:
  void run();
  /// Connects one client. Returns false and sets failure_ if that is impossible.
  bool connect();
  void read_all();

  const std::uint16_t port_;
  const std::size_t count_;
  const bool is_encrypted_;
  std::vector<Descriptor> sockets_;
  std::atomic<bool> is_connected_{false}, is_over_{false};
  std::string failure_;  // valid when is_connected_
  std::thread thread_;
};

}  // namespace runstone::bench
