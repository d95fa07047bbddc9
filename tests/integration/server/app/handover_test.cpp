// The owner of a world in PostgreSQL hands it over to another server by a command, and follows it. The
// cases need a PostgreSQL server, see scripts/check-postgres.
#include <algorithm>
#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <memory>
#include <sstream>
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

/// Waits until a server follows the owner, whose folder has this name. Returns what the owner lists
/// then.
std::string wait_for_follower(const PostgresServers& cluster, const std::string& owner) {
  std::string servers;
  for (int i = 0; i < 100 && servers.find("\nserver ") == std::string::npos; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    servers = control(cluster.folder(owner), {"servers"}).text;
  }
  return servers;
}

}  // namespace

TEST_CASE("an owner hands the world over and back while players build, and nothing is lost",
          "[.postgres-server]") {
  const PostgresServers cluster;
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
  for (const auto& builder : builders) cluster.check_log(builder->author(), builder->edits());
}

TEST_CASE("of two commands at once one hands the world over, and both servers go on",
          "[.postgres-server]") {
  const PostgresServers cluster;
  const auto first = cluster.start("first");
  const auto second = cluster.start("second");
  SteadyBuilder builder(*first, 1);
  wait_for_follower(cluster, "first");
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
  cluster.check_log(builder.author(), builder.edits());
}

TEST_CASE("an owner whose successor is gone owns the world again, and one alone keeps it",
          "[.postgres-server]") {
  const PostgresServers cluster;
  const auto first = cluster.start("first");
  const Answer alone = control(cluster.folder("first"), {"handover"});
  CHECK_FALSE(alone.is_ok);
  CHECK(alone.text.find("no other server follows this one") != std::string::npos);
  const auto second = cluster.start("second");
  SteadyBuilder builder(*first, 1);
  const std::string servers = wait_for_follower(cluster, "first");
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
  cluster.check_log(builder.author(), builder.edits());
}

TEST_CASE("an owner that was started without --standby keeps the world", "[.postgres-server]") {
  const PostgresServers cluster;
  const auto first = cluster.start("first", PostgresServers::Role::alone);
  const auto second = cluster.start("second");
  wait_for_follower(cluster, "first");
  const Answer answer = control(cluster.folder("first"), {"handover"});
  CHECK_FALSE(answer.is_ok);
  CHECK(answer.text.find("without --standby") != std::string::npos);
  CHECK(control(cluster.folder("first"), {"servers"}).text.find("this server, the owner") == 0);
  CHECK(second->stop());
  CHECK(first->stop());
}

TEST_CASE("an owner that is stopped while it hands the world over ends in order, and loses nothing",
          "[.postgres-server]") {
  const auto delay = std::chrono::milliseconds(GENERATE(0, 4, 12, 40));
  CAPTURE(delay.count());
  const PostgresServers cluster;
  const auto first = cluster.start("first");
  const auto second = cluster.start("second");
  const auto third = cluster.start("third");
  SteadyBuilder builder(*third, 1);
  wait_for_follower(cluster, "first");
  // The server may end before it has answered.
  std::thread an_operator([&] {
    std::ostringstream out;
    (void)control_server({cluster.folder("first"), {"handover"}}, out, read_new_password);
  });
  std::this_thread::sleep_for(delay);
  CHECK(first->stop());
  an_operator.join();
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  builder.stop();
  CHECK_FALSE(builder.has_failed());
  CHECK(builder.resumes() >= 1);
  CHECK(second->stop());
  CHECK(third->stop());
  cluster.check_log(builder.author(), builder.edits());
}

TEST_CASE(
    "an owner whose log fails while it hands the world over ends, and the next owner has all edits",
    "[.postgres-server]") {
  constexpr ClientSequence kEdits = 160;
  const PostgresServers cluster;
  const auto allow_large_edits = [](ServerConfig& config) {
    config.edit_volume_max = 1'000'000'000;
  };
  const auto first = cluster.start("first", PostgresServers::Role::standby, allow_large_edits);
  // The database refuses the last edit, of the first server only.
  const std::string made = raw_sql(
      cluster.place.path(),
      "CREATE TABLE refused AS SELECT pid FROM pg_stat_activity WHERE application_name = 'runstone'; "
      "CREATE FUNCTION refuse() RETURNS trigger AS $$ BEGIN "
      "IF NEW.client_seq = 160 AND pg_backend_pid() IN (SELECT pid FROM refused) "
      "THEN RAISE EXCEPTION 'refused by a test'; END IF; RETURN NEW; END $$ LANGUAGE plpgsql; "
      "CREATE TRIGGER refuse BEFORE INSERT ON edit_log FOR EACH ROW EXECUTE FUNCTION refuse()");
  REQUIRE(made.find("ERROR") == std::string::npos);
  const auto second = cluster.start("second", PostgresServers::Role::standby, allow_large_edits);
  wait_for_follower(cluster, "first");
  RawClient client(first->port());
  client.features = kFeatureChat;
  const auto accepted = client.join(1, 7);
  REQUIRE(accepted.has_value());
  // Most of these large edits wait for a second or more (LargeEditPace). The handover orders them at
  // once.
  for (ClientSequence seq = 1; seq <= kEdits; ++seq)
    client.send(EditRequest{seq, 0, {FillBox{{{0, 0, 0}, {600, 15, 600}}}, {}, 1}});
  client.send(ChatRequest{"sent"});
  while (const auto lines = client.next_of<ChatLines>()) {
    if (lines->lines.back().text == "sent") break;  // the owner has all edits
  }
  const Answer answer = control(cluster.folder("first"), {"handover"});
  CHECK_FALSE(answer.is_ok);
  INFO(answer.text);
  CHECK(answer.text.find("not all edits could be written to the log") != std::string::npos);
  CHECK(first->fails());
  RawClient again(second->port());
  const auto resumed = again.join(1, 7);
  REQUIRE(resumed.has_value());
  CHECK(resumed->resolved == kEdits);  // the second server was sent all of them
  CHECK(second->stop());
  cluster.check_log(accepted->author, kEdits);
}

}  // namespace runstone::test
