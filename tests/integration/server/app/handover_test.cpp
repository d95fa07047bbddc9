// The owner of a world in PostgreSQL hands it over to another server by a command, and follows it. The
// cases need a PostgreSQL server, see scripts/check-postgres.
#include <algorithm>
#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "tests/integration/server/app/server_commands.hpp"
#include "tests/integration/server/app/server_process.hpp"
#include "tests/support/raw_client.hpp"
#include "tests/support/temp_place.hpp"

namespace runstone::test {
namespace {

using BuildClock = std::chrono::steady_clock;

/// A player in a thread of its own, who sends an edit when the one before has come back as a commit, and
/// offers it again after a Resume.
class SteadyBuilder {
 public:
  SteadyBuilder(const ServerProcess& server, std::uint8_t who) : client_(server.port()), who_(who) {
    client_.features = kFeatureResume;
    const auto accepted = client_.join(who, kInstance);
    REQUIRE(accepted.has_value());
    author_ = accepted->author;
    thread_ = std::thread([this] { run(); });
  }
  ~SteadyBuilder() {
    if (thread_.joinable()) stop();
  }
  SteadyBuilder(const SteadyBuilder&) = delete;
  SteadyBuilder& operator=(const SteadyBuilder&) = delete;

  void stop() {
    is_over_.store(true);
    thread_.join();
  }
  AuthorId author() const { return author_; }
  // After stop().
  bool has_failed() const { return has_failed_; }
  ClientSequence edits() const { return seq_; }
  std::size_t resumes() const { return resumes_; }
  std::chrono::milliseconds longest_wait() const {
    return std::chrono::duration_cast<std::chrono::milliseconds>(longest_);
  }

 private:
  static constexpr ClientInstance kInstance = 7;

  void send() {
    const auto n = static_cast<std::int32_t>(seq_);
    client_.send(EditRequest{seq_, 0, {SetVoxel{{n % 16, who_, n / 16 % 16}}, {}, 1}});
  }
  void run() {
    while (!is_over_.load()) {
      ++seq_;
      const auto sent = BuildClock::now();
      send();
      if (!waits_for_commit()) {
        has_failed_ = true;
        return;
      }
      longest_ = std::max(longest_, BuildClock::now() - sent);
      std::this_thread::sleep_for(std::chrono::milliseconds(3));
    }
    has_failed_ = !client_.sees_durable(last_);
  }
  bool waits_for_commit() {
    while (const auto message = client_.next(20'000)) {
      if (std::holds_alternative<Reject>(*message) || std::holds_alternative<Goodbye>(*message))
        return false;
      if (const auto* resume = std::get_if<Resume>(&*message)) {
        ++resumes_;
        client_.send(Resumed{});
        if (resume->resolved < seq_) send();
      }
      const auto* commit = std::get_if<Commit>(&*message);
      if (commit == nullptr) continue;
      for (const OrderedEdit& edit : commit->edits) {
        if (edit.op != OperationId{author_, kInstance, seq_}) continue;
        last_ = edit.seq;
        return true;
      }
    }
    return false;
  }

  RawClient client_;
  const std::uint8_t who_;
  AuthorId author_ = 0;
  std::atomic<bool> is_over_{false};
  ClientSequence seq_ = 0;
  Sequence last_ = 0;
  bool has_failed_ = false;
  std::size_t resumes_ = 0;
  BuildClock::duration longest_{};
  std::thread thread_;
};

struct HandoverServers {
  TempPlace place;
  TempFolder folders;
  HandoverServers() { REQUIRE(place.is_postgres()); }

