// NetOptions: what the command line of `runstone-bench net` says.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/bench/network/lab_link.hpp"

namespace CLI {
class App;
}

namespace runstone::bench {

struct NetOptions {
  std::vector<std::string> experiments = {"latency", "join",   "transfer",
                                          "crowd",   "attack", "memory"};
  std::vector<std::string> profiles;  // of the lab; empty: all
  std::vector<std::string> worlds;    // of the transfers; empty: all
  std::string luanti;                 // folder of the real world
  std::string link = "auto";          // namespaces where possible; or "namespaces", "shaper"
  unsigned edits = 1000;              // of each client of a latency case
  unsigned repetitions = 5;           // joins and transfers
  std::vector<unsigned> clients = {1, 10, 100, 300, 1000};  // of the crowds
  double fleet_seconds = 20;
  std::vector<std::string> attacks;  // empty: all
  double attack_seconds = 8;         // of each attack, and before and after it
  unsigned attackers = 8;            // threads with a hostile client each
  unsigned attack_bots = 20;         // who see what comes of it
  std::uint64_t seed = 1;
  bool quick = false;
  std::string csv, json;  // files; empty: none
};

/// Adds the subcommand and its options. `options` must outlive the parse; call finish_net_options() after it.
CLI::App* add_net_command(CLI::App& app, NetOptions& options);
/// Takes `--quick` into account. Call if the subcommand was parsed.
void finish_net_options(const CLI::App& command, NetOptions& options);

}  // namespace runstone::bench
