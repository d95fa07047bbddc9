// A whole server whose disk has no space: it is read-only until there is space again.
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/os/child_program.hpp"
#include "server/admin/control_program.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/integration/server/app/server_commands.hpp"
#include "tests/support/core/text_contains.hpp"
#include "tests/support/net/port_file.hpp"
#include "tests/support/net/raw_client.hpp"
#include "tests/support/sql/full_disk_vfs.hpp"

namespace runstone::test {
namespace {

EditRequest voxel(ClientSequence seq) {
  return {seq, 0, {SetVoxel{{static_cast<std::int32_t>(seq % 16), 1, 1}}, {}, 2}};
}

/// Sends edits from `seq` on until one is rejected, and returns the number of this one. Requires
/// that the reason is the full disk.
ClientSequence edit_until_rejected(RawClient& client, ClientSequence seq) {
  for (; seq < 100'000; ++seq) {
    client.send(voxel(seq));
    while (const auto message = client.next()) {
      if (const auto* reject = std::get_if<Reject>(&*message)) {
        CHECK(reject->client_seq == seq);
        REQUIRE(reject->reason == RejectReason::busy);
        if (reject->detail == "the world's disk is full or read-only") return seq;
        break;  // the world strand did not know the reason yet
      }
      if (std::holds_alternative<Commit>(*message)) break;
    }
  }
  FAIL("no edit was rejected");
  return 0;
}

/// Sends edits from `seq` on until one is accepted, and returns the number of this one.
ClientSequence edit_until_accepted(RawClient& client, ClientSequence seq) {
  for (; seq < 10'000'000; ++seq) {
    client.send(voxel(seq));
    while (const auto message = client.next()) {
      if (std::holds_alternative<Commit>(*message)) return seq;
      if (std::holds_alternative<Reject>(*message)) break;
    }
  }
  FAIL("no edit was accepted");
  return 0;
}

Sequence log_end(const std::string& folder) {
  return *(*open_world(folder, StoreAccess::read_only))->last_sequence();
}

/// The server program, the size of whose files can be limited.
class LimitedServer {
 public:
  explicit LimitedServer(const TempFolder& folder) : world_(folder / "world") {
    ChildProgram program;
    program.words = {RUNSTONE_SERVER_PROGRAM,
                     "--world",
                     world_,
                     "--create",
                     "--generator",
                     "flat",
                     "--edge",
                     "16",
                     "--listen",
                     "127.0.0.1:0",
                     "--port-file",
                     folder / "port",
                     "--messages-per-second",
                     "0",
                     "--builder-budget",
                     "unlimited",
                     "--disk-reserve-mib",
                     "0"};
    program.errors = ::open((folder / "log").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    const int errors = program.errors;
    const auto started = start_program(std::move(program));
    ::close(errors);
    REQUIRE(started.has_value());
    child_ = *started;
    port_ = port_in(folder / "port");
    REQUIRE(port_ != 0);
  }
  ~LimitedServer() {
    if (child_ <= 0) return;
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
  }
  LimitedServer(const LimitedServer&) = delete;
  LimitedServer& operator=(const LimitedServer&) = delete;

  std::uint16_t port() const { return port_; }
  /// From now on no file may become much larger than the largest file of the world is now, as with
  /// `ulimit -f`.
  void limit_files() {
    constexpr std::uintmax_t kRoomBytes = 64 * 1024;  // for some commits in the WAL
    std::uintmax_t largest = 0;
    for (const auto& file : std::filesystem::directory_iterator(world_)) {
      if (file.is_regular_file()) largest = std::max(largest, file.file_size());
    }
    REQUIRE(::prlimit(child_, RLIMIT_FSIZE, nullptr, &before_) == 0);
    const rlimit limit{largest + kRoomBytes, before_.rlim_max};
    REQUIRE(::prlimit(child_, RLIMIT_FSIZE, &limit, nullptr) == 0);
  }
  /// Takes limit_files() back.
  void allow_large_files() { REQUIRE(::prlimit(child_, RLIMIT_FSIZE, &before_, nullptr) == 0); }
  /// Stops the server, and returns how it ended.
  std::string stop() {
    ::kill(child_, SIGTERM);
    int status = 0;
    ::waitpid(child_, &status, 0);
    child_ = -1;
    return how_it_ended(status);
  }

 private:
  const std::string world_;
  pid_t child_ = -1;
  std::uint16_t port_ = 0;
  rlimit before_{};
};

ServerConfig edits_config(const std::string& world) {
  ServerConfig config = quiet_config(world);
  config.messages_per_second = 0;
  return config;
}

}  // namespace

TEST_CASE("a server whose disk fills up rejects edits, keeps the accepted ones and goes on later",
          "[integration]") {
  FullDiskVfs vfs;
  const TempFolder folder;
  {
    const auto server = start_server(edits_config(folder / "world"), flat_creation());
    RawClient client(server->port());
    REQUIRE(client.join(1).has_value());
    client.send(voxel(1));
    REQUIRE(client.sees_durable(1));
    vfs.fill();
    const ClientSequence rejected = edit_until_rejected(client, 2);
    // A ban does not wait for the disk. `control` hears that it is not saved, and more often than
    // there are connections.
    for (int i = 0; i < 20; ++i) {
      std::ostringstream out;
      const auto ban =
          control_server({folder / "world", {"ban", "203.0.113." + std::to_string(i)}}, out);
      REQUIRE(ban.has_value());
      CHECK(*ban == ControlEnd::unsaved);
      CHECK(contains(out.str(), "in force, not on disk yet: the world's disk is full"));
    }
    vfs.make_room();
    const ClientSequence accepted = edit_until_accepted(client, rejected + 1);
    CHECK(accepted > rejected);
    const StopReport report = server->stop();
    CHECK(report.is_clean);
    CHECK(report.state.lost_edits == 0);
    CHECK(report.error.empty());
  }
  const auto server = start_server(edits_config(folder / "world"), {});
  CHECK(contains(control(folder / "world", {"bans"}).text, "203.0.113.19"));
  CHECK(server->stop().is_clean);
}

TEST_CASE("a stop on a full disk says how many accepted edits are lost, and the log stays sound",
          "[integration]") {
  FullDiskVfs vfs;
  const TempFolder folder;
  ServerConfig config = edits_config(folder / "world");
  config.stop_s = 1;
  {
    const auto server = start_server(config, flat_creation());
    RawClient client(server->port());
    REQUIRE(client.join(1).has_value());
    client.send(voxel(1));
    REQUIRE(client.sees_durable(1));
    vfs.fill();
    edit_until_rejected(client, 2);
    const StopReport report = server->stop();
    CHECK_FALSE(report.is_clean);
    CHECK_FALSE(report.state.is_durable());
    CHECK_FALSE(report.state.has_failed);
    CHECK(report.state.lost_edits > 0);
    CHECK(stop_line(report).find("stopped unclean") == 0);
  }
  vfs.make_room();
  CHECK(log_end(folder / "world") == 1);
  const auto server = start_server(config, {});
  RawClient client(server->port());
  const auto accepted = client.join(1);
  REQUIRE(accepted.has_value());
  CHECK(accepted->resolved == 1);  // the client offers the others again
  client.send(voxel(2));
  CHECK(client.sees_durable(2));
}

TEST_CASE("for the server program a limit of the size of files is a full disk, and no edit is lost",
          "[integration]") {
  const TempFolder folder;
  LimitedServer server(folder);
  RawClient client(server.port());
  REQUIRE(client.join(1).has_value());
  client.send(voxel(1));
  REQUIRE(client.sees_durable(1));
  Sequence accepted_last = 0;
  client.on_body = [&](MessageKind kind, ByteView body) {
    const auto message = decode_message(Sender::server, kind, body, 16);
    REQUIRE(message.has_value());
    if (const auto* commit = std::get_if<Commit>(&*message))
      accepted_last = commit->edits.back().seq;
  };
  server.limit_files();
  const ClientSequence rejected = edit_until_rejected(client, 2);
  // It goes on without edits.
  client.send(View{1, {0, 0, 0}, 0, 0});
  CHECK(client.next_of<ChunkSnapshot>().has_value());
  server.allow_large_files();
  edit_until_accepted(client, rejected + 1);
  const Sequence accepted = accepted_last;
  CHECK(accepted > 1);
  CHECK(server.stop() == "ended with exit code 0");
  std::ifstream in(folder / "log");
  const std::string log{std::istreambuf_iterator<char>(in), {}};
  CAPTURE(log);
  CHECK(contains(log, "READ-ONLY: "));
  CHECK(contains(log, "File too large"));
  CHECK(log_end(folder / "world") >= accepted);
  const auto store = open_world(folder / "world", StoreAccess::read_write);
  REQUIRE(store.has_value());
  CHECK((*store)->check().has_value());
}

TEST_CASE("a server that starts below its disk reserve is read-only from the first edit on",
          "[integration]") {
  const TempFolder folder;
  ServerConfig config = edits_config(folder / "world");
  config.disk_reserve_mib = 1'000'000'000;
  const auto server = start_server(config, flat_creation());
  RawClient client(server->port());
  REQUIRE(client.join(1).has_value());
  client.send(voxel(1));
  const auto reject = client.next_of<Reject>();
  REQUIRE(reject.has_value());
  CHECK(*reject == Reject{1, RejectReason::busy, "the world's disk is full or read-only", 0});
  client.send(View{1, {0, 0, 0}, 0, 0});
  CHECK(client.next_of<ChunkSnapshot>().has_value());
  CHECK(server->stop().is_clean);
}

}  // namespace runstone::test
