// Attack: a way in which hostile clients misuse a server: a name, and the behaviour of one
// connection. Each attack is bounded in connections and time and ends by itself.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <thread>
#include <vector>

namespace runstone::bench {

class AttackThread;

/// The edits of each honest bot under attack, as of a player who drags the mouse. They are so many
/// that a p99 is more than the two slowest edits of some seconds.
inline constexpr double kAttackedEditsPerSecond = 10;

struct Attack {
  const char* name;
  const char* what;                    // a description for readers
  void (*play)(AttackThread& thread);  // one thread of the attack, until its time is over
  bool is_hostile = true;              // false: a row to compare with
  bool needs_gateway = false;          // with a map
};
/// The attack in which nobody attacks. The other rows are compared with it.
inline constexpr const char* kQuiet = "quiet";
/// The attack that takes seats from one range of addresses. Newcomers connect from other ranges.
inline constexpr const char* kSeatsByRange = "seats-by-range";
/// Returns all attacks, by name.
std::span<const Attack> all_attacks();

/// Returns a server's message without the parts that differ between connections: stream offsets and
/// numbers that were sent.
std::string alike(const std::string& reason);

/// The outcomes of an attack's connections.
struct AttackOutcome {
  std::map<std::string, std::uint64_t> endings;  // what the server said or did, and how often
  std::uint64_t connections = 0;
  std::uint64_t bytes_sent = 0, bytes_received = 0;
  double core_seconds = 0;  // spent by the attackers

  void merge(const AttackOutcome& other);
};

/// The size of an attack.
struct AttackPlan {
  std::uint16_t port = 0;  // of the server
  unsigned clients = 1;    // threads; each has one connection, or many if the attack needs many
  unsigned addresses = 1;  // of which each thread has one, unless it uses all of them
  double seconds = 0;
  std::uint64_t seed = 0;
  bool is_encrypted = true;  // the server speaks TLS
  // Attackers run only while a core has nothing else to do. Other programs on the machine may keep
  // them from running at all.
  bool uses_idle_cores = true;
  std::uint16_t web_port = 0;  // of the gateway; 0: there is none
};

/// A running attack by several clients, each on a thread of its own. The threads have the lowest
/// priority. So the latency of the bots shows the load of the server, and not the cores that
/// attackers on the same machine use.
class RunningAttack {
 public:
  /// Starts the threads. Each calls `play` once, with a priority below that of all other programs.
  RunningAttack(std::function<void(AttackThread&)> play, const AttackPlan& plan);
  /// Ends the attack.
  ~RunningAttack();
  RunningAttack(const RunningAttack&) = delete;
  RunningAttack& operator=(const RunningAttack&) = delete;
  /// Ends the attack soon, before its seconds are over.
  void stop() { is_stopped_ = true; }
  /// Waits for the end of the attack, which comes soon after its seconds are over, after
  /// stop(), or after the testbed is interrupted. Call it once.
  AttackOutcome finish();

 private:
  std::atomic<bool> is_stopped_{false};
  const std::function<void(AttackThread&)> play_;
  std::vector<AttackOutcome> outcomes_;  // by thread
  std::vector<std::thread> threads_;
};

}  // namespace runstone::bench
