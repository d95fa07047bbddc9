// Chat on the world strand: who may write, how much, who reads, and what a flood costs.
#include "server/world/people/chat_room.hpp"

#include "tests/unit/server/world/world_bench.hpp"

namespace runstone::test::chat_handlers_test {
namespace {

constexpr AddressBlock kHome = address_block_v4(0x0a000001), kSchool = address_block_v4(0x0a000101);

PublicKey player_key(std::uint8_t who) { return key_pair_of(seed_of(who)).public_key; }

WorldConfig chat_config(std::uint64_t per_minute = 0) {
  WorldConfig c = config();
  c.chat_budget = chat_budget(per_minute);
  return c;
}

struct ChatBench : WorldBench {
  explicit ChatBench(WorldConfig c = chat_config(), WorldStart start = {})
      : WorldBench(std::move(c), std::move(start)) {}

  void enter(SessionId session, std::uint8_t who, AddressBlock from = kHome,
             std::uint64_t features = kFeatureChat) {
    server.connected(session, now(), from);
    Hello h = hello(who, session);
    h.features = features;
    server.received(session, h, now());
    const auto welcome = environment.messages<Welcome>(session, 0);
    REQUIRE(welcome.size() == 1);
    server.received(session, client_auth(who, h, welcome[0]), now());
    REQUIRE(environment.messages<SessionAccepted>(session, kEdge).size() == 1);
  }
  void write(SessionId session, const std::string& text) {
    server.received(session, ChatRequest{text}, now());
  }
  std::vector<ChatLine> lines(SessionId session) const {
    std::vector<ChatLine> all;
    for (const ChatLines& message : environment.messages<ChatLines>(session, kEdge))
      all.insert(all.end(), message.lines.begin(), message.lines.end());
    return all;
  }
  /// Returns the texts of the lines of this kind.
  std::vector<std::string> texts(SessionId session,
                                 ChatLineKind kind = ChatLineKind::player) const {
    std::vector<std::string> all;
    for (const ChatLine& line : lines(session)) {
      if (line.kind == kind) all.push_back(line.text);
    }
    return all;
  }
  std::vector<std::string> refused(SessionId session) const {
    return texts(session, ChatLineKind::refused);
  }
  void change(const RightsChange& change) {
    REQUIRE(server.changes().change_rights(change, {}, 0, now()).has_value());
  }
};

using Texts = std::vector<std::string>;

}  // namespace

TEST_CASE("a line goes to everybody with the feature, encoded once, and to the log of the chat",
          "[world][chat]") {
  ChatBench bench;
  bench.enter(1, 1);
  bench.enter(2, 2);
  bench.enter(3, 3, kHome, 0);
  bench.write(1, "  hello ");
  bench.write(2, "hi");
  CHECK(bench.lines(2).empty());
  bench.tick();
  const std::vector<ChatLine> got = bench.lines(2);
  REQUIRE(got.size() == 2);
  CHECK(got == bench.lines(1));
  CHECK(got[0].kind == ChatLineKind::player);
  CHECK(got[0].author == 1);
  CHECK(got[0].name == "player1");
  CHECK(got[0].text == "hello");
  CHECK(got[0].utc_us == 1'001'000'000);  // also before the first tick
  CHECK(got[1].text == "hi");
  CHECK(bench.lines(3).empty());
  std::vector<EncodedMessage> sent;
  for (const FakeEnvironment::Sent& each : bench.environment.sent) {
    if (each.message.kind == kKindOf<ChatLines>) sent.push_back(each.message);
  }
  REQUIRE(sent.size() == 2);  // one message for both lines, to each of two sessions
  CHECK(sent[0].bytes == sent[1].bytes);
  REQUIRE(bench.environment.chat.size() == 2);
  CHECK(bench.environment.chat[0] == ChatEntry{got[0], player_key(1)});
  CHECK(bench.environment.records.empty());
}

TEST_CASE("a muted player is told the reason and the end, and may write again after it",
          "[world][chat]") {
  ChatBench bench;
  bench.enter(1, 1);
  bench.enter(2, 2);
  const TimeUs until_us = bench.now().utc_us + 60'000'000;
  bench.change(Restrict{RestrictionKind::mute, player_key(1), until_us, "spam"});
  bench.write(1, "hello");
  bench.tick();
  CHECK(bench.texts(2).empty());
  REQUIRE(bench.refused(1).size() == 1);
  CHECK(bench.refused(1)[0].starts_with("you are muted until "));
  CHECK(bench.refused(1)[0].ends_with("Z: spam"));
  CHECK(bench.environment.chat.empty());
  REQUIRE(bench.server.rights().refusals().size() == 1);
  CHECK(bench.server.rights().refusals()[0].what == "chat: " + bench.refused(1)[0]);
  bench.tick(61'000'000);  // ends the silent session 1 too
  bench.enter(3, 1);
  bench.write(3, "hello");
  bench.tick();
  CHECK(bench.texts(3) == Texts{"hello"});

  Role silent;
  silent.name = "silent";
  silent.rights = {Right::see};
  bench.change(DefineRole{silent});
  bench.change(GrantRole{player_key(1), "silent"});
  bench.write(3, "still here");
  CHECK(bench.refused(3) == Texts{"your role does not allow it: silent"});
}

TEST_CASE("a line that nobody could read is refused with what is wrong", "[world][chat]") {
  ChatBench bench;
  bench.enter(1, 1);
  bench.write(1, "   ");
  bench.write(1,
              "a\xe2\x80\xae"
              "b");
  bench.tick();
  CHECK(bench.texts(1).empty());
  CHECK(bench.refused(1) == Texts{"it is empty", "it has invisible characters"});
}

TEST_CASE("the same line again is refused until ten seconds have passed", "[world][chat]") {
  ChatBench bench;
  bench.enter(1, 1);
  bench.enter(2, 2);
  bench.write(1, "buy gold");
  bench.write(1, "buy gold");
  bench.tick(4'000'000);
  bench.write(1, " buy gold ");
  bench.write(2, "buy gold");
  CHECK(bench.refused(1) == Texts{"you wrote that just now: again in 10.0 s",
                                  "you wrote that just now: again in 6.0 s"});
  bench.tick(6'000'000);
  bench.write(1, "buy gold");
  bench.tick();
  CHECK(bench.texts(2) == Texts{"buy gold", "buy gold", "buy gold"});
}

TEST_CASE("a key and an address write so many lines a minute", "[world][chat]") {
  WorldConfig c = chat_config(6);
  c.budgets_per_address = 2;
  ChatBench bench(c);
  bench.enter(1, 1);
  bench.enter(2, 1);  // another session of the same player
  for (int i = 0; i < 6; ++i) bench.write(i % 2 == 0 ? 1 : 2, "line " + std::to_string(i));
  bench.write(2, "one more");
  CHECK(bench.refused(2) == Texts{"you write too fast: again in 10.0 s"});

  bench.enter(3, 3);
  bench.enter(4, 4);
  for (int i = 0; i < 6; ++i) bench.write(3, "other " + std::to_string(i));
  bench.write(4, "a third key");
  CHECK(bench.refused(4) == Texts{"too many lines come from your address: again in 5.0 s"});
  bench.enter(5, 5, kSchool);
  bench.write(5, "from elsewhere");
  bench.tick();
  CHECK(bench.texts(5).size() == 13);
  CHECK(bench.texts(5).back() == "from elsewhere");
  bench.tick(10'000'000);
  bench.write(2, "one more");
  bench.tick();
  CHECK(bench.texts(5).back() == "one more");
  std::vector<std::string> what;
  for (const RefusalRow& row : bench.server.rights().refusals()) what.push_back(row.what);
  CHECK(what == Texts{"chat: too fast", "chat: too fast from one address"});
}

TEST_CASE("all players together write a bounded number of lines", "[world][chat]") {
  ChatBench bench;
  constexpr std::uint8_t kPlayers = 70;
  for (std::uint8_t who = 1; who <= kPlayers; ++who) bench.enter(who, who, address_block_v4(who));
  for (std::uint8_t who = 1; who <= kPlayers; ++who) bench.write(who, "hello");
  bench.tick();
  CHECK(bench.texts(1).size() == kChatLinesAtOnce);
  CHECK(bench.refused(kPlayers) == Texts{"too many players write at once: again in 0.1 s"});
}

TEST_CASE("a flood gets few answers, and pays for each line with its reading", "[world][chat]") {
  ChatBench bench(chat_config(1));
  bench.enter(1, 1);
  bench.write(1, "first");
  for (int i = 0; i < 1'000; ++i) bench.write(1, "flood " + std::to_string(i));
  CHECK(bench.refused(1).size() == kChatAnswerBurst);
  CHECK(bench.environment.charged[1] == 1'000 * 4'096);
  CHECK(bench.server.rights().refusals().size() == 1);
  CHECK(bench.server.rights().refusals()[0].count == 1'000);
  bench.tick(2'000'000);
  for (int i = 0; i < 1'000; ++i) bench.write(1, "flood " + std::to_string(i));
  CHECK(bench.refused(1).size() == kChatAnswerBurst + 2 * kChatAnswersPerSecond);
  CHECK(bench.texts(1) == Texts{"first"});
  CHECK(bench.environment.chat.size() == 1);
}

TEST_CASE("who joins gets the newest lines and then the message of the day", "[world][chat]") {
  ChatBench bench;
  bench.enter(1, 1);
  CHECK(bench.lines(1).empty());  // there is nothing to send
  std::size_t written = 0;
  for (; written < kChatRecentMax + 20; ++written) {
    bench.write(1, "line " + std::to_string(written));
    bench.tick(1'000'000);
  }
  WorldConfig with_message = chat_config();
  with_message.message_of_the_day = "build with care";
  bench.server.reconfigure(with_message);
  bench.write(1, "not sent yet");
  bench.enter(2, 2);
  const std::vector<ChatLine> got = bench.lines(2);
  REQUIRE(got.size() == kChatRecentMax + 1);
  CHECK(got.front().text == "line 20");
  CHECK(got[kChatRecentMax - 1].text == "line " + std::to_string(written - 1));
  CHECK(got.back().kind == ChatLineKind::message_of_the_day);
  CHECK(got.back().text == "build with care");
  bench.tick();
  CHECK(bench.lines(2).back().text == "not sent yet");  // once
  CHECK(bench.lines(2).size() == kChatRecentMax + 2);
  bench.enter(3, 3, kHome, 0);
  CHECK(bench.lines(3).empty());
}

TEST_CASE("after a restart the newest lines of the log are there", "[world][chat]") {
  WorldStart start;
  start.players = {{7, player_key(1), "player1"}};
  for (std::size_t i = 0; i < kChatRecentMax + 5; ++i) {
    ChatEntry entry;
    entry.line = {ChatLineKind::player, 0, "player1", "line " + std::to_string(i), 5};
    entry.key = player_key(static_cast<std::uint8_t>(i % 2 + 1));
    start.chat.push_back(entry);
  }
  // A line of the host that a player with this right wrote.
  start.chat.push_back({{ChatLineKind::server, 0, "", "from the host", 5}, player_key(1)});
  ChatBench bench(chat_config(), start);
  bench.enter(1, 3);
  const std::vector<ChatLine> got = bench.lines(1);
  REQUIRE(got.size() == kChatRecentMax);
  CHECK(got.back() == ChatLine{ChatLineKind::server, 0, "", "from the host", 5});
  CHECK(got[kChatRecentMax - 2].text == "line 54");
  CHECK(got[kChatRecentMax - 2].author == 7);
  CHECK(got[kChatRecentMax - 3].author == 0);  // the number is not known any more
}

TEST_CASE("the host writes to everybody, without a limit, and the key is logged", "[world][chat]") {
  ChatBench bench(chat_config(1));
  bench.enter(1, 1);
  bench.enter(2, 2, kHome, 0);
  CHECK(bench.server.people().chat().say("restart at ten", player_key(9), bench.now()) == 1);
  for (std::size_t i = 0; i < 2 * kChatLinesMax; ++i)
    CHECK(bench.server.people().chat().say("again", {}, bench.now()) == 1);
  bench.tick();
  CHECK(bench.texts(1, ChatLineKind::server).size() == 1 + 2 * kChatLinesMax);
  CHECK(bench.texts(1, ChatLineKind::server)[0] == "restart at ten");
  CHECK(bench.environment.chat[0].key == player_key(9));
}

TEST_CASE("while the disk is full, lines are sent and not logged", "[world][chat]") {
  ChatBench bench;
  bench.enter(1, 1);
  bench.server.set_disk_is_full(true, bench.now());
  bench.write(1, "hello");
  bench.tick();
  CHECK(bench.texts(1) == Texts{"hello"});
  CHECK(bench.environment.chat.empty());
  bench.server.set_disk_is_full(false, bench.now());
  bench.write(1, "again");
  CHECK(bench.environment.chat.size() == 1);
}

TEST_CASE("a session whose queue is full misses the lines, and nobody else", "[world][chat]") {
  ChatBench bench;
  bench.enter(1, 1);
  bench.enter(2, 2);
  bench.environment.full.insert(2);
  bench.write(1, "hello");
  bench.tick();
  CHECK(bench.texts(1) == Texts{"hello"});
  CHECK(bench.texts(2).empty());
  CHECK(bench.environment.closed.empty());
  CHECK(bench.server.counters().queue_full > 0);
}

TEST_CASE("a client without the feature may not write", "[world][chat]") {
  ChatBench bench;
  bench.enter(1, 1, kHome, 0);
  bench.write(1, "hello");
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].reason == GoodbyeReason::unexpected_message);
}

TEST_CASE("withdrawn lines are hidden from everybody, and from players who join later",
          "[world][chat]") {
  constexpr std::uint64_t kHides = kFeatureChat | kFeatureChatWithdrawal;
  ChatBench bench;
  bench.enter(1, 1, kHome, kHides);
  bench.enter(2, 2, kHome, kHides);
  bench.enter(3, 3, kSchool);  // an older client, which cannot hide lines
  bench.write(1, "buy gold");
  bench.write(2, "hello");
  bench.tick(1'000'000);
  bench.write(1, "buy more gold");
  bench.tick(1'000'000);
  bench.write(1, "not sent yet");
  CHECK(bench.server.people().chat().withdraw(player_key(1)) == 3);
  CHECK(bench.server.people().chat().withdraw(player_key(1)) == 0);
  CHECK(bench.server.people().chat().withdraw(player_key(9)) == 0);
  bench.tick();
  const std::vector<ChatLine> read = bench.lines(2);
  REQUIRE(read.size() == 3);
  for (const SessionId session : {1, 2}) {
    const auto withdrawn = bench.environment.messages<ChatWithdrawn>(session, kEdge);
    REQUIRE(withdrawn.size() == 1);
    CHECK(withdrawn[0].lines == std::vector{id_of(read[0]), id_of(read[2])});
  }
  CHECK(bench.environment.messages<ChatWithdrawn>(3, kEdge).empty());
  CHECK(bench.texts(3) == Texts{"buy gold", "hello", "buy more gold"});

  bench.enter(4, 4, kHome, kHides);
  CHECK(bench.texts(4) == Texts{"hello"});
  CHECK(bench.environment.messages<ChatWithdrawn>(4, kEdge).empty());

  // The log has all lines and marks the withdrawn ones. Withdrawn lines still count as lines that
  // the player wrote.
  std::vector<std::pair<std::string, bool>> logged;
  for (const ChatEntry& entry : bench.environment.chat)
    logged.emplace_back(entry.line.text, entry.is_withdrawn);
  CHECK(logged ==
        std::vector<std::pair<std::string, bool>>{
            {"buy gold", true}, {"hello", false}, {"buy more gold", true}, {"not sent yet", true}});
  bench.write(1, "not sent yet");
  CHECK(bench.refused(1).size() == 1);
}

TEST_CASE("withdrawn lines make no room for older ones than the newest that are kept",
          "[world][chat]") {
  ChatBench bench;
  bench.enter(1, 1);
  bench.enter(2, 2);
  for (std::size_t i = 0; i < kChatKeptMax + 10; ++i) {
    bench.write(1 + i % 2, "line " + std::to_string(i));
    bench.tick(1'000'000);
  }
  CHECK(bench.server.people().chat().withdraw(player_key(1)) == kChatKeptMax / 2);
  bench.enter(3, 3);
  const Texts got = bench.texts(3);
  REQUIRE(got.size() == kChatRecentMax);
  CHECK(got.back() == "line " + std::to_string(kChatKeptMax + 9));
  CHECK(got.front() == "line " + std::to_string(kChatKeptMax + 11 - 2 * kChatRecentMax));
}

}  // namespace runstone::test::chat_handlers_test
