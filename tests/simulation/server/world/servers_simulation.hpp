// ServersSimulation: three servers of one world, their database and players at each of them, in
// virtual time. Servers are killed, stand still for longer than their lease, are stopped by their
// operators, hand the world over, and are cut off from each other and from the database; the
// database ends all connections, or its disk is full; clocks of machines jump. Afterwards the log
// must have each durable edit once, and all servers and replicas must agree.
#pragma once
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/simulation/client/session/final_check.hpp"
#include "tests/simulation/server/world/sim_process.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {

struct ServersOptions {
  std::optional<Protection> without = std::nullopt;
  bool owner_pauses = false;  // half of the faults: the owner stands still
  bool tells = false;  // what happens to the servers is written to standard output, a line each
};

class ServersSimulation {
 public:
  /// How often each fault was made, and how many edits and chunks the final checks compared.
  struct Counts {
    std::uint64_t steps = 0, kills = 0, pauses = 0, stops = 0, cuts = 0, silences = 0;
    std::uint64_t database_cuts = 0, database_restarts = 0, full_disks = 0, clock_jumps = 0;
    std::uint64_t handovers = 0;
    std::uint64_t owners = 0;  // of the world, one after the other
    std::uint64_t edits = 0, chunks = 0, rejected = 0, unexplained = 0;
  };

  /// Adds to `counts` what it does.
  ServersSimulation(std::uint64_t seed, Counts& counts, const ServersOptions& options = {})
      : options_(options), counts_(counts), rng_(seed), database_(time_, options.without) {
    meta_.chunk_edge = kSimEdge;
    for (unsigned i = 0; i < kServers; ++i) {
      const std::string address = "server" + std::to_string(i) + ":4747";
      servers_.push_back(std::make_unique<SimProcess>(
          time_, rng_, world_config(), database_, meta_, address,
          [this](const std::string& wanted) { return find(wanted); },
          [this](const std::string& what) { tell(what); }));
      servers_.back()->launch();
    }
    for (unsigned i = 0; i < kPlayers; ++i) {
      clients_.push_back(std::make_unique<SimClient>(
          time_, rng_, [this](SimEnd client) { return dial(std::move(client)); }, i + 1));
    }
    time_.run_until(time_.now() + 3'000'000);
  }

  /// Performs `steps` random actions, heals everything, and waits until nothing is in flight.
  /// Throws SimFault if the log is harmed, or if the world does not come to rest.
  void run(std::uint64_t steps) {
    for (std::uint64_t step = 0; step < steps; ++step) {
      time_.run_until(time_.now() + rng_.between(1'000, 120'000));
      act();
      see_owner();
    }
    counts_.steps += steps;
    heal();
    time_.run_until(time_.now() + kStallUsMax);
    come_to_rest();
    build_in_peace();
  }

  FinalCheck check() {
    FinalCheck r;
    r.edits = database_.log().size();
    std::vector<WorldServer*> worlds;
    for (const auto& server : servers_) worlds.push_back(&server->world());
    r.check_exactly_once(database_.log(), clients_);
    r.check_voxels(database_.log(), worlds, clients_);
    r.check_heights(database_.log(), world_config().heights, clients_);
    check_unseen(r);
    for (const auto& client : clients_)
      r.expect(client->replica().counters().drifted == 0, "a replica has drifted");
    counts_.edits += r.edits;
    counts_.chunks += r.chunks;
    counts_.rejected += r.rejected;
    counts_.unexplained += r.unknown;
    return r;
  }

 private:
  static constexpr unsigned kServers = 3;
  static constexpr unsigned kPlayers = 5;
  static constexpr TimeUs kStallUsMax = 2'500'000;  // of a connection, with all that follows it

  static WorldConfig world_config() {
    WorldConfig config;
    config.may_be_followed = true;
    config.chunk_edge = kSimEdge;
    config.heights = {-24, 30};
    config.materials = default_material_table();
    config.world_id = sample_meta().world_id;
    config.server_keys = key_pair_of(KeySeed{7});
    config.snapshots.edits_max = 100;
    config.snapshots.interval_us = 5'000'000;
    config.snapshots.slice_chunks = 5;
    config.memory.idle_bytes_max = 20'000;
    return config;
  }

  void tell(const std::string& what) const {
    if (!options_.tells) return;
    std::cout << std::fixed << std::setprecision(3) << static_cast<double>(time_.now()) / 1e6 << ' '
              << what << std::endl;
  }
  void come_to_rest() {
    const TimeUs give_up_us = time_.now() + 300'000'000;
    while (!is_at_rest() && time_.now() < give_up_us) {
      time_.run_until(time_.now() + 1'000'000);
      see_owner();
    }
    // The last messages of the servers are still on their way to the players.
    time_.run_until(time_.now() + 1'000'000);
    if (!is_at_rest()) throw SimFault("the world does not come to rest: " + state());
  }
  /// Lets each player make an edit while nothing fails. Throws SimFault unless all are in the log.
  void build_in_peace() {
    const Sequence before = database_.last();
    for (std::int32_t i = 0; const auto& client : clients_)
      client->edit({SetVoxel{{++i, 1, 1}}, {}, 1});
    come_to_rest();
    if (database_.last() != before + clients_.size())
      throw SimFault("nothing fails any more, and edits of the players are not in the log");
  }

  /// Checks that the log has each edit whose answer its client has missed, or that a server has
  /// rejected it.
  void check_unseen(FinalCheck& r) const {
    for (const auto& client : clients_) {
      const AuthorId author = client->session().author();
      for (const ClientSequence seq : client->unseen()) {
        r.expect(
            database_.has({author, client->instance(), seq}) || database_.was_rejected(author, seq),
            "an edit is not in the log, and no server has rejected it, client seq " +
                std::to_string(seq));
      }
    }
  }

