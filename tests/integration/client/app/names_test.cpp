// The real client program under a name that another key owns, and the commands for keys.
#include <catch2/catch.hpp>
#include <fstream>
#include <string>

#include "tests/integration/server/app/server_bench.hpp"
#include "tests/support/core/shell_run.hpp"

namespace runstone::test {
namespace {

/// Returns what the client printed, errors included.
ShellRun run_named_client(const std::string& arguments) {
  return run_shell(std::string(RUNSTONE_CLIENT_PROGRAM) + " " + arguments + " 2>&1");
}

}  // namespace

TEST_CASE("a client with a key owns its name, also after the key was moved", "[names]") {
  const TempFolder folder;
  const auto server = start_server(quiet_config(folder / "world"), flat_creation());
  const std::string there = "--connect 127.0.0.1:" + std::to_string(server->port()) +
                            " --materials --name ana --key " + folder.path() + "/";
  const ShellRun first = run_named_client(there + "ana.key");
  CHECK(first.exit_code == 0);
  CHECK(first.text.find("first contact with the server of world ") != std::string::npos);
  const ShellRun other = run_named_client(there + "eve.key");
  CHECK(other.exit_code == 2);
  CHECK(other.text.find("the name \"ana\" belongs to the player with the key ") !=
        std::string::npos);
  std::ofstream(folder / "words") << "one two three\n";
  const std::string words = " --passphrase-file " + (folder / "words");
  const ShellRun exported = run_named_client("key export --key " + (folder / "ana.key") +
                                             " --out " + (folder / "exported") + words);
  CHECK(exported.exit_code == 0);
  const ShellRun imported = run_named_client("key import --key " + (folder / "moved.key") +
                                             " --in " + (folder / "exported") + words);
  CHECK(imported.exit_code == 0);
  CHECK(imported.text == exported.text);
  CHECK(run_named_client(there + "moved.key").exit_code == 0);
  CHECK(run_named_client("key import --key " + (folder / "moved.key") + " --in " +
                         (folder / "exported") + words)
            .exit_code == 2);
}

}  // namespace runstone::test
