// The example bot, run as a program against a server.
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cstdlib>

#include "tests/integration/server/app/server_bench.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

int exit_code(const std::string& command) {
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

TEST_CASE("the example bot joins a server and its edit is ordered", "[examples]") {
  const TempFolder folder;
  auto server = start_server(quiet_config(folder / "world"), flat_creation());
  CHECK(exit_code(std::string(EXAMPLE_BOT_PROGRAM) + " 127.0.0.1 " +
                  std::to_string(server->port()) + " >/dev/null") == 0);
  CHECK(server->stop().digests.seq == 1);
}

TEST_CASE("the example bot explains its command line", "[examples]") {
  CHECK(exit_code(std::string(EXAMPLE_BOT_PROGRAM) + " localhost 2>/dev/null") == 2);
}