  SimProcess* find(const std::string& address) {
    for (const auto& server : servers_) {
      if (server->address() == address) return server.get();
    }
    return nullptr;
  }
  /// Connects a player with a server that takes connections.
  std::shared_ptr<SimConnection> dial(SimEnd client) {
    SimProcess& server = any_server();
    return server.listens() ? server.accept(player_faults_, std::move(client)) : nullptr;
  }
  SimProcess& any_server() { return *servers_[rng_.below(kServers)]; }
  /// Returns any server if nobody owns the world.
  SimProcess& owner() {
    const auto found = std::ranges::find_if(servers_, [](const auto& s) { return s->is_owner(); });
    return found == servers_.end() ? any_server() : **found;
  }

  void act() {
    const std::uint64_t what = rng_.below(1000);
    SimClient& client = *clients_[rng_.below(kPlayers)];
    if (what < 3) return client.cut();
    if (what < 20) {
      return client.look({1,
                          {rng_.between(-1, 1), rng_.between(-1, 1), rng_.between(-1, 1)},
                          static_cast<std::uint8_t>(1 + rng_.below(2)),
                          static_cast<std::uint8_t>(rng_.below(2))});
    }
    if (what < 45)
      return options_.owner_pauses && rng_.below(2) == 0 ? pause(owner()) : harm(any_server());
    client.edit(random_edit_near(rng_, {-8, -8, -8}, Extent::cube(kSimEdge)));
  }
  void heal_later(TimeUs longest_us, std::function<void()> heal) {
    time_.after(rng_.between(100'000, static_cast<std::int32_t>(longest_us)), std::move(heal));
  }
  void pause(SimProcess& server) {
    if (server.is_paused()) return;
    ++counts_.pauses;
    server.pause();
    heal_later(12'000'000, [&server] { server.resume(); });
  }
  void harm(SimProcess& server) {
    switch (rng_.below(10)) {
      case 0:
        if (!server.running()) return;
        ++counts_.kills;
        return server.kill();
      case 1:
        return pause(server);
      case 2:
        ++counts_.stops;
        return server.stop();
      case 3:
        ++counts_.database_cuts;
        server.is_database_cut = true;
        return heal_later(9'000'000, [&server] { server.is_database_cut = false; });
      case 4:
        ++counts_.silences;
        server.peer_faults.delay_us_max = 8'000'000;
        return heal_later(8'000'000, [&server] { server.peer_faults = LinkFaults{}; });
      case 5:
        ++counts_.cuts;
        return server.cut_owner_link();
      case 6:
        ++counts_.clock_jumps;
        server.utc_offset_us = rng_.between(-1'000, 1'000) * std::int64_t{1'000'000};
        return;
      case 7:
        ++counts_.full_disks;
        database_.is_disk_full = true;
        return heal_later(8'000'000, [this] { database_.is_disk_full = false; });
      case 8:
        for (const auto& one : servers_) counts_.handovers += one->hand_over() ? 1 : 0;
        return;
      default:
        ++counts_.database_restarts;
        database_.restart();
        for (const auto& one : servers_) one->lose_database_connections();
    }
  }
  void heal() {
    database_.is_disk_full = false;
    player_faults_.stalls_per_1000 = 0;
    for (const auto& server : servers_) {
      server->is_database_cut = false;
      server->peer_faults = LinkFaults{};
      server->peer_faults.stalls_per_1000 = 0;
      server->resume();
    }
  }
  void see_owner() {
    if (const auto owner = database_.owner(); owner && owner->term != term_seen_) {
      term_seen_ = owner->term;
      ++counts_.owners;
    }
  }

  bool is_at_rest() const {
    const auto follows_all = [&](const auto& server) {
      return server->running() && server->world().cluster().is_live() &&
             server->world().order().head() == database_.last() &&
             server->world().order().durable() == database_.last();
    };
    return std::ranges::count_if(servers_, [](const auto& s) { return s->is_owner(); }) == 1 &&
           std::ranges::all_of(servers_, follows_all) &&
           std::ranges::all_of(clients_, [](const auto& client) { return client->is_idle(); });
  }
  std::string state() const {
    std::string text = "log=" + std::to_string(database_.last());
    for (const auto& server : servers_) {
      text += "; " + server->address();
      if (!server->running()) {
        text += " does not run";
        continue;
      }
      text += std::string(server->is_owner() ? " owns" : " follows") +
              " head=" + std::to_string(server->world().order().head()) +
              " durable=" + std::to_string(server->world().order().durable()) +
              (server->world().cluster().is_live() ? "" : " not live");
    }
    for (const auto& client : clients_) {
      if (client->is_idle()) continue;
      SimClient& busy = *client;
      text += "; a player open=" + std::to_string(int{busy.session().is_open()}) +
              " loaded=" + std::to_string(int{busy.session().loaded()}) +
              " local edits=" + std::to_string(busy.replica().local_edits().all().size()) +
              " awaited=" + std::to_string(busy.replica().awaiting_count());
    }
    return text;
  }

  const ServersOptions options_;
  Counts& counts_;
  VirtualTime time_;
  SplitMix64 rng_;
  ModelDatabase database_;
  WorldMeta meta_ = sample_meta();
  LinkFaults player_faults_;
  std::vector<std::unique_ptr<SimProcess>> servers_;
  FinalCheck::Clients clients_;
  LeaseTerm term_seen_ = 0;
};

}  // namespace runstone::test
