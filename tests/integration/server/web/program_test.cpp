#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "common/os/child_program.hpp"
#include "tests/integration/server/web/web_program.hpp"
#include "tests/support/core/shell_run.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/net/web_peer.hpp"

namespace runstone::test {
namespace {

const std::string kWeb = RUNSTONE_WEB_PROGRAM;

TEST_CASE("the gateway runs as a program, also without a server, until it is told to stop",
          "[integration]") {
  const TempFolder folder;
  ChildProgram program;
  program.words = {kWeb,
                   "--listen",
                   "127.0.0.1:0",
                   "--port-file",
                   folder / "port",
                   "--gateway-socket",
                   folder / "web.sock",
                   "--title",
                   "Valley"};
  program.errors = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  const int null = program.errors;
  const auto child = start_program(std::move(program));
  ::close(null);
  REQUIRE(child.has_value());
  const std::uint16_t port = port_in(folder / "port");
  {
    WebPeer peer(port);
    const HttpReply page = peer.get("/");
    CHECK(page.status == 200);
    CHECK(page.body.find("<h1>Valley</h1>") != std::string::npos);
    CHECK(page.body.find("not running, or it is restarting") != std::string::npos);
  }
  ::kill(*child, SIGTERM);
  int status = 0;
  REQUIRE(::waitpid(*child, &status, 0) == *child);
  CHECK(how_it_ended(status) == "ended with exit code 0");
}

TEST_CASE("a gateway that may open few files admits fewer connections and says so",
          "[integration]") {
  const ShellRun none = run_shell("ulimit -n 60; exec " + kWeb + " --listen 127.0.0.1:0 2>&1");
  CHECK(none.exit_code == 2);
  CHECK(none.text.find("see ulimit -Hn") != std::string::npos);
  const TempFolder folder;
  const std::string errors = folder / "errors";
  // The soft and the hard limit: room for 18 connections.
  ChildProgram program;
  program.words = {"/bin/sh",
                   "-c",
                   "ulimit -n 100; exec \"$0\" \"$@\" 2>\"" + errors + "\"",
                   kWeb,
                   "--listen",
                   "127.0.0.1:0",
                   "--port-file",
                   folder / "port",
                   "--gateway-socket",
                   folder / "web.sock"};
  const auto child = start_program(std::move(program));
  REQUIRE(child.has_value());
  const std::uint16_t port = port_in(folder / "port");
  std::vector<std::unique_ptr<WebPeer>> idle;
  for (int i = 0; i < 300; ++i) {
    idle.push_back(std::make_unique<WebPeer>(port, 0x7f010001 + static_cast<std::uint32_t>(i)));
  }
  {
    WebPeer peer(port);
    CHECK(peer.get("/").status == 200);
    const HttpReply metrics = peer.get("/metrics");
    CHECK(metrics.body.find("\nrunstone_web_accepts_failed 0\n") != std::string::npos);
    CHECK(metrics.body.find("\nrunstone_web_connections_open 18\n") != std::string::npos);
  }
  ::kill(*child, SIGHUP);  // without a certificate it does nothing but say so
  {
    WebPeer peer(port);
    CHECK(peer.get("/").status == 200);
  }
  ::kill(*child, SIGTERM);
  int status = 0;
  REQUIRE(::waitpid(*child, &status, 0) == *child);
  CHECK(how_it_ended(status) == "ended with exit code 0");
  std::ifstream in(errors);
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  CHECK(text.find("sockets_max=1024 needs 2112 open files, and the hard limit is 100: sockets_max "
                  "is 18 instead") != std::string::npos);
  CHECK(text.find("there is no certificate to read again") != std::string::npos);
}

TEST_CASE("a line of the gateway's log that cannot be written is counted, and later lines appear",
          "[integration]") {
  const TempFolder folder;
  WebProgram program(folder);
  const std::string metric = "\nrunstone_web_log_lines_dropped ";
  const auto counts = [&](const std::string& lines) {
    WebPeer peer(program.port());
    for (int i = 0; i < 200; ++i) {
      if (peer.get("/metrics").body.find(metric + lines + "\n") != std::string::npos) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return false;
  };
  // No server answers. The first page that asks for its counters logs this once, before the log is
  // full.
  CHECK(counts("0"));
  const std::string line = "there is no certificate to read again\n";
  program.fill_log();
  program.hang_up();
  CHECK(counts("1"));
  CHECK(program.log().find(line) == std::string::npos);
  program.make_room_in_log();
  program.hang_up();
  for (int i = 0; i < 1'000 && program.log().find(line) == std::string::npos; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  CHECK(program.log().find("runstone-web: " + line) != std::string::npos);
  CHECK(counts("1"));
}

TEST_CASE("the command line of the gateway names what is wrong with it", "[integration]") {
  const auto run = [](const std::string& flags) { return run_shell(kWeb + " " + flags + " 2>&1"); };
  const ShellRun wrong = run("--sockets-max many");
  CHECK(wrong.exit_code == 2);
  CHECK(wrong.text.find("--sockets-max: sockets_max = \"many\"") != std::string::npos);
  CHECK(run("--no-such-flag").exit_code == 2);
  CHECK(run("--config /nowhere/web.toml").exit_code == 2);
  CHECK(run("--listen 0.0.0.0:0").text.find("without a certificate") != std::string::npos);
  const ShellRun printed = run("--print-config --idle-s 90 --i-know");
  CHECK(printed.exit_code == 0);
  CHECK(printed.text.find("idle_s = 90  #") != std::string::npos);
  CHECK(printed.text.find("i_know = true  #") != std::string::npos);
}

}  // namespace
}  // namespace runstone::test
