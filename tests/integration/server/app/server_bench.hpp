// ServerBench: a server on a free loopback port with its own world folder, for integration tests.
#pragma once
#include <catch2/catch.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "server/app/server.hpp"
#include "server/runtime/logging.hpp"
#include "server/store/store.hpp"
#include "tests/support/core/temp_folder.hpp"

namespace runstone::test {

/// Returns a configuration without the limits of what players may cost.
inline ServerConfig quiet_config(const std::string& world) {
  start_logging(LogLevel::error);
  ServerConfig config;
  config.world = world;
  config.listen = "127.0.0.1:0";
  config.log_level = LogLevel::error;
  config.builder_budget = {};
  config.chunk_loads_per_second = 0;
  config.budgets_per_address = 0;
  config.sessions_per_key = config.sessions_per_address = config.names_per_address = 0;
  config.connections_per_second = 0;
  config.stop_s = 300;          // tests compare snapshots after a stop, also on a slow machine
  config.disk_reserve_mib = 0;  // and run on a nearly full one
  return config;
}

inline WorldCreation flat_creation() {
  WorldCreation creation;
  creation.generator = "flat";
  creation.seed = 1;
  creation.edge = 16;
  return creation;
}
inline WorldCreation terrain_creation() {
  WorldCreation creation;
  creation.generator = "terrain";
  creation.edge = 16;
  creation.seed = 5;
  return creation;
}

/// Requires the start to succeed.
inline std::unique_ptr<Server> start_server(const ServerConfig& config,
                                            const WorldCreation& creation,
                                            bool accept_losses = false) {
  auto server = Server::start(config, creation, [] {}, {}, accept_losses);
  INFO((server ? std::string() : server.error()));
  REQUIRE(server.has_value());
  return *std::move(server);
}

/// Waits until the log of a running world has this many records on disk, for at most a minute.
/// Returns false if it has fewer.
inline bool reaches(const std::string& world, Sequence records) {
  for (int i = 0; i < 6'000; ++i) {
    const auto store = open_world(world, StoreAccess::read_only);
    if (store) {
      const auto last = (*store)->last_sequence();
      if (last && *last >= records) return true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

}  // namespace runstone::test
