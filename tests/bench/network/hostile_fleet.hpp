// HostileFleet: what each thread of an attack has: its time, its share of chance, its connections and what became of them.
#pragma once
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>

#include "common/core/hash.hpp"
#include "tests/bench/network/attack.hpp"
#include "tests/bench/network/hostile_client.hpp"

namespace runstone::bench {

/// More than a server takes in a second from one session, and less: the one ends with a goodbye, the other stays.
inline constexpr double kNoLimit = 0;
inline constexpr double kJustBelowFlooding = 9'000;

class HostileFleet {
 public:
  static constexpr std::uint32_t kLoopback = 0x7F000001;  // 127.0.0.1
  static constexpr unsigned kConnectionsMax = 20'000;     // of each thread

  HostileFleet(std::uint16_t port, unsigned index, double seconds, std::uint64_t seed);

  unsigned index() const { return index_; }
  SplitMix64& random() { return random_; }
  bool is_over() const;
  double seconds() const;  // since it began
  void pause_ms(int ms) const;

  /// Null if the attack is over or has had its connections.
  std::unique_ptr<HostileClient> connect(std::uint32_t from = kLoopback, int receive_bytes = 0);
  /// The same with a session; after a pause null if the server did not want it.
  std::unique_ptr<HostileClient> join(int receive_bytes = 0);
  /// Notes what became of it.
  void end(HostileClient& client);

  /// Joins, and joins again when it is sent away, until the attack is over: `begin` once it has a session, then `add`, which queues
  /// messages, so often a second, or as often as the socket takes it; reads all that comes, or nothing.
  using Step = std::function<void(HostileClient&)>;
  void flood(const Step& begin, const Step& add, double per_second, bool reads = true);

  AttackOutcome outcome;

 private:
  using Clock = std::chrono::steady_clock;
  const std::uint16_t port_;
  const unsigned index_;
  const Clock::time_point began_, ends_;
  SplitMix64 random_;
};

}  // namespace runstone::bench
