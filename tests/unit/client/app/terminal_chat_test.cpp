// How the client prints chat, and reads what is typed.
#include "client/app/terminal_chat.hpp"

#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>

#include "protocol/limits.hpp"
#include "tests/unit/client/session/session_bench.hpp"

namespace runstone::test::terminal_chat_test {

using namespace session_bench;

namespace {

TEST_CASE("typed lines are read as they are complete, without waiting", "[client][chat]") {
  std::array<int, 2> ends{};
  REQUIRE(::pipe(ends.data()) == 0);
  const auto type = [&](const std::string& bytes) {
    REQUIRE(::write(ends[1], bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()));
  };
  using Lines = std::vector<std::string>;
  LineInput input(ends[0]);
  CHECK(input.take_lines().empty());
  type("hel");
  CHECK(input.take_lines().empty());
  type("lo\r\n\n/help\nrest");
  CHECK(input.take_lines() == Lines{"hello", "", "/help"});
  type(std::string(3'000, 'x'));
  CHECK(input.take_lines().empty());
  type("\n");
  const Lines cut = input.take_lines();
  REQUIRE(cut.size() == 1);
  CHECK(cut[0].size() == kCommandBytesMax);
  CHECK(cut[0].starts_with("restx"));
  type("no end");
  ::close(ends[1]);
  CHECK(input.take_lines().empty());
  CHECK(input.take_lines().empty());  // the end
  CHECK(input.take_lines().empty());
  ::close(ends[0]);
}

struct TypingBench : SessionBench {
  TypingBench() {
    REQUIRE(::pipe(ends.data()) == 0);
    greet();
    Welcome welcome = server.make_welcome();
    welcome.features = kFeatureChat | kFeatureCommands;
    welcome.signature =
        sign(server.keys_of_server, server_transcript(server.hello, welcome, std::nullopt));
    receive(welcome);
    receive(SessionAccepted{6, 0});
    static_cast<void>(sent());
  }
  ~TypingBench() {
    ::close(ends[0]);
    ::close(ends[1]);
  }
  void type(TerminalChat& chat, const std::string& line) {
    const std::string bytes = line + "\n";
    REQUIRE(::write(ends[1], bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()));
    chat.step();
  }
  std::array<int, 2> ends{};
};

TEST_CASE_METHOD(TypingBench, "typed lines are chat, and commands after a slash",
                 "[client][chat]") {
  Chat lines(session);
  TerminalChat chat(lines, ends[0]);
  type(chat, "hello");
  type(chat, "   ");
  type(chat, "/players");
  type(chat, "/status");  // the one before is still running
  const auto out = sent();
  CHECK(take<ChatRequest>(out) == std::vector<ChatRequest>{{"hello"}});
  const auto commands = take<CommandRequest>(out);
  REQUIRE(commands.size() == 1);
  CHECK(commands[0].text == "players");
  receive(CommandOutput{commands[0].id, {"nobody"}, true, true});
  type(chat, "/status");
  CHECK(take<CommandRequest>(sent()).size() == 1);
}

TEST_CASE_METHOD(TypingBench, "lines that were heard are found once, in their order",
                 "[client][chat]") {
  Chat lines(session);
  TerminalChat chat(lines, std::nullopt);
  CHECK_FALSE(chat.take_heard("hello"));
  receive(ChatLines{{{ChatLineKind::player, 7, "ana", "hello", 1},
                     {ChatLineKind::player, 7, "ana", "ready", 2},
                     {ChatLineKind::server, 0, "", "hello", 3}}});
  chat.step();
  CHECK(chat.take_heard("<ana> ready"));
  CHECK_FALSE(chat.take_heard("<ana>"));
  CHECK(chat.take_heard("hello"));
  CHECK_FALSE(chat.take_heard("hello"));
}

}  // namespace
}  // namespace runstone::test::terminal_chat_test
