// The password of a world: set by control, brought by clients, and held by the log alone. And the
// invite for the first administrator.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include "server/app/first_invite.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/integration/server/app/server_commands.hpp"
#include "tests/support/net/raw_client.hpp"

namespace runstone::test {
namespace {

Answer set_password(const std::string& world, const std::string& password) {
  return control(world, {"password", "set"},
                 [&password] { return Result<std::string, std::string>(password); });
}

/// Joins with a password. Returns the text of the server's goodbye, or "" if it let the player in.
std::string join_with(const Server& server, std::uint8_t who, const std::string& password) {
  RawClient client(server.port());
  client.password = password;
  if (client.join(who)) return "";
  REQUIRE_FALSE(client.refusal.empty());
  return client.refusal;
}

/// Returns true if a file of the folder has these bytes.
bool folder_holds(const std::string& folder, const std::string& bytes) {
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    if (!file.is_regular_file()) continue;
    std::ifstream in(file.path(), std::ios::binary);
    const std::string all{std::istreambuf_iterator<char>(in), {}};
    if (all.find(bytes) != std::string::npos) return true;
  }
  return false;
}

bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("a password admits who knows it, until it is changed or cleared",
          "[integration][rights]") {
  const TempFolder folder;
  const ServerConfig config = quiet_config(folder / "world");
  const std::string& world = config.world;
  {
    auto server = start_server(config, flat_creation());
    REQUIRE(control(world, {"role", "default", "nobody"}).is_ok);
    CHECK(control(world, {"password"}).text ==
          "the world has no password (password set gives it one)\n");
    CHECK(mentions(set_password(world, "blue cheese 42").text, "get the role builder (record 2)"));
    CHECK(mentions(join_with(*server, 1, "blue cheese 41"), "the password is wrong"));
    CHECK(mentions(join_with(*server, 1, ""), "only invited players may join"));
    CHECK(mentions(control(world, {"refusals"}).text, "the password is wrong"));
    CHECK(join_with(*server, 1, "blue cheese 42").empty());
    CHECK(join_with(*server, 1, "").empty());  // the role stays
    CHECK(mentions(control(world, {"grants"}).text, ": builder; record 3, "));
    CHECK(set_password(world, "red cheese 43").is_ok);
    CHECK(mentions(join_with(*server, 2, "blue cheese 42"), "the password is wrong"));
    CHECK(server->stop().is_clean);
  }
  auto server = start_server(config, flat_creation());
  CHECK(mentions(control(world, {"password"}).text, "the role builder; record 4, "));
  CHECK(join_with(*server, 2, "red cheese 43").empty());
  const std::string log = control(world, {"log", "cause", "rights"}).text;
  CHECK(mentions(log, " rights set a password for the role builder"));
  CHECK(mentions(log, " joined with the password"));
  CHECK_FALSE(mentions(log, "verifier"));
  CHECK(control(world, {"rights", "undo", "4"}).is_ok);
  CHECK(join_with(*server, 3, "blue cheese 42").empty());
  CHECK(control(world, {"password", "clear"}).is_ok);
  RawClient late(server->port());
  late.password = "blue cheese 42";
  CHECK_FALSE(late.join(4).has_value());
  CHECK_FALSE(late.welcome.password_salt.has_value());
  CHECK(server->stop().is_clean);
}

TEST_CASE("neither the password nor its key is in the world's folder", "[integration][rights]") {
  const TempFolder folder;
  const ServerConfig config = quiet_config(folder / "world");
  auto server = start_server(config, flat_creation());
  REQUIRE(control(config.world, {"role", "default", "nobody"}).is_ok);
  REQUIRE(set_password(config.world, "blue cheese 42").is_ok);
  RawClient client(server->port());
  client.password = "blue cheese 42";
  REQUIRE(client.join(1).has_value());
  const PasswordSalt salt = client.welcome.password_salt.value();
  const PasswordKey key = password_key(client.password, salt).value();
  CHECK(server->stop().is_clean);
  const auto text_of = [](const auto& bytes) { return std::string(bytes.begin(), bytes.end()); };
  CHECK(folder_holds(config.world, text_of(salt)));  // the search finds what is there
  CHECK(folder_holds(config.world, text_of(hash_of(key))));
  CHECK_FALSE(folder_holds(config.world, text_of(key)));
  CHECK_FALSE(folder_holds(config.world, "blue cheese"));
}

TEST_CASE("clients set no password, and control refuses short ones", "[integration][rights]") {
  const TempFolder folder;
  const ServerConfig config = quiet_config(folder / "world");
  auto server = start_server(config, flat_creation());
  RawClient ana(server->port());
  ana.features = kFeatureCommands;
  REQUIRE(ana.join(1).has_value());
  REQUIRE(control(config.world, {"grant", "player1", "administrator"}).is_ok);
  CHECK_FALSE(command(ana, "password set").is_ok);
  CHECK(command(ana, "password").is_ok);
  std::ostringstream out;
  const auto refused = control_server({config.world, {"password", "set"}}, out,
                                      [] { return Result<std::string, std::string>("1234567"); });
  REQUIRE_FALSE(refused.has_value());
  CHECK(mentions(refused.error(), "fewer than 8 characters"));
  CHECK(mentions(control(config.world, {"password", "set", "hunter2xyz"}).text, "control asks"));
}

TEST_CASE("the first administrator of a world joins by a link that works once",
          "[integration][rights]") {
  const TempFolder folder;
  const ServerConfig config = quiet_config(folder / "world");
  {
    auto server = start_server(config, flat_creation());
    REQUIRE(server->is_unclaimed());
    const std::string text = make_first_invite(*server);
    const std::string port = std::to_string(server->port());
    const std::size_t link = text.find("'runstone://127.0.0.1:" + port + "/#");
    REQUIRE(link != std::string::npos);
    const std::size_t token = text.find('#', link) + 1;
    RawClient ana(server->port()), bea(server->port());
    ana.ticket = bea.ticket = text.substr(token, text.find('\'', token) - token);
    ana.features = bea.features = kFeatureCommands | kFeatureChat;
    REQUIRE(ana.join(1).has_value());
    CHECK(command(ana, "why player1 administer").text.starts_with("yes: "));
    REQUIRE(bea.join(2).has_value());  // the world is open, but the link gives nothing any more
    const auto told = bea.next_of<ChatLines>();
    REQUIRE(told.has_value());
    CHECK(mentions(told->lines.at(0).text, "you were given no role: The invite was used"));
    CHECK(command(bea, "why player2 administer").text.starts_with("no: "));
    CHECK(server->stop().is_clean);
  }
  CHECK_FALSE(start_server(config, flat_creation())->is_unclaimed());
}

TEST_CASE("a world is unclaimed until somebody got a role, even if it was taken back",
          "[integration][rights]") {
  const TempFolder folder;
  const ServerConfig config = quiet_config(folder / "world");
  start_server(config, flat_creation())->stop();
  {
    auto server = start_server(config, flat_creation());
    CHECK(server->is_unclaimed());
    RawClient ana(server->port());
    REQUIRE(ana.join(1).has_value());
    REQUIRE(control(config.world, {"grant", "player1", "builder"}).is_ok);
    REQUIRE(control(config.world, {"revoke", "player1"}).is_ok);
    server->stop();
  }
  CHECK_FALSE(start_server(config, flat_creation())->is_unclaimed());
}

TEST_CASE("a descriptor goes to the journal if systemd says so of this very stream",
          "[integration]") {
  const TempFolder folder;
  const int file = ::open((folder / "file").c_str(), O_CREAT | O_WRONLY, 0600);
  struct stat about{};
  REQUIRE(::fstat(file, &about) == 0);
  ::unsetenv("JOURNAL_STREAM");
  CHECK_FALSE(is_journal(file));
  const std::string stream = std::to_string(about.st_dev) + ":" + std::to_string(about.st_ino);
  ::setenv("JOURNAL_STREAM", stream.c_str(), 1);
  CHECK(is_journal(file));
  CHECK_FALSE(is_journal(-1));
  ::setenv("JOURNAL_STREAM", (stream + "1").c_str(), 1);
  CHECK_FALSE(is_journal(file));
  ::unsetenv("JOURNAL_STREAM");
  ::close(file);
}

}  // namespace runstone::test
