// What a client session keeps of the chat, and sends.
#include "client/session/chat_inbox.hpp"

#include "tests/unit/client/session/session_bench.hpp"

namespace runstone::test::chat_inbox_test {

using namespace session_bench;

namespace {

ChatLine line_of(const std::string& text, TimeUs utc_us = 5,
                 ChatLineKind kind = ChatLineKind::player) {
  return {kind, kind == ChatLineKind::player ? AuthorId{7} : AuthorId{0},
          kind == ChatLineKind::player ? "ann" : "", text, utc_us};
}

std::vector<std::string> drained(ChatInbox& inbox) {
  std::vector<std::string> texts;
  for (const ChatLine& line : inbox.drain()) texts.push_back(line.text);
  return texts;
}

struct ChatSession : SessionBench {
  void open_with(const std::vector<Message>& early, std::uint64_t features = kFeatureChat) {
    greet();
    CHECK((server.hello.features & kFeatureChat) != 0);
    Welcome welcome = server.make_welcome();
    welcome.features = features;
    welcome.signature =
        sign(server.keys_of_server, server_transcript(server.hello, welcome, std::nullopt));
    receive(welcome);
    for (const Message& message : early) receive(message);
    receive(SessionAccepted{6, 0});
    static_cast<void>(sent());
  }
};

using Texts = std::vector<std::string>;

}  // namespace

TEST_CASE("lines are drained in order, and the oldest go when nobody drains them", "[chat]") {
  ChatInbox inbox;
  inbox.receive({{line_of("a", 1), line_of("b", 2)}});
  inbox.receive({{line_of("c", 3)}});
  CHECK(drained(inbox) == Texts{"a", "b", "c"});
  CHECK(drained(inbox).empty());
  for (std::size_t i = 0; i < ChatInbox::kLinesMax + 9; ++i)
    inbox.receive({{line_of(std::to_string(i), 4)}});
  const Texts kept = drained(inbox);
  REQUIRE(kept.size() == ChatInbox::kLinesMax);
  CHECK(kept.front() == "9");
}

TEST_CASE("a new connection brings the newest lines again, and known ones are left out", "[chat]") {
  ChatInbox inbox;
  inbox.receive({{line_of("a", 1), line_of("b", 2)}});
  inbox.receive({{line_of("b", 2)}});  // of one connection: nothing is left out
  inbox.receive({{line_of("refused", 3, ChatLineKind::refused)}});
  CHECK(drained(inbox) == Texts{"a", "b", "b", "refused"});
  inbox.disconnected();
  ChatLine restored = line_of("b", 2);
  restored.author = 0;
  inbox.receive({{line_of("a", 1), restored, line_of("b", 4), line_of("c", 5),
                  line_of("today", 6, ChatLineKind::message_of_the_day)}});
  CHECK(drained(inbox) == Texts{"b", "c", "today"});
  inbox.receive({{line_of("c", 5)}});
  CHECK(drained(inbox) == Texts{"c"});
  inbox.disconnected();
  inbox.clear();
  inbox.receive({{line_of("a", 1)}});
  CHECK(drained(inbox) == Texts{"a"});
}

TEST_CASE("a withdrawn line is dropped if it was not drained, and reported", "[chat]") {
  ChatInbox inbox;
  inbox.receive({{line_of("a", 1), line_of("b", 2), line_of("refused", 1, ChatLineKind::refused)}});
  const ChatLineId first = id_of(line_of("a", 1));
  inbox.receive(ChatWithdrawn{{first, {7, "nobody"}}});
  CHECK(drained(inbox) == Texts{"b", "refused"});
  CHECK(inbox.take_withdrawn() == std::vector<ChatLineId>{first, {7, "nobody"}});
  CHECK(inbox.take_withdrawn().empty());
}

TEST_CASE_METHOD(ChatSession, "a session sends lines, and gets lines that overtook the handshake",
                 "[session][chat]") {
  CHECK(session.chat("hello").error() == "no world is open");
  open_with({ChatLines{{line_of("early")}}});
  const auto lines = session.drain_chat();
  REQUIRE(lines.size() == 1);
  CHECK(lines[0] == line_of("early"));
  CHECK(session.chat("  hello ").has_value());
  CHECK(session.chat("   ").error() == "it is empty");
  CHECK(session.chat("a\x1b[2J").error() == "it has control characters, or is no UTF-8 text");
  CHECK(take<ChatRequest>(sent()) == std::vector<ChatRequest>{{"hello"}});

  session.disconnected();
  open_with({ChatLines{{line_of("early"), line_of("later", 9)}}});
  const auto again = session.drain_chat();
  REQUIRE(again.size() == 1);
  CHECK(again[0].text == "later");
}

TEST_CASE_METHOD(ChatSession, "a server without the feature takes no lines", "[session][chat]") {
  open_with({}, 0);
  CHECK(session.chat("hello").error() == "the server has no chat");
  CHECK(take<ChatRequest>(sent()).empty());
}

}  // namespace runstone::test::chat_inbox_test
