// NetOptions: the command line of `runstone-bench net`.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bench/network/testbed_link.hpp"

namespace CLI {
class App;
}

namespace runstone::bench {

struct NetOptions {
  // All experiments but "siege", "strangers" and "floods", which take ten minutes each, "backup",
  // which writes some GB, and "gateway", which takes five minutes.
  std::vector<std::string> experiments = {"latency", "join",   "transfer", "horizon",
                                          "crowd",   "attack", "memory"};
  std::vector<std::string> profiles;  // of the links; empty: all
  std::vector<std::string> worlds;    // of the transfers; empty: all
  std::string luanti;                 // folder of the real world
  std::string link = "auto";          // namespaces where possible; or "namespaces", "shaper"
  unsigned edits = 1000;              // of each client of a latency case
  unsigned repetitions = 5;           // joins, transfers, fleets behind a gateway
  std::vector<unsigned> clients = {1, 10, 100, 300, 1000};  // sizes of the fleets
  double fleet_seconds = 20;
  unsigned fleet_sites = 1;                  // places where a fleet builds
  std::vector<unsigned> fleet_levels = {0};  // of tiles beyond the bots' views, one after another
  std::vector<std::string> attacks;          // empty: all
  double attack_seconds = 8;        // of each attack, and of the phases before and after it
  unsigned attackers = 24;          // threads with a hostile client each
  unsigned attacker_addresses = 1;  // that they come from
  unsigned attack_bots = 20;        // honest clients under attack
  unsigned strangers = 5000;        // connections that never become players
  double siege_seconds = 600;       // of the windows of a siege together
  unsigned siege_bots = 100;        // honest clients in a siege
  unsigned gateway_bots = 200;      // of a fleet behind a gateway
  unsigned backup_mib = 1024;       // size of the world that is backed up
  unsigned backup_rounds = 5;       // windows with backups, and as many without
  std::uint64_t seed = 1;
  bool insecure = false;  // without encryption
  bool quick = false;     // small sizes, for tests on a busy machine
  std::string csv, json;  // files to write; empty: none
};

/// Adds the subcommand. `options` must outlive the parse.
CLI::App* add_net_command(CLI::App& app, NetOptions& options);

}  // namespace runstone::bench
