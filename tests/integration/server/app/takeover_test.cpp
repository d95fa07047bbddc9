// Servers of one world in PostgreSQL: one owns it, the others follow, and one of them takes over when it
// stops, is killed or stands still. The cases need a PostgreSQL server, see scripts/check-postgres.
#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "tests/integration/server/app/postgres_servers.hpp"
#include "tests/integration/server/app/server_commands.hpp"
#include "tests/support/net/raw_client.hpp"
#include "tests/support/sql/raw_sql.hpp"

namespace runstone::test {
namespace {

using Role = PostgresServers::Role;

VoxelPos voxel_of(ClientSequence seq) {
  const auto n = static_cast<std::int32_t>(seq);
  return {n % 16, n / 256 % 16, n / 16 % 16};
}

/// A player who builds on one server after the other.
class Builder {
 public:
  /// Joins in the epoch `epoch`, once there is a server with it, as join() does.
  void join_in(Epoch epoch, const ServerProcess& server) {
    for (int tries = 0; tries < 100; ++tries) {
      RawClient client(server.port());
      if (client.join(2, kInstance) && client.welcome.epoch == epoch) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    join(server);
    CHECK(this->epoch() == epoch);
  }
  /// Joins, and offers the edits again that may not be durable.
  void join(const ServerProcess& server) {
    client_ = std::make_unique<RawClient>(server.port());
    client_->features = kFeatureResume;
    const auto accepted = client_->join(1, kInstance);
    REQUIRE(accepted.has_value());
    CHECK(accepted->resolved >= durable_);
    author_ = accepted->author;
    for (ClientSequence seq = accepted->resolved + 1; seq <= sent_; ++seq) send(seq);
  }
  Epoch epoch() const { return client_->welcome.epoch; }
  /// Sends so many edits, of one voxel each.
  void build(ClientSequence edits) {
    for (; edits > 0; --edits) send(++sent_);
  }
  /// Waits until so many edits are durable. Nobody else edits the world.
  void wait_durable(Sequence edits) {
    while (durable_ < edits) {
      const auto message = client_->next_of<Durable>();
      REQUIRE(message.has_value());
      durable_ = message->seq;
    }
  }
  /// Waits until another server orders the edits of this session, in the epoch `epoch`, and offers it
  /// those that may not be durable. Returns false if the session ends.
  bool resumes_in(Epoch epoch) {
    std::vector<Message> seen;
    const auto resume = client_->next_of<Resume>(&seen);
    if (!resume) return false;
    for (const Message& message : seen) {
      if (const auto* durable = std::get_if<Durable>(&message))
        client_->welcome.epoch = std::max(client_->welcome.epoch, durable->epoch);
    }
    CHECK(this->epoch() == epoch);
    client_->send(Resumed{});
    for (ClientSequence seq = resume->resolved + 1; seq <= sent_; ++seq) send(seq);
    return true;
  }
  AuthorId author() const { return author_; }
  ClientSequence sent() const { return sent_; }

 private:
  static constexpr ClientInstance kInstance = 7;

  void send(ClientSequence seq) {
    const auto material = static_cast<Material>(1 + seq % 5);
    client_->send(EditRequest{seq, 0, {SetVoxel{voxel_of(seq)}, {}, material}});
  }

  std::unique_ptr<RawClient> client_;
  AuthorId author_ = 0;
  ClientSequence sent_ = 0;
  Sequence durable_ = 0;
};

}  // namespace

TEST_CASE("a standby takes a world over from a server that stops, and from one that is killed",
          "[.postgres-server]") {
  const PostgresServers cluster;
  Builder builder;
  const auto first = cluster.start("first", Role::alone);
  builder.join(*first);
  builder.build(300);
  builder.wait_durable(300);
  CHECK(first->stop());

  const auto second = cluster.start("second");
  builder.join(*second);
  CHECK(builder.epoch() == 2);
  builder.build(300);
  builder.wait_durable(310);
  second->kill();

  const auto third = cluster.start("third");
  builder.join_in(3, *third);
  builder.build(10);
  builder.wait_durable(610);
  CHECK(third->stop());
  cluster.check_log(builder.author(), builder.sent());
}

TEST_CASE("a player of a server that follows stays when the owner stops, and when it is killed",
          "[.postgres-server]") {
  const PostgresServers cluster;
  const auto first = cluster.start("first", Role::alone);
  const auto second = cluster.start("second");
  const auto third = cluster.start("third");
  Builder builder;
  builder.join(*third);
  CHECK(builder.epoch() == 1);
  builder.build(300);
  builder.wait_durable(100);  // others are under way
  SECTION("the owner stops") { CHECK(first->stop()); }
  SECTION("the owner is killed") { first->kill(); }
  CHECK(builder.resumes_in(2));
  builder.build(100);
  builder.wait_durable(400);
  CHECK(second->stop());
  CHECK(third->stop());
  cluster.check_log(builder.author(), builder.sent());
}

TEST_CASE(
    "a server that came too late to follow the owner leaves the world to one that has followed",
    "[.postgres-server]") {
  const int round = GENERATE(1, 2, 3);  // without this rule, either may be faster
  CAPTURE(round);
  // A server that follows looks often for two seconds after it has lost the owner, and then as often
  // as one that has just started.
  const auto keep_lease = [](ServerConfig& config) { config.lease_s = 5; };
  const PostgresServers cluster;
  const auto first = cluster.start("first", Role::standby, keep_lease);
  const auto second = cluster.start("second", Role::standby, keep_lease);
  Builder builder;
  builder.join(*second);
  builder.build(100);
  builder.wait_durable(100);
  // A server looks every 50 ms whether it follows the owner.
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  first->kill();
  const auto third = cluster.start("third", Role::standby, keep_lease);
  CHECK(builder.resumes_in(2));
  CHECK(control(cluster.folder("second"), {"servers"}).text.find("this server, the owner") == 0);
  CHECK(second->stop());
  CHECK(third->stop());
  cluster.check_log(builder.author(), builder.sent());
}

TEST_CASE("a player learns of the other server, which takes the player in when the first one stops",
          "[.postgres-server]") {
  const PostgresServers cluster;
  const auto first = cluster.start("first", Role::alone);
  RawClient client(first->port());
  client.features = kFeatureServerList;
  REQUIRE(client.join(1, 7).has_value());
  const auto second = cluster.start("second");
  const auto list = client.next_of<Servers>();
  REQUIRE(list.has_value());
  CHECK(list->servers.size() == 2);
  const std::vector<ServerEntry> others = others_of(*list);
  REQUIRE(others.size() == 1);
  CHECK(others[0].address == "127.0.0.1:" + std::to_string(second->port()));
  CHECK(first->stop());
  RawClient moved(second->port());
  moved.features = kFeatureServerList;
  REQUIRE(moved.join(1, 7).has_value());
  const auto rest = moved.next_of<Servers>();
  REQUIRE(rest.has_value());
  CHECK(rest->here != 0);
  CHECK(second->stop());
}

TEST_CASE("a server that stood still beyond its lease adds nothing to the log, and ends",
          "[.postgres-server]") {
  const PostgresServers cluster;
  Builder builder;
  const auto first = cluster.start("first", Role::alone);
  builder.join(*first);
  builder.build(2'000);
  builder.wait_durable(100);  // others are under way
  first->pause();

  const auto second = cluster.start("second");
  builder.join_in(2, *second);
  builder.build(50);
  first->resume();
  CHECK(first->fails());
  builder.wait_durable(2'050);
  CHECK(second->stop());
  cluster.check_log(builder.author(), builder.sent());
}

TEST_CASE("a server whose database drops its connections ends, and the next start has every edit",
          "[.postgres-server]") {
  const PostgresServers cluster;
  Builder builder;
  const auto first = cluster.start("first", Role::alone);
  builder.join(*first);
  builder.build(500);
  builder.wait_durable(50);
  raw_sql(cluster.place.path(),
          "SELECT count(pg_terminate_backend(pid, 5000)) FROM pg_stat_activity "
          "WHERE application_name = 'runstone'");
  builder.build(10);
  CHECK(first->fails());

  const auto again = cluster.start("first", Role::alone);
  builder.join(*again);
  builder.wait_durable(510);
  CHECK(again->stop());
  cluster.check_log(builder.author(), builder.sent());
}

}  // namespace runstone::test
