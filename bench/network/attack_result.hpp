// AttackResult: what was measured with one attack.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "bench/network/attack.hpp"
#include "bench/network/fleet.hpp"
#include "bench/network/join_probe.hpp"
#include "bench/network/page_times.hpp"

namespace runstone::bench {

/// The phases in which honest builders edit.
enum AttackPhase : std::uint8_t { before, during, after };
inline constexpr std::array<AttackPhase, 3> kAttackPhases = {before, during, after};
inline constexpr std::array<const char*, 3> kAttackPhaseNames = {"before", "during", "after"};

struct AttackResult {
  std::string name;
  bool is_hostile = true;
  std::array<FleetReport, 3> seen;  // by phase
  // The round trip of a message to a plain Asio server during the attack: the load of the machine.
  double echo_p99_ms = 0;
  JoinProbe::Joins joins;
  bool has_gateway = false;
  std::array<PageTimes, 3> pages;  // by phase; empty without a gateway
  AttackOutcome outcome;
  // The reasons in the server's log. The log may drop lines.
  std::map<std::string, std::uint64_t> logged;
  // The memory at the end of the phase; for the attack itself, the peak.
  std::array<double, 3> resident_mb{};
  double resident_max_mb = 0;  // from the begin of the attack to the end of the server
  std::array<double, 3> server_cores{};
  std::array<double, 3> gateway_cores{};
  double bot_cores = 0;  // during the attack, of the program that all builders share
  double attacker_cores = 0;
  double written_kb = 0;      // to disk, during the attack
  double written_all_kb = 0;  // from the begin of the attack to the end of the server
  double stop_s = 0;          // from SIGTERM, while the attack goes on, to the end of the server
};

}  // namespace runstone::bench
