// The mode --materials of the real client program, against a server on loopback.
#include <catch2/catch.hpp>
#include <string>

#include "client/app/material_list.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/support/core/shell_run.hpp"

namespace runstone::test {
namespace {

/// Runs the client with these arguments and returns its standard output.
ShellRun run_client(const std::string& arguments) {
  return run_shell(std::string(RUNSTONE_CLIENT_PROGRAM) + " " + arguments + " 2>/dev/null");
}

}  // namespace

TEST_CASE("the client lists the materials of a server's world, then ends", "[materials]") {
  const TempFolder folder;
  const auto server = start_server(quiet_config(folder.path()), flat_creation());
  const ShellRun out =
      run_client("--connect 127.0.0.1:" + std::to_string(server->port()) + " --materials");
  CHECK(out.exit_code == 0);
  CHECK(out.text == material_list(default_material_table()));
}

TEST_CASE("a list of materials without a server ends with exit code 2", "[materials]") {
  const ShellRun out = run_client("--connect 127.0.0.1:1 --materials --reconnect-seconds 0.2");
  CHECK(out.exit_code == 2);
  CHECK(out.text.empty());
}

}  // namespace runstone::test
