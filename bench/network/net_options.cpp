#include "bench/network/net_options.hpp"

#include <CLI/CLI.hpp>
#include <set>

#include "bench/network/attack.hpp"
#include "bench/network/message_flood.hpp"
#include "bench/network/strangers.hpp"
#include "bench/worlds/measured_worlds.hpp"

namespace runstone::bench {
namespace {

/// Sets the options that --quick changes and the command line does not name.
void apply_quick(const CLI::App& command, NetOptions& options) {
  if (!options.quick) return;
  if (command.count("--edits") == 0) options.edits = 100;
  if (command.count("--min-runs") == 0) options.repetitions = 1;
  if (command.count("--clients") == 0) options.clients = {1, 20};
  if (command.count("--crowd-seconds") == 0) options.fleet_seconds = 3;
  if (command.count("--gateway-bots") == 0) options.gateway_bots = 5;
  if (command.count("--attack-seconds") == 0) options.attack_seconds = 2;
  if (command.count("--strangers") == 0) options.strangers = 60;
  if (command.count("--siege-seconds") == 0) options.siege_seconds = 30;
  if (command.count("--backup-mib") == 0) options.backup_mib = 8;
  if (command.count("--backup-rounds") == 0) options.backup_rounds = 1;
}

std::set<std::string> attack_names() {
  std::set<std::string> out;
  for (const Attack& attack : all_attacks()) out.emplace(attack.name);
  for (const StrangerSort& sort : stranger_sorts()) out.emplace(sort.name);
  for (const MessageKind kind : client_kinds()) out.emplace(info_of(kind).name);
  return out;
}

void add_siege_options(CLI::App& command, NetOptions& options) {
  command
      .add_option("--siege-seconds", options.siege_seconds,
                  "of a siege: ten for each attack in turn, and thirty before and after them")
      ->capture_default_str()
      ->check(CLI::Range(20.0, 3600.0));
  command.add_option("--siege-bots", options.siege_bots, "honest clients in a siege")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
}

void add_gateway_options(CLI::App& command, NetOptions& options) {
  command
      .add_option("--gateway-bots", options.gateway_bots,
                  "bots that build through a gateway, and as many without")
      ->capture_default_str()
      ->check(CLI::Range(1, 10'000));
}

void add_backup_options(CLI::App& command, NetOptions& options) {
  command
      .add_option("--backup-mib", options.backup_mib, "size of the world that is backed up, in MiB")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000));
  command
      .add_option("--backup-rounds", options.backup_rounds,
                  "windows of --crowd-seconds with backups, and as many without")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
}

}  // namespace

CLI::App* add_net_command(CLI::App& app, NetOptions& options) {
  CLI::App* net = app.add_subcommand("net",
                                     "edits, joins, transfers and fleets over links with delay, "
                                     "jitter, rate and loss, and memory");
  std::set<std::string> profiles;
  for (const test::LinkProfile& profile : test::link_profiles()) profiles.emplace(profile.name);
  net->add_option("--experiments", options.experiments,
                  "which; all but siege, strangers, floods, backup and gateway by default")
      ->delimiter(',')
      ->check(CLI::IsMember(std::set<std::string>{"latency", "join", "transfer", "crowd", "attack",
                                                  "horizon", "memory", "siege", "strangers",
                                                  "floods", "backup", "gateway"}));
  net->add_option("--profiles", options.profiles, "links; all by default")
      ->delimiter(',')
      ->check(CLI::IsMember(profiles));
  net->add_option("--link", options.link, "what makes them; auto: namespaces where that is allowed")
      ->capture_default_str()
      ->check(CLI::IsMember(std::set<std::string>{"auto", "namespaces", "shaper"}));
  net->add_option("--worlds", options.worlds, "worlds to transfer; all by default")
      ->delimiter(',')
      ->check(CLI::IsMember(measured_world_names()));
  net->add_option("--luanti", options.luanti, "folder of a Luanti world")
      ->capture_default_str()
      ->check(CLI::ExistingDirectory);
  net->add_option("--edits", options.edits,
                  "edits of each of the two clients of a latency case, 50 a second")
      ->capture_default_str()
      ->check(CLI::Range(10, 1'000'000));
  net->add_option("--min-runs", options.repetitions, "joins and transfers of each sort")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  net->add_option("--clients", options.clients, "sizes of fleets")
      ->capture_default_str()
      ->delimiter(',')
      ->check(CLI::Range(1, 10'000));
  net->add_option("--crowd-seconds", options.fleet_seconds, "for which a fleet edits")
      ->capture_default_str()
      ->check(CLI::Range(1.0, 3600.0));
  net->add_option("--crowd-sites", options.fleet_sites, "places where a fleet builds")
      ->capture_default_str()
      ->check(CLI::Range(1, 10'000));
  net->add_option(
         "--crowd-levels", options.fleet_levels,
         "levels of tiles that a fleet sees beyond its chunks; each fleet is measured with "
         "each")
      ->capture_default_str()
      ->delimiter(',')
      ->check(CLI::Range(0, 8));
  net->add_option("--attacks", options.attacks,
                  "which attacks, strangers or floods; all by default")
      ->delimiter(',')
      ->check(CLI::IsMember(attack_names()));
  net->add_option("--attack-seconds", options.attack_seconds,
                  "of each attack, and before and after it")
      ->capture_default_str()
      ->check(CLI::Range(1.0, 600.0));
  net->add_option("--attackers", options.attackers, "hostile clients, or threads that make many")
      ->capture_default_str()
      ->check(CLI::Range(1, 64));
  net->add_option("--attacker-addresses", options.attacker_addresses,
                  "addresses that they come from, each of another /24; a server limits edits by "
                  "address too")
      ->capture_default_str()
      ->check(CLI::Range(1, 64));
  net->add_option("--attack-bots", options.attack_bots, "honest clients under attack")
      ->capture_default_str()
      ->check(CLI::Range(1, 200));
  net->add_option("--strangers", options.strangers, "connections that never become players")
      ->capture_default_str()
      ->check(CLI::Range(1, 15'000));
  add_gateway_options(*net, options);
  add_backup_options(*net, options);
  add_siege_options(*net, options);
  net->add_option("--seed", options.seed,
                  "draws losses, jitter, places of edits and what attackers do")
      ->capture_default_str();
  net->add_option("--csv", options.csv, "write all figures to this file");
  net->add_option("--json", options.json, "write all figures and targets to this file");
  net->add_flag("--insecure", options.insecure, "connections without encryption, to compare with");
  net->add_flag("--quick", options.quick,
                "100 edits, one join and transfer, fleets of 1 and 20 for 3 seconds, attacks of 2, "
                "60 strangers, a siege of 30, unless said otherwise");
  net->callback([net, &options] { apply_quick(*net, options); });
  return net;
}

}  // namespace runstone::bench
