#include "server/admin/log_selection.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "server/admin/command_table.hpp"
#include "tests/support/core/text_contains.hpp"
#include "tests/unit/server/admin/command_bench.hpp"

namespace runstone::test {
namespace {

constexpr std::uint8_t kHost = 5, kFirstKey = 10, kKeys = 12;

/// A builder, and twelve keys of one griefer: player10 to player21, all from one address.
struct TwelveKeys : CommandBench {
  TwelveKeys()
      : services{bench.server,
                 service,
                 *this,
                 placing,
                 folder.path(),
                 {},
                 [](const PublicKey&) {
                   return false; }} {
    come(kHost, address_block_v4(77));
    set(kHost, {1, 1, 1}, 2);
    for (std::uint8_t i = 0; i < kKeys; ++i) {
      const auto who = static_cast<std::uint8_t>(kFirstKey + i);
      come(who, address_block_v4(99));
      set(who, {i, 2, 3}, 1);
    }
    write_log();
  }
  void come(std::uint8_t who, AddressBlock from) {
    bench.join(who, who, 1, from);
    bench.view(who, View{1, {0, 0, 0}, 4, 1});
  }
  CommandAnswer give(const std::string& line) {
    answers.clear();
    give_command({services, {}, bench.now(), reply()}, line);
    run_all();
    return answer();
  }
  std::string all_text() const {
    std::string text;
    for (const CommandAnswer& each : answers) text += each.text + "\n";
    return text;
  }
  CommandServices services;
};

}  // namespace

TEST_CASE("twelve keys of one griefer are rolled back with one line", "[admin][rollback]") {
  TwelveKeys night;
  for (const char* line :
       {"rollback preview author player1* author player2*", "rollback preview address-of player14",
        "rollback preview not author player5 since 1w"}) {
    CAPTURE(line);
    const CommandAnswer preview = night.give(line);
    CHECK(preview.is_ok);
    CHECK(contains(preview.text, "would take back 12 edits"));
  }
  CHECK(night.give("rollback apply p2").is_ok);
  CHECK(night.at({3, 2, 3}) == kEmpty);
  CHECK(night.at({1, 1, 1}) == 2);
}

TEST_CASE("players are left out of a pattern, and the answer names whom it selects",
          "[admin][rollback]") {
  TwelveKeys night;
  const CommandAnswer preview = night.give("rollback preview author player1* not author player14");
  CHECK(contains(preview.text, "would take back 9 edits"));
  CHECK(contains(night.all_text(), "author \"player1*\": 10 players: player10 #2 "));
  CHECK(contains(night.give("log author player2* limit 5").text, "player20"));
}

TEST_CASE("a pattern that selects everybody, and a filter without a limit, must be confirmed",
          "[admin][rollback]") {
  TwelveKeys night;
  const CommandAnswer all = night.give("rollback preview author *");
  CHECK_FALSE(all.is_ok);
  CHECK(
      contains(all.text, "nothing has changed: \"*\" selects everybody who has built, 13 players"));
  CHECK(contains(all.text, "rollback preview author * anyway"));
  CHECK(night.give("rollback preview author * anyway").is_ok);
  const CommandAnswer others = night.give("rollback preview not author player5");
  CHECK_FALSE(others.is_ok);
  CHECK(contains(others.text, "selects the edits of everybody else"));
  CHECK(night.give("rollback preview not author player5 anyway").is_ok);
  CHECK(night.give("log author *").is_ok);  // a list changes nothing
}

TEST_CASE("an address that very many players or all of them share must be confirmed",
          "[admin][rollback]") {
  TwelveKeys night;
  for (std::uint8_t i = 0; i < 5; ++i) {
    const auto who = static_cast<std::uint8_t>(30 + i);
    night.come(who, address_block_v4(99));
    night.set(who, {i, 4, 3}, 1);
  }
  night.write_log();
  const CommandAnswer many = night.give("rollback preview address-of player14");
  CHECK_FALSE(many.is_ok);
  CHECK(contains(many.text, "address-of \"player14\" selects 17 players"));
  CHECK(contains(night.give("rollback preview address-of player14 anyway").text,
                 "would take back 17 edits"));
  CHECK(night.give("log address-of player14").is_ok);

  CommandBench proxy;
  for (std::uint8_t who = 1; who <= 2; ++who) {
    proxy.bench.join(who, who, 1, address_block_v4(99));
    proxy.bench.view(who, View{1, {0, 0, 0}, 4, 1});
    proxy.set(who, {who, 2, 3}, 1);
  }
  proxy.write_log();
  CommandServices services = proxy.services();
  give_command({services, {}, proxy.bench.now(), proxy.reply()},
               "rollback preview address-of player1");
  proxy.run_all();
  CHECK_FALSE(proxy.answer().is_ok);
  CHECK(contains(proxy.answer().text,
                 "address-of \"player1\" selects everybody who has built, 2 players"));
}

TEST_CASE("a pattern that is the name of a player from before is refused with words for both",
          "[admin][rollback]") {
  TwelveKeys night;
  night.bench.environment.players.push_back({99, PublicKey{7}, "player1*"});
  night.set(kHost, {1, 1, 2}, 2);
  night.write_log();
  const CommandAnswer both = night.give("rollback preview author player1*");
  CHECK_FALSE(both.is_ok);
  CHECK(contains(both.text, "author \"player1*\": that is also the name of a player; it may mean"));
  CHECK(contains(both.text, "(say #99), or the pattern (say \"player1**\")"));
  CHECK(contains(night.give("rollback preview author player1**").text, "would take back 10 edits"));
}

TEST_CASE("words about players that mean nobody are refused by name", "[admin][rollback]") {
  TwelveKeys night;
  CHECK(night.give("rollback preview author grief*").text ==
        "rollback preview author \"grief*\": nobody of such a name is known here");
  CHECK(contains(night.give("rollback preview author player5 not author player5").text,
                 "leave nobody"));
  CHECK(contains(night.give("log not author nobody").text,
                 "log \"nobody\": nobody of that name is known here"));
  CHECK(contains(night.give("rollback preview joined-after 2100-01-01").text, "leave nobody"));
}

TEST_CASE("joined-after selects new players, and narrows a list of authors", "[admin][rollback]") {
  TwelveKeys night;
  const CommandAnswer all = night.give("rollback preview joined-after 1w");
  CHECK_FALSE(all.is_ok);
  CHECK(contains(all.text, "joined-after selects everybody who has built, 13 players"));
  CHECK(contains(night.give("rollback preview joined-after 1w anyway").text,
                 "would take back 13 edits"));
  CHECK(contains(night.give("rollback preview joined-after 1w not author player5").text,
                 "would take back 12 edits"));
  CHECK(night.give("log joined-after 1w").is_ok);  // a list changes nothing
  CHECK(contains(night.give("rollback preview author player1* joined-after 1w").text,
                 "would take back 10 edits"));
}

}  // namespace runstone::test
