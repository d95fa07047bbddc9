// The mode --materials of the real client program, against a server on loopback.
#include <sys/wait.h>

#include <array>
#include <catch2/catch.hpp>
#include <cstdio>
#include <string>

#include "client/app/material_list.hpp"
#include "tests/integration/server/app/server_bench.hpp"

namespace runstone::test {
namespace {

struct Output {
  std::string text;
  int exit_code = -1;
};

/// Runs the client with these arguments and returns its standard output.
Output run_client(const std::string& arguments) {
  Output out;
  const std::string command =
      std::string(RUNSTONE_CLIENT_PROGRAM) + " " + arguments + " 2>/dev/null";
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::array<char, 4096> buffer{};
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe))
    out.text.append(buffer.data(), count);
  const int status = ::pclose(pipe);
  if (WIFEXITED(status)) out.exit_code = WEXITSTATUS(status);
  return out;
}

}  // namespace

TEST_CASE("the client lists the materials of a server's world, then ends", "[materials]") {
  const TempFolder folder;
  const auto server = start_server(quiet_config(folder.path()), flat_creation());
  const Output out =
      run_client("--connect 127.0.0.1:" + std::to_string(server->port()) + " --materials");
  CHECK(out.exit_code == 0);
  CHECK(out.text == material_list(default_material_table()));
}

TEST_CASE("a list of materials without a server ends with exit code 2", "[materials]") {
  const Output out = run_client("--connect 127.0.0.1:1 --materials --reconnect-seconds 0.2");
  CHECK(out.exit_code == 2);
  CHECK(out.text.empty());
}

}  // namespace runstone::test
