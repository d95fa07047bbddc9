// The real server program as the client starts it for a world on this computer.
#include "client/local/local_server.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "client/local/local_worlds.hpp"
#include "common/os/child_program.hpp"
#include "tests/integration/client/window/child_process.hpp"
#include "tests/support/core/shell_run.hpp"
#include "tests/support/core/temp_folder.hpp"

namespace runstone {
namespace {

using test::run_shell;
using test::ShellRun;
using test::TempFolder;
using test::wait_for;

constexpr std::chrono::seconds kLong{60};
const std::string kServer = RUNSTONE_SERVER_PROGRAM;
const std::string kClient = RUNSTONE_CLIENT_PROGRAM;

LocalServerConfig config_of(const std::string& folder) {
  return {folder, NewLocalWorld{"flat", 1}, PublicKey{1}, kServer};
}

std::unique_ptr<LocalServer> start(const LocalServerConfig& config) {
  auto server = LocalServer::start(config);
  INFO((server ? "" : server.error()));
  REQUIRE(server);
  return *std::move(server);
}

LocalServer::State wait_for_start(LocalServer& server) {
  wait_for(kLong, [&] { return server.poll() != LocalServer::State::starting; });
  return server.poll();
}

bool is_unlocked(const std::string& folder) {
  return run_shell(kServer + " compact --world '" + folder + "' --keep 1 2>&1").exit_code == 0;
}

}  // namespace

TEST_CASE("a local server makes a world, listens, and ends in order", "[integration]") {
  const TempFolder folder;
  const std::string world = folder / "worlds/my world";
  for (int round = 0; round < 2; ++round) {
    auto server = start(config_of(world));
    REQUIRE(wait_for_start(*server) == LocalServer::State::running);
    CHECK(server->port() != 0);
    server->request_stop();
    REQUIRE(wait_for(kLong, [&] { return server->poll() == LocalServer::State::ended; }));
    CHECK(server->failure_text().empty());
  }
  CHECK(list_local_worlds(folder / "worlds").size() == 1);
}

TEST_CASE("a local server that cannot start says why", "[integration]") {
  const TempFolder folder;
  LocalServerConfig config = config_of(folder / "world");
  SECTION("no world") {
    config.creation.reset();
    const auto server = LocalServer::start(config);
    REQUIRE_FALSE(server);
    CHECK(server.error() == folder / "world: holds no world");
  }
  SECTION("no program") {
    config.program = folder / "no-such-server";
    const auto server = LocalServer::start(config);
    REQUIRE_FALSE(server);
    CHECK_THAT(server.error(), Catch::EndsWith("cannot be started: No such file or directory"));
  }
  SECTION("no such generator") {
    config.creation->generator = "marzipan";
    auto server = start(config);
    CHECK(wait_for_start(*server) == LocalServer::State::ended);
    CHECK_THAT(server->failure_text(), Catch::Contains("marzipan"));
  }
  SECTION("the world is in use") {
    auto first = start(config);
    REQUIRE(wait_for_start(*first) == LocalServer::State::running);
    LocalServerConfig second_config = config;
    auto second = start(second_config);
    CHECK(wait_for_start(*second) == LocalServer::State::ended);
    INFO(second->failure_text());
    CHECK_FALSE(second->failure_text().empty());
    CHECK(first->poll() == LocalServer::State::running);
  }
  SECTION("a program that is no server") {
    config.program = "/bin/false";
    auto server = start(config);
    CHECK(wait_for_start(*server) == LocalServer::State::ended);
    CHECK_THAT(server->failure_text(), Catch::Contains("ended with exit code 1"));
  }
}

TEST_CASE("a local server that dies is reported", "[integration]") {
  const TempFolder folder;
  LocalServerConfig config = config_of(folder / "world");
  config.program = folder / "dying";
  std::ofstream(config.program) << "#!/bin/sh\nkill -9 $$\n";
  std::filesystem::permissions(config.program, std::filesystem::perms::owner_all);
  auto server = start(config);
  CHECK(wait_for_start(*server) == LocalServer::State::ended);
  CHECK_THAT(server->failure_text(), Catch::Contains("was ended by signal 9"));
}

TEST_CASE("a client that is killed takes its local server with it, and the world stays whole",
          "[integration]") {
  const TempFolder folder;
  const std::string world = folder / "data/runstone/worlds/home";
  std::ofstream(folder / "script")
      << "wait loaded\nset 0 70 0 1\nwait synced\nsay built\nwait 600\n";
  ChildProgram child;
  child.words = {"/bin/sh", "-c",
                 "exec env XDG_DATA_HOME=" + folder / "data" + " RUNSTONE_SERVER=" + kServer + " " +
                     kClient + " --local home --generator flat --seed 1 --no-render --script " +
                     folder / "script" + " >" + folder / "out" + " 2>&1"};
  const auto pid = start_program(std::move(child));
  REQUIRE(pid);
  const bool is_up = wait_for(kLong, [&] { return std::filesystem::exists(world + "/port"); });
  ::kill(*pid, SIGKILL);
  ::waitpid(*pid, nullptr, 0);
  REQUIRE(is_up);
  CHECK(wait_for(kLong, [&] { return is_unlocked(world); }));
}

TEST_CASE("a world that was built locally is there again the next time", "[integration]") {
  const TempFolder folder;
  const std::string client = "XDG_DATA_HOME=" + folder / "data" + " RUNSTONE_SERVER=" + kServer +
                             " " + kClient + " --no-render --local 'my home' --script ";
  std::ofstream(folder / "build") << "wait loaded\nset 3 70 3 brick\nwait synced\n";
  std::ofstream(folder / "look") << "wait loaded\nexpect 3 70 3 brick\n";
  const ShellRun built =
      run_shell(client + folder / "build" + " --generator flat --seed 7 2>&1 </dev/null");
  INFO(built.text);
  REQUIRE(built.exit_code == 0);
  const ShellRun seen = run_shell(client + folder / "look" + " 2>&1 </dev/null");
  INFO(seen.text);
  CHECK(seen.exit_code == 0);
  CHECK(std::filesystem::exists(folder / "data/runstone/key"));
}

}  // namespace runstone
