// The real client program with a password, and with the code that brings a key to another device.
#include <catch2/catch.hpp>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/integration/server/app/server_bench.hpp"
#include "tests/integration/server/app/server_commands.hpp"
#include "tests/support/core/shell_run.hpp"

namespace runstone::test {
namespace {

/// Returns what the client printed, errors included. Nobody is there to be asked.
ShellRun run_client_alone(const std::string& arguments) {
  return run_shell(std::string(RUNSTONE_CLIENT_PROGRAM) + " " + arguments + " 2>&1 </dev/null");
}

std::string connect_to(const Server& server) {
  return " --connect 127.0.0.1:" + std::to_string(server.port());
}

bool tells(const ShellRun& run, const std::string& part) {
  INFO(run.text);
  return run.text.find(part) != std::string::npos;
}

std::string code_in(const ShellRun& sent) {
  const std::size_t at = sent.text.find("code ");
  INFO(sent.text);
  REQUIRE(at != std::string::npos);
  return sent.text.substr(at + 5, 19);
}

}  // namespace

TEST_CASE("the client brings a password from a file, and says when one is missing",
          "[integration][rights]") {
  const TempFolder folder;
  const ServerConfig config = quiet_config(folder / "world");
  auto server = start_server(config, flat_creation());
  REQUIRE(control(config.world, {"role", "default", "nobody"}).is_ok);
  REQUIRE(control(config.world, {"password", "set"}, [] {
            return Result<std::string, std::string>("blue cheese 42");
          }).is_ok);
  std::ofstream(folder / "right") << "blue cheese 42\n";
  std::ofstream(folder / "wrong") << "blue cheese 41\n";
  const std::string join =
      connect_to(*server) + " --materials --name ana --key " + (folder / "ana.key");
  const std::string with = " --password-file " + (folder / "");
  const ShellRun missing = run_client_alone(join);
  CHECK(missing.exit_code == 2);
  CHECK(tells(missing, "this world has a password: start with --password-file FILE"));
  const ShellRun wrong = run_client_alone(join + with + "wrong");
  CHECK(wrong.exit_code == 2);
  CHECK(tells(wrong, "the password is wrong"));
  CHECK(run_client_alone(join + with + "right").exit_code == 0);
  CHECK(run_client_alone(join).exit_code == 0);  // the key has the role now
  CHECK(run_client_alone(join + with + "right --insecure").exit_code == 2);
  const ShellRun keyless = run_client_alone(connect_to(*server) + " --materials" + with + "right");
  CHECK(keyless.exit_code == 2);
  CHECK(tells(keyless, "--key"));
}

TEST_CASE("a key moves to another device by a code that works once", "[integration][names]") {
  const TempFolder folder;
  auto server = start_server(quiet_config(folder / "world"), flat_creation());
  const std::string there = connect_to(*server);
  const std::string ana = " --key " + (folder / "ana.key"), phone = " --key " + (folder / "phone");
  REQUIRE(run_client_alone(there + " --materials --name ana" + ana).exit_code == 0);
  const ShellRun sent = run_client_alone("key send" + there + ana);
  REQUIRE(sent.exit_code == 0);
  CHECK(tells(sent, "Within 10 minutes"));
  const std::string code = code_in(sent);

  // A file that cannot be written is found before the code is used up.
  CHECK(tells(run_client_alone("key receive" + there + ana + " " + code), "exists"));
  const std::string nowhere = " --key " + (folder / "missing/key");
  CHECK(tells(run_client_alone("key receive" + there + nowhere + " " + code),
              "missing: No such file or directory"));
  const ShellRun forged = run_client_alone("key receive" + there + phone + " 0000-0000-0000-0000");
  CHECK(forged.exit_code == 2);
  CHECK(tells(forged, "no key is here for this code"));
  CHECK(tells(run_client_alone("key receive" + there + phone + " 12345"), "this is no code"));
  CHECK_FALSE(std::filesystem::exists(folder / "phone"));

  // Typed in small letters with blanks, at the prompt.
  std::string typed = code;
  for (char& c : typed) c = c == '-' ? ' ' : static_cast<char>(std::tolower(c));
  const ShellRun received = run_shell("echo '" + typed + "' | " + RUNSTONE_CLIENT_PROGRAM +
                                      " key receive" + there + phone + " 2>&1");
  INFO(received.text);
  CHECK(received.exit_code == 0);
  CHECK(tells(received, "fingerprint "));
  CHECK(run_client_alone("key show" + ana).text == run_client_alone("key show" + phone).text);
  CHECK(run_client_alone(there + " --materials --name ana" + phone).exit_code == 0);
  CHECK(tells(run_client_alone("key receive" + there + " --key " + (folder / "third") + " " + code),
              "used before"));
}

TEST_CASE("a newer code replaces the older one, and a restart of the server ends it",
          "[integration][names]") {
  const TempFolder folder;
  const ServerConfig config = quiet_config(folder / "world");
  const std::string ana = " --key " + (folder / "ana.key"), phone = " --key " + (folder / "phone");
  std::string second;
  {
    auto server = start_server(config, flat_creation());
    const std::string there = connect_to(*server);
    REQUIRE(run_client_alone(there + " --materials --name ana" + ana).exit_code == 0);
    const std::string first = code_in(run_client_alone("key send" + there + ana));
    second = code_in(run_client_alone("key send" + there + ana));
    CHECK(first != second);
    CHECK(run_client_alone("key receive" + there + phone + " " + first).exit_code == 2);
  }
  auto server = start_server(config, flat_creation());
  CHECK(run_client_alone("key receive" + connect_to(*server) + phone + " " + second).exit_code ==
        2);
  CHECK_FALSE(std::filesystem::exists(folder / "phone"));
}

TEST_CASE("keys are not sent to where no server is, nor for strangers", "[integration][names]") {
  const TempFolder folder;
  const std::string phone = " --key " + (folder / "phone");
  CHECK(run_client_alone("key send --connect 127.0.0.1:1" + phone).exit_code == 2);
  CHECK(
      tells(run_client_alone("key receive --connect 127.0.0.1:1" + phone + " 0000-0000-0000-0000"),
            "cannot connect"));
  const ServerConfig config = quiet_config(folder / "world");
  auto server = start_server(config, flat_creation());
  REQUIRE(control(config.world, {"role", "default", "nobody"}).is_ok);
  std::ofstream(folder / "stranger") << std::string(64, '7') << "\n";
  std::filesystem::permissions(folder / "stranger", std::filesystem::perms::owner_read);
  const ShellRun refused =
      run_client_alone("key send" + connect_to(*server) + " --key " + (folder / "stranger"));
  CHECK(refused.exit_code == 2);
  CHECK(tells(refused, "only invited players may join"));
}

}  // namespace runstone::test
