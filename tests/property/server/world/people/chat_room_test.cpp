// Whatever players send, and however fast, the chat stays within its bounds. The oracle counts what the
// players got, by time, and shares no code with the buckets.
#include <algorithm>
#include <catch2/catch.hpp>
#include <deque>
#include <map>
#include <utility>

#include "common/core/hash.hpp"
#include "server/world/people/chat_room.hpp"
#include "tests/unit/server/world/world_bench.hpp"

namespace runstone::test::chat_property_test {
namespace {

constexpr std::uint64_t kPerMinute = 20, kAtOnce = 10, kBudgetsPerAddress = 2;
constexpr std::uint8_t kPlayers = 6;
constexpr TimeUs kMinuteUs = 60'000'000;

AddressBlock address_of(std::uint8_t who) { return address_block_v4(who % 2); }

/// The lines that one payer wrote within the last minute.
class MinuteOracle {
 public:
  explicit MinuteOracle(std::uint64_t budgets) : budgets_(budgets) {}
  /// Returns true if the bound allows the line: what comes back in a minute, and what was there.
  bool allows(TimeUs now_us) {
    while (!times_.empty() && times_.front() <= now_us - kMinuteUs) times_.pop_front();
    times_.push_back(now_us);
    return times_.size() <= budgets_ * (kPerMinute + kAtOnce);
  }

 private:
  std::uint64_t budgets_;
  std::deque<TimeUs> times_;
};

std::string random_line(SplitMix64& rng) {
  switch (rng.below(5)) {
    case 0:
      return "the same line";
    case 1:
      return std::string(1 + rng.below(512), ' ');
    case 2:
      return "hidden \xe2\x80\xae" + std::to_string(rng.below(100));
    case 3:
      return std::string(kChatBytesMax - 20, 'x') + std::to_string(rng.below(1'000'000));
    default:
      return "line " + std::to_string(rng.below(1'000'000));
  }
}

}  // namespace

TEST_CASE(
    "random chat stays within the bounds of players, addresses, messages and the newest lines",
    "[world][chat][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  CAPTURE(Catch::rngSeed());
  WorldConfig c = config();
  c.chat_budget = chat_budget(kPerMinute);
  c.budgets_per_address = kBudgetsPerAddress;
  c.idle_us_max = 1'000'000'000'000;
  c.message_of_the_day = "build with care";
  WorldBench bench(std::move(c));
  SessionId newest = 0;
  std::map<SessionId, std::uint8_t> open;
  const auto enter = [&](std::uint8_t who) {
    const SessionId session = ++newest;
    bench.server.connected(session, bench.now(), address_of(who));
    Hello hello = bench.hello(who, session);
    hello.features = kFeatureChat;
    bench.server.received(session, hello, bench.now());
    const auto welcome = bench.environment.messages<Welcome>(session, 0);
    bench.server.received(session, bench.client_auth(who, hello, welcome.at(0)), bench.now());
    open[session] = who;
    const auto recent = bench.environment.messages<ChatLines>(session, kEdge);
    REQUIRE(recent.size() == 1);
    REQUIRE(recent[0].lines.size() <= kChatRecentMax + 1);
    CHECK(recent[0].lines.back().kind == ChatLineKind::message_of_the_day);
  };
  std::map<PublicKey, MinuteOracle> keys;
  std::map<AddressBlock, MinuteOracle> addresses;
  std::map<SessionId, std::uint64_t> refused;
  struct Passed {
    std::uint64_t number = 0;
    TimeUs utc_us = 0;
  };
  std::map<std::pair<AuthorId, std::string>, Passed> passed;  // the last time
  std::uint64_t number = 0;                                   // of the last line that was passed on
  for (int step = 0; step < 4'000; ++step) {
    CAPTURE(step);
    if (open.size() < 3 || rng.below(60) == 0)
      enter(static_cast<std::uint8_t>(1 + rng.below(kPlayers)));
    if (open.size() > 8) {
      bench.server.disconnected(open.begin()->first);
      open.erase(open.begin());
    }
    bench.environment.sent.clear();
    bench.environment.chat.clear();
    for (std::uint64_t i = rng.below(30); i > 0; --i) {
      auto from = open.begin();
      std::advance(from,
                   static_cast<std::ptrdiff_t>(rng.below(static_cast<std::uint32_t>(open.size()))));
      bench.server.received(from->first, ChatRequest{random_line(rng)}, bench.now());
    }
    if (rng.below(100) == 0)
      bench.server.people().chat().say("a word of the host", {}, bench.now());
    const TimeUs accepted_us = bench.time_us;
    bench.tick(static_cast<TimeUs>(rng.below(rng.below(20) == 0 ? 40'000'000 : 400'000)));
    for (const ChatEntry& entry : bench.environment.chat) {
      ++number;
      if (entry.line.kind == ChatLineKind::server) continue;
      CHECK(entry.line.text.find("hidden") == std::string::npos);
      const auto who = static_cast<std::uint8_t>(entry.line.name.back() - '0');
      CHECK(keys.try_emplace(entry.key, 1).first->second.allows(accepted_us));
      CHECK(addresses.try_emplace(address_of(who), kBudgetsPerAddress)
                .first->second.allows(accepted_us));
      const auto [last, is_new] =
          passed.try_emplace({entry.line.author, entry.line.text}, Passed{number, 0});
      if (!is_new && number - last->second.number <= kChatRecentMax)
        CHECK(entry.line.utc_us - last->second.utc_us >= kChatRepeatUs);
      last->second = {number, entry.line.utc_us};
    }
    for (const auto& [session, who] : open) {
      for (const ChatLines& message : bench.environment.messages<ChatLines>(session, kEdge)) {
        REQUIRE(message.lines.size() <= kChatLinesMax);
        if (message.lines[0].kind == ChatLineKind::refused) ++refused[session];
      }
      REQUIRE(refused[session] <=
              kChatAnswerBurst + kChatAnswersPerSecond *
                                     static_cast<std::uint64_t>(bench.time_us / 1'000'000 + 1));
    }
  }
  CHECK(keys.size() == kPlayers);
}

}  // namespace runstone::test::chat_property_test
