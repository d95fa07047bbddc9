// PostgresServers: servers of one world in PostgreSQL, each in a process of its own. One owns the
// world, the others follow. Its tests need a PostgreSQL server, see scripts/check-postgres.
#pragma once
#include <catch2/catch.hpp>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/integration/server/app/server_process.hpp"
#include "tests/support/sql/temp_place.hpp"

namespace runstone::test {

struct PostgresServers {
  enum class Role { standby, alone };  // alone: without --standby

  TempPlace place;
  TempFolder folders;
  PostgresServers() { REQUIRE(place.is_postgres()); }

  /// Returns the folder of the server of this name.
  std::string folder(const std::string& name) const { return folders / name; }
  /// Starts a server with a folder of this name, and waits until it listens. `change`: changes its
  /// configuration.
  std::unique_ptr<ServerProcess> start(
      const std::string& name, Role role = Role::standby,
      const std::function<void(ServerConfig&)>& change = [](ServerConfig&) {}) const {
    auto server = std::make_unique<ServerProcess>([&] {
      ServerConfig config = quiet_config(folder(name));
      config.store = place.path();
      config.standby = role == Role::standby;
      config.player_address = "127.0.0.1";
      config.lease_s = 2;
      change(config);
      return config;
    });
    REQUIRE(server->port() != 0);
    return server;
  }
  /// Returns the clients' sequences of the log, by author, in the order of the log. Checks that the
  /// world is sound, and that epochs never become lower.
  std::map<AuthorId, std::vector<ClientSequence>> log() const {
    std::map<AuthorId, std::vector<ClientSequence>> edits;
    const auto store = open_world(place.path(), StoreAccess::read_only);
    REQUIRE(store.has_value());
    CHECK((*store)->check().has_value());
    Epoch epoch = 0;
    bool is_in_order = true;
    const auto read = (*store)->read_log(1, kSequenceMax, [&](const EditRecord& record) {
      is_in_order = is_in_order && record.version.epoch >= epoch;
      epoch = record.version.epoch;
      edits[record.op.author].push_back(record.op.seq);
      return true;
    });
    CHECK(read.has_value());
    CHECK(is_in_order);
    return edits;
  }
  /// Checks that the log has the author's edits 1 to `count`, each once and in order.
  void check_log(AuthorId author, ClientSequence count) const {
    std::vector<ClientSequence> all;
    for (ClientSequence seq = 1; seq <= count; ++seq) all.push_back(seq);
    CHECK(log()[author] == all);
  }
};

}  // namespace runstone::test
