// Chat with a real server: two players, a mute, the host, a restart, and a backup.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "server/backup/backup_program.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/integration/server/app/server_commands.hpp"
#include "tests/support/core/text_contains.hpp"
#include "tests/support/net/raw_client.hpp"
#include "tests/support/sql/full_disk_vfs.hpp"

namespace runstone::test {
namespace {

/// A client that takes part in the chat.
struct ChatClient : RawClient {
  explicit ChatClient(std::uint16_t port) : RawClient(port) {
    features = kFeatureChat | kFeatureCommands;
  }
  void enter(std::uint8_t who) { REQUIRE(join(who).has_value()); }
  void write(const std::string& text) { send(ChatRequest{text}); }
  /// Returns the next line.
  ChatLine hear() {
    if (heard_.empty()) {
      auto lines = next_of<ChatLines>();
      REQUIRE(lines.has_value());
      heard_.assign(lines->lines.begin(), lines->lines.end());
    }
    ChatLine line = std::move(heard_.front());
    heard_.pop_front();
    return line;
  }

 private:
  std::deque<ChatLine> heard_;
};

bool is_line(const ChatLine& line, const std::string& name, const std::string& text) {
  return line.kind == ChatLineKind::player && line.name == name && line.text == text;
}

Answer chat_log(const std::string& world, std::vector<std::string> more = {}) {
  std::vector<std::string> words = {"chat", "log"};
  words.insert(words.end(), more.begin(), more.end());
  return control(world, words);
}

}  // namespace

TEST_CASE("players write to each other, the host speaks and mutes, and a restart keeps the lines",
          "[integration][chat]") {
  const TempFolder folder;
  ServerConfig config = quiet_config(folder / "world");
  config.message_of_the_day = "build with care";
  const std::string& world = config.world;
  {
    const auto server = start_server(config, flat_creation());
    ChatClient ana(server->port()), mole(server->port());
    ana.enter(1);
    CHECK(ana.hear().kind == ChatLineKind::message_of_the_day);
    ana.write("hello");
    CHECK(is_line(ana.hear(), "player1", "hello"));
    mole.enter(2);
    CHECK(is_line(mole.hear(), "player1", "hello"));
    CHECK(mole.hear().text == "build with care");
    mole.write("buy gold");
    CHECK(is_line(ana.hear(), "player2", "buy gold"));
    CHECK(is_line(mole.hear(), "player2", "buy gold"));

    CHECK(control(world, {"mute", "player2", "reason", "spam"}).is_ok);
    mole.write("buy more gold");
    const ChatLine refused = mole.hear();
    CHECK(refused.kind == ChatLineKind::refused);
    CHECK(refused.text == "you are muted: spam");
    CHECK(contains(control(world, {"refusals"}).text, "chat: you are muted: spam"));

    CHECK(control(world, {"say", "restart", "at", "ten"}).text == "sent to 2 sessions\n");
    const ChatLine host = ana.hear();
    CHECK(host.kind == ChatLineKind::server);
    CHECK(host.text == "restart at ten");
    CHECK_FALSE(command(ana, "say I am the server").is_ok);
    CHECK_FALSE(command(ana, "chat log").is_ok);

    const std::string log = chat_log(world).text;
    CHECK(contains(log, "player1 "));
    CHECK(contains(log, ": hello\n"));
    CHECK(contains(log, " server: restart at ten\n"));
    CHECK_FALSE(contains(log, "more gold"));
    const std::string of_mole =
        chat_log(world, {"by", "player2", "since", "1h", "limit", "5"}).text;
    CHECK(contains(of_mole, ": buy gold\n"));
    CHECK_FALSE(contains(of_mole, "hello"));
    CHECK(server->stop().is_clean);
  }
  const auto server = start_server(config, flat_creation());
  ChatClient bea(server->port());
  bea.enter(3);
  CHECK(is_line(bea.hear(), "player1", "hello"));
  CHECK(is_line(bea.hear(), "player2", "buy gold"));
  CHECK(bea.hear().text == "restart at ten");
  CHECK(bea.hear().text == "build with care");
  CHECK(server->stop().is_clean);
}

TEST_CASE("with chat_days 0 nothing of the chat stays on disk", "[integration][chat]") {
  const TempFolder folder;
  ServerConfig config = quiet_config(folder / "world");
  {
    const auto server = start_server(config, flat_creation());
    ChatClient ana(server->port());
    ana.enter(1);
    ana.write("hello");
    ana.hear();
    CHECK(server->stop().is_clean);
  }
  const std::string file = config.world + "/chat.sqlite";
  CHECK(std::filesystem::exists(file));
  config.chat_days = 0;
  const auto server = start_server(config, flat_creation());
  CHECK_FALSE(std::filesystem::exists(file));
  ChatClient ana(server->port()), bea(server->port());
  ana.enter(1);
  ana.write("hello again");
  CHECK(is_line(ana.hear(), "player1", "hello again"));
  bea.enter(2);
  CHECK(is_line(bea.hear(), "player1", "hello again"));  // from memory
  CHECK(contains(chat_log(config.world).text, "chat_days = 0"));
  CHECK(server->stop().is_clean);
  CHECK_FALSE(std::filesystem::exists(file));
}

TEST_CASE("a full disk and a damaged log stop neither the chat nor the server",
          "[integration][chat]") {
  FullDiskVfs disk;
  const TempFolder folder;
  const ServerConfig config = quiet_config(folder / "world");
  {
    const auto server = start_server(config, flat_creation());
    ChatClient ana(server->port());
    ana.enter(1);
    disk.fill();
    for (int i = 0; i < 5; ++i) {
      ana.write("line " + std::to_string(i));
      CHECK(is_line(ana.hear(), "player1", "line " + std::to_string(i)));
    }
    disk.make_room();
    CHECK(server->stop().is_clean);
  }
  std::ofstream(config.world + "/chat.sqlite", std::ios::binary | std::ios::trunc)
      << std::string(8'192, 'x');
  const auto server = start_server(config, flat_creation());
  ChatClient ana(server->port());
  ana.enter(1);
  ana.write("still here");
  CHECK(is_line(ana.hear(), "player1", "still here"));
  CHECK(contains(chat_log(config.world).text, ": still here\n"));
  CHECK(server->stop().is_clean);
}

TEST_CASE("a backup leaves the chat out and says so", "[integration][chat]") {
  const TempFolder folder;
  const ServerConfig config = quiet_config(folder / "world");
  const auto server = start_server(config, flat_creation());
  ChatClient ana(server->port());
  ana.enter(1);
  ana.write("a secret");
  ana.hear();
  CHECK(contains(chat_log(config.world).text, "a secret"));
  std::ostringstream out;
  const auto done = back_up({config.world, folder / "copy", false}, 1'795'000'000'000'000, out, {});
  INFO((done ? "" : done.error()));
  REQUIRE(done.has_value());
  CHECK(contains(out.str(), "chat.sqlite"));
  CHECK_FALSE(contains(out.str(), "chat.sqlite-wal"));
  for (const auto& file : std::filesystem::directory_iterator(folder / "copy")) {
    CHECK_FALSE(contains(file.path().filename().string(), "chat"));
    std::ifstream in(file.path(), std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    CHECK_FALSE(contains(bytes, "a secret"));
  }
}

TEST_CASE("a flood of lines is refused, and the others go on", "[integration][chat]") {
  const TempFolder folder;
  ServerConfig config = quiet_config(folder / "world");
  config.chat_per_minute = 1;
  const auto server = start_server(config, flat_creation());
  ChatClient ana(server->port()), mole(server->port());
  ana.enter(1);
  mole.enter(2);
  for (int i = 0; i < 500; ++i) mole.write("flood " + std::to_string(i));
  CHECK(is_line(ana.hear(), "player2", "flood 0"));
  ana.write("hello");
  CHECK(is_line(ana.hear(), "player1", "hello"));
  ChatLine of_mole = mole.hear();
  for (int i = 0; i < 10 && of_mole.kind == ChatLineKind::refused; ++i) of_mole = mole.hear();
  CHECK(is_line(of_mole, "player2", "flood 0"));
  CHECK(contains(control(config.world, {"refusals"}).text, "chat: too fast"));
  CHECK(server->stop().is_clean);
}

}  // namespace runstone::test
