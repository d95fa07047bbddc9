// HostileResult: what was measured with one row of strangers or of a flood.
#pragma once
#include <string>

#include "bench/network/attack.hpp"
#include "bench/network/fleet.hpp"
#include "bench/network/join_probe.hpp"

namespace runstone::bench {

/// The measurements of one phase: latencies of builders, joins of newcomers, and the server's use
/// of memory and processors.
struct HostilePhase {
  FleetReport seen;
  JoinProbe::Joins joins;
  double echo_p99_ms = 0;   // of a plain Asio server: the load of the machine
  double server_mb = 0;     // resident memory, the most
  double server_files = 0;  // open files and sockets, the most
  double server_cores = 0, bot_cores = 0;
  AttackOutcome outcome;  // of the attackers, if there were any
};

struct HostileResult {
  std::string name;
  unsigned addresses = 1;  // of the attackers
  // A quiet row has no attack. A row whose server has raised limits shows what each connection
  // costs and does not count for the targets.
  bool is_quiet = false, has_raised_limits = false;
  HostilePhase before, during;  // without the attack, and beside it
  double seconds = 0;           // of each phase
  // Two seconds after the attack: resident memory, and sockets more than before the first builder.
  double mb_after = 0, sockets_after = 0;
  double accepted = 0, refused = 0;  // connections, from the start to the end of the server

  double grown_mb() const { return during.server_mb - before.server_mb; }
  /// Returns the attackers' connections that the server held at a time, the most.
  double sockets_during() const { return during.server_files - before.server_files; }
  double attacker_cores() const { return during.outcome.core_seconds / seconds; }
};

}  // namespace runstone::bench