  std::string folder(const std::string& name) const { return folders / name; }
  std::unique_ptr<ServerProcess> start(const std::string& name) const {
    auto server = std::make_unique<ServerProcess>([&] {
      ServerConfig config = quiet_config(folder(name));
      config.store = place.path();
      config.standby = true;
      config.player_address = "127.0.0.1";
      config.lease_s = 2;
      return config;
    });
    REQUIRE(server->port() != 0);
    return server;
  }
  /// Returns the clients' sequences of the log, by author. Checks that the world is sound.
  std::map<AuthorId, std::vector<ClientSequence>> log() const {
    std::map<AuthorId, std::vector<ClientSequence>> edits;
    const auto store = open_world(place.path(), StoreAccess::read_only);
    REQUIRE(store.has_value());
    CHECK((*store)->check().has_value());
    const auto read = (*store)->read_log(1, kSequenceMax, [&](const EditRecord& record) {
      edits[record.op.author].push_back(record.op.seq);
      return true;
    });
    CHECK(read.has_value());
    return edits;
  }
};

}  // namespace

TEST_CASE("an owner hands the world over and back while players build, and nothing is lost",
          "[.postgres-server]") {
  const HandoverServers cluster;
  const auto first = cluster.start("first");
  const auto second = cluster.start("second");
  const auto third = cluster.start("third");
  std::vector<std::unique_ptr<SteadyBuilder>> builders;
  for (const ServerProcess* server : {first.get(), second.get(), third.get()}) {
    builders.push_back(
        std::make_unique<SteadyBuilder>(*server, static_cast<std::uint8_t>(builders.size() + 1)));
  }
  // Servers that follow refuse the command, so the owner is the one that does not.
  std::vector<std::string> names{"first", "second", "third"};
  std::size_t handovers = 0;
  for (int i = 0; i < 40 && handovers < 6; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    const std::string& name = names[static_cast<std::size_t>(i) % names.size()];
    const Answer answer = control(cluster.folder(name), {"handover"});
    if (!answer.is_ok) {
      CHECK(answer.text.find("this server follows the owner") != std::string::npos);
      continue;
    }
    INFO(answer.text);
    CHECK(answer.text.find("another server owns the world now") != std::string::npos);
    ++handovers;
  }
  CHECK(handovers == 6);
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  std::string waits;
  for (const auto& builder : builders) {
    builder->stop();
    CHECK_FALSE(builder->has_failed());
    CHECK(builder->resumes() >= handovers);
    waits += " " + std::to_string(builder->longest_wait().count()) + " ms";
  }
  WARN("longest wait of an edit at each server, with six handovers:" << waits);
  CHECK(third->stop());
  CHECK(second->stop());
  CHECK(first->stop());
  const auto log = cluster.log();
  for (const auto& builder : builders) {
    std::vector<ClientSequence> all;
    for (ClientSequence seq = 1; seq <= builder->edits(); ++seq) all.push_back(seq);
    const auto mine = log.find(builder->author());
    REQUIRE(mine != log.end());
    CHECK(mine->second == all);
  }
}

TEST_CASE("of two commands at once one hands the world over, and both servers go on",
          "[.postgres-server]") {
  const HandoverServers cluster;
  const auto first = cluster.start("first");
  const auto second = cluster.start("second");
  SteadyBuilder builder(*first, 1);
  for (int i = 0; i < 100; ++i) {
    if (control(cluster.folder("first"), {"servers"}).text.find("\nserver ") != std::string::npos)
      break;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  std::array<Answer, 2> answers;
  {
    std::vector<std::thread> operators;
    for (Answer& answer : answers)
      operators.emplace_back([&] { answer = control(cluster.folder("first"), {"handover"}); });
    for (std::thread& one : operators) one.join();
  }
  CHECK(answers[0].is_ok != answers[1].is_ok);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  builder.stop();
  CHECK_FALSE(builder.has_failed());
  CHECK(builder.resumes() == 1);
  CHECK(first->stop());
  CHECK(second->stop());
  CHECK(cluster.log().at(builder.author()).size() == builder.edits());
}

TEST_CASE("an owner whose successor is gone owns the world again, and one alone keeps it",
          "[.postgres-server]") {
  const HandoverServers cluster;
  const auto first = cluster.start("first");
  const Answer alone = control(cluster.folder("first"), {"handover"});
  CHECK_FALSE(alone.is_ok);
  CHECK(alone.text.find("no other server follows this one") != std::string::npos);
  const auto second = cluster.start("second");
  SteadyBuilder builder(*first, 1);
  std::string servers;
  for (int i = 0; i < 100 && servers.find("\nserver ") == std::string::npos; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    servers = control(cluster.folder("first"), {"servers"}).text;
  }
  CAPTURE(servers);
  CHECK(servers.find("this server, the owner at 127.0.0.1:" + std::to_string(first->port())) == 0);
  CHECK(servers.find(" at 127.0.0.1:" + std::to_string(second->port())) != std::string::npos);
  second->pause();
  const Answer answer = control(cluster.folder("first"), {"handover"});
  CHECK_FALSE(answer.is_ok);
  CHECK(answer.text.find("this one owns it again") != std::string::npos);
  second->kill();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  builder.stop();
  CHECK_FALSE(builder.has_failed());
  CHECK(builder.resumes() == 1);
  CHECK(first->stop());
  CHECK(cluster.log().at(builder.author()).size() == builder.edits());
}

}  // namespace runstone::test
