// The example of the client as a library, run as a program against a server.
#include <catch2/catch.hpp>
#include <string>

#include "tests/integration/server/app/server_bench.hpp"
#include "tests/support/core/shell_run.hpp"

namespace runstone::test {

TEST_CASE("the example of the client meshes a world and its edit is ordered", "[examples]") {
  const TempFolder folder;
  auto server = start_server(quiet_config(folder / "world"), flat_creation());
  const ShellRun joined = run_shell(std::string(EXAMPLE_JOIN_AND_EDIT_PROGRAM) +
                                    " 127.0.0.1:" + std::to_string(server->port()) + " 2>&1");
  INFO(joined.text);
  CHECK(joined.exit_code == 0);
  CHECK(joined.text.find("the edit is number 1 of the world") != std::string::npos);
  CHECK(server->stop().digests.seq == 1);
  const ShellRun alone =
      run_shell(std::string(EXAMPLE_JOIN_AND_EDIT_PROGRAM) + " 127.0.0.1:1 2>&1");
  CHECK(alone.exit_code == 1);
  CHECK(alone.text.find("No server listens at 127.0.0.1:1") != std::string::npos);
}

}  // namespace runstone::test
