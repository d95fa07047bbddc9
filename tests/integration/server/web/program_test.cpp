#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <fstream>
#include <string>
#include <thread>

#include "common/os/child_program.hpp"
#include "tests/integration/server/web/web_peer.hpp"
#include "tests/support/shell_run.hpp"
#include "tests/support/temp_folder.hpp"

namespace runstone::test {
namespace {

const std::string kWeb = RUNSTONE_WEB_PROGRAM;

/// Reads the port that a program writes, for at most a minute. Returns 0 if it wrote none.
std::uint16_t port_in(const std::string& file) {
  for (int i = 0; i < 6'000; ++i) {
    int port = 0;
    if (std::ifstream(file) >> port) return static_cast<std::uint16_t>(port);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return 0;
}

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
