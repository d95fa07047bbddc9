// AttackThread: the state of each thread of an attack: its time, its random numbers, its
// connections and their outcomes.
#pragma once
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "bench/network/attack.hpp"
#include "bench/network/attack_client.hpp"
#include "common/core/hash.hpp"

namespace runstone::bench {

/// A rate above and one below what a server takes in a second from one session: the first ends with
/// a goodbye, the second stays.
inline constexpr double kNoLimit = 0;
inline constexpr double kJustBelowFlooding = 9'000;

class AttackThread {
 public:
  static constexpr std::uint32_t kLoopback = 0x7F000001;      // 127.0.0.1: of the honest clients
  static constexpr std::uint32_t kAttackers = kLoopback + 1;  // 127.0.0.2 and following
  static constexpr unsigned kConnectionsMax = 50'000;         // of each thread
  /// Returns address `n` of attackers with several: 127.0.0.2, 127.0.1.2 and so on. Each is of
  /// another /24, because a server limits what comes from one.
  static constexpr std::uint32_t address(unsigned n) { return kAttackers + (n << 8); }
  /// Returns address `n` of attackers who share a /24 that nobody else uses: 127.3.3.1 and so on.
  static constexpr std::uint32_t address_of_range(unsigned n) { return 0x7F030301 + n % 254; }

  /// `is_stopped` ends the attack early. It must outlive the thread.
  AttackThread(const AttackPlan& plan, unsigned index, const std::atomic<bool>& is_stopped);

  unsigned index() const { return index_; }
  /// Returns the rate of a flood of messages: every second thread stays below the server's limit.
  double flood_rate() const { return index_ % 2 == 0 ? kJustBelowFlooding : kNoLimit; }
  SplitMix64& random() { return random_; }
  bool is_over() const;
  /// Returns true if the attack is not over and has connections left.
  bool may_connect() const { return !is_over() && outcome.connections < kConnectionsMax; }
  double seconds() const;  // since it began
  void pause_ms(int ms) const;

  /// Returns a new connection, or null if the attack is over or has used its connections.
  std::unique_ptr<AttackClient> connect(std::uint32_t from = kAttackers, int receive_bytes = 0);
  /// Returns a new connection with a session, from the thread's address. Returns null after a pause
  /// if the server rejected it.
  std::unique_ptr<AttackClient> join(int receive_bytes = 0,
                                     std::uint64_t features = AttackClient::kFeatures);
  /// Records the ending of a connection.
  void end(AttackClient& client);

  /// Joins, and joins again whenever the server ends the session, until the attack is over. Calls
  /// `begin` once for each session. Then calls `add`, which queues messages, at a rate per second,
  /// or as often as the socket takes them. Reads everything that arrives, or nothing.
  using Step = std::function<void(AttackClient&)>;
  void flood(const Step& begin, const Step& add, double per_second, bool reads = true);
  /// Calls `add` and sends, at this rate, until the server ends the connection or the attack is
  /// over. Records the ending.
  void send_to(AttackClient& client, const Step& add, double per_second, bool reads = true);

  std::uint32_t own_address() const { return address_; }
  unsigned addresses() const { return addresses_; }
  /// Returns the port of the gateway. Requires that there is one.
  std::uint16_t web_port() const { return web_port_; }
  /// Returns null if server and gateway do not encrypt.
  const TlsContext* tls() const { return tls_ ? &*tls_ : nullptr; }

  AttackOutcome outcome;

 private:
  using Clock = std::chrono::steady_clock;
  const std::uint16_t port_, web_port_;
  const unsigned index_, addresses_;
  const std::uint32_t address_;
  const std::atomic<bool>& is_stopped_;
  const Clock::time_point began_, ends_;
  SplitMix64 random_;
  std::optional<TlsContext> tls_;
};

/// A step that does nothing.
inline void say_nothing(AttackClient& /*client*/) {}

}  // namespace runstone::bench
