// Attack: what hostile clients do to a server: a name, and how one connection of it behaves. Each is bounded in connections
// and time and ends by itself.
#pragma once
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <thread>
#include <vector>

namespace runstone::bench {

class HostileFleet;

struct Attack {
  const char* name;
  const char* what;                   // for people
  void (*play)(HostileFleet& fleet);  // one thread of the attack, until its time is over
};
/// All of them, by name.
std::span<const Attack> all_attacks();

/// What the server says, without what differs from one connection to the next: where in the stream it was, numbers that were sent.
std::string alike(const std::string& reason);

/// What became of an attack's connections.
struct AttackOutcome {
  std::map<std::string, std::uint64_t> endings;  // what the server said or did, and how often
  std::uint64_t connections = 0;
  std::uint64_t bytes_sent = 0, bytes_received = 0;
  double core_seconds = 0;  // spent by the attackers

  void merge(const AttackOutcome& other);
};

/// An attack under way, by so many clients from threads of their own. They have the lowest priority: what others feel is what the
/// server does, not that an attacker on the same machine takes the core which it would have had elsewhere.
class RunningAttack {
 public:
  /// `clients` threads with a connection each, or many where that is the attack.
  RunningAttack(const Attack& attack, std::uint16_t port, unsigned clients, double seconds,
                std::uint64_t seed);
  /// Waits for its end.
  ~RunningAttack();
  RunningAttack(const RunningAttack&) = delete;
  RunningAttack& operator=(const RunningAttack&) = delete;
  /// Waits for its end, which comes soon after the seconds are over or the lab is interrupted. Once.
  AttackOutcome finish();

 private:
  std::vector<AttackOutcome> outcomes_;  // by thread
  std::vector<std::thread> threads_;
};

}  // namespace runstone::bench
