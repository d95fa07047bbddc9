#include "client/play/chat.hpp"

#include "tests/unit/client/session/session_bench.hpp"

namespace runstone::test::chat_test {

using namespace session_bench;

TEST_CASE("only a line of a player begins with a name", "[client][chat]") {
  CHECK(printed_line({ChatLineKind::player, 7, "ana", "hi <all>", 0}) == "<ana> hi <all>");
  CHECK(printed_line({ChatLineKind::player, 7, "ana> hi <bea", "x", 0}) == "<ana) hi (bea> x");
  CHECK(printed_line({ChatLineKind::server, 0, "", "restart", 0}) == "[server] restart");
  CHECK(printed_line({ChatLineKind::message_of_the_day, 0, "", "hello", 0}) == "[today] hello");
  CHECK(printed_line({ChatLineKind::refused, 0, "", "you are muted", 0}) ==
        "[not sent] you are muted");
  CHECK(printed_line({ChatLineKind::visit, 0, "", "ana has joined", 0}) ==
        "[players] ana has joined");
  CHECK(printed_line({static_cast<ChatLineKind>(9), 0, "", "news", 0}) == "[chat] news");
  CHECK(printed_line({ChatLineKind::player, 7, "ana",
                      "a\xe2\x80\xae"
                      "b",
                      0}) == "<ana> a?b");
}

TEST_CASE_METHOD(SessionBench, "the answer of a command is read before the next command is sent",
                 "[client][chat]") {
  server.features = kFeatureChat | kFeatureCommands;
  static_cast<void>(open());
  Chat chat(session);
  chat.send("/players");
  const auto commands = take<CommandRequest>(sent());
  REQUIRE(commands.size() == 1);
  receive(CommandOutput{commands[0].id, {"nobody"}, true, true});
  chat.send("/status");
  chat.send("/help");  // the one before is still running
  receive(ChatLines{{{ChatLineKind::player, 7, "ana", "hello", 1}}});
  const auto lines = chat.take_lines();
  REQUIRE(lines.size() == 3);
  CHECK(lines[0].text == "nobody");
  CHECK(lines[0].tone == ChatTone::answer);
  CHECK(lines[1].text == "[not sent] the previous command is still running");
  CHECK(lines[1].tone == ChatTone::refused);
  CHECK(lines[2].text == "<ana> hello");
  CHECK(lines[0].id == ChatLineId{});
  CHECK(lines[2].id == ChatLineId{1, "ana"});
  CHECK(chat.take_lines().empty());
}

TEST_CASE_METHOD(SessionBench, "the window forgets the lines that the server withdraws",
                 "[client][chat]") {
  server.features = kFeatureChat | kFeatureChatWithdrawal;
  static_cast<void>(open());
  Chat chat(session);
  ChatWindow window;
  const auto show = [&] {
    for (ShownLine& line : chat.take_lines()) window.hear(std::move(line));
    return window.withdraw(chat.take_withdrawn());
  };
  receive(ChatLines{{{ChatLineKind::player, 7, "ana", "hello", 1},
                     {ChatLineKind::player, 8, "mole", "buy gold", 1},
                     {ChatLineKind::server, 0, "", "restart at ten", 1},
                     {ChatLineKind::player, 8, "mole", "buy more gold", 2}}});
  CHECK(show() == 0);
  CHECK(window.line_count() == 4);
  receive(ChatLines{{{ChatLineKind::player, 8, "mole", "and more", 3}}});
  receive(ChatWithdrawn{{{1, "mole"}, {2, "mole"}, {3, "mole"}, {9, "ana"}}});
  CHECK(show() == 2);
  CHECK(window.line_count() == 2);
}

TEST_CASE_METHOD(SessionBench, "the command undo is reported before it is sent, and no other one",
                 "[client][chat]") {
  server.features = kFeatureChat | kFeatureCommands;
  static_cast<void>(open());
  int undos = 0;
  Chat chat(session, [&] { ++undos; });
  for (const char* line : {"/undone", "undo", "/redo", "/help undo", "/"}) chat.send(line);
  CHECK(undos == 0);
  chat.send("/undo");
  chat.send("/ undo ");
  CHECK(undos == 2);
}

}  // namespace runstone::test::chat_test
