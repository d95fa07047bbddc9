// Lines of the chat that a ban or the command `chat withdraw` hides.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "protocol/codec/key_fingerprint.hpp"
#include "server/admin/command_table.hpp"
#include "tests/support/core/text_contains.hpp"
#include "tests/unit/server/admin/command_bench.hpp"

namespace runstone::test {
namespace {

constexpr AddressBlock kOutside = address_block_v4(0xc000'0207);

/// Two players who write, one of them from outside, a moderator, and one who reads.
struct WithdrawalBench : CommandBench {
  WithdrawalBench()
      : services{bench.server,
                 service,
                 *this,
                 placing,
                 folder.path(),
                 {},
                 [](const PublicKey&) {
              return false; }} {
    for (const std::uint8_t who : {kMole, kAna, kModerator, kReader})
      bench.join(who, who, 1, who == kMole ? kOutside : AddressBlock{},
                 kFeatureChat | kFeatureChatWithdrawal);
    const GrantRole grant{key_of(kModerator), "moderator"};
    REQUIRE(bench.server.changes().change_rights(grant, {}, 0, bench.now()));
    say(kMole, "buy gold");
    say(kAna, "hello");
    say(kMole, "buy more gold");
    bench.tick();
  }
  static constexpr std::uint8_t kMole = 5, kAna = 6, kModerator = 7, kReader = 8;
  static PublicKey key_of(std::uint8_t who) { return key_pair_of(seed_of(who)).public_key; }
  static std::string text_of(std::uint8_t who) { return key_fingerprint(key_of(who)); }
  void say(std::uint8_t who, const std::string& text) {
    bench.server.received(who, ChatRequest{text}, bench.now());
  }
  CommandAnswer give(const CommandCaller& caller, const std::string& line) {
    answers.clear();
    give_command({services, caller, bench.now(), reply()}, line);
    for (int i = 0; i < 3; ++i) {
      run_all();
      services.tick(bench.now());
    }
    return answer();
  }
  CommandAnswer player(std::uint8_t who, const std::string& line) {
    return give({who, {key_of(who), false}}, line);
  }
  /// Returns the number of lines that the reader was asked to hide.
  std::size_t hidden() const {
    std::size_t count = 0;
    for (const auto& message : bench.environment.messages<ChatWithdrawn>(kReader, kEdge))
      count += message.lines.size();
    return count;
  }

  CommandServices services;
};

}  // namespace

TEST_CASE("a ban hides the newest lines of the player, and a mute does not", "[admin][chat]") {
  WithdrawalBench bench;
  const std::string mole = WithdrawalBench::text_of(WithdrawalBench::kMole);
  CHECK_FALSE(contains(bench.give({}, "mute " + mole).text, "withdrawn"));
  CHECK(bench.hidden() == 0);
  const CommandAnswer banned = bench.give({}, "ban " + mole + " for 1h");
  CHECK(banned.is_ok);
  CHECK(contains(banned.text, "; sessions ended: 1; lines of the chat withdrawn: 2"));
  CHECK(bench.hidden() == 2);
  CHECK_FALSE(contains(bench.give({}, "ban " + mole + " for 2h").text, "withdrawn"));
}

TEST_CASE("a ban of addresses hides the lines of those whom it ends", "[admin][chat]") {
  WithdrawalBench bench;
  CHECK(contains(bench.give({}, "ban 192.0.2.0/24").text, "; lines of the chat withdrawn: 2"));
  CHECK(bench.hidden() == 2);
}

TEST_CASE("moderators withdraw lines of those who have fewer rights, and of nobody else",
          "[admin][chat]") {
  WithdrawalBench bench;
  const std::string mole = WithdrawalBench::text_of(WithdrawalBench::kMole);
  const std::string moderator = WithdrawalBench::text_of(WithdrawalBench::kModerator);
  CHECK_FALSE(bench.player(WithdrawalBench::kAna, "chat withdraw " + mole).is_ok);
  const CommandAnswer nobody =
      bench.player(WithdrawalBench::kModerator, "chat withdraw " + mole + " bert");
  CHECK_FALSE(nobody.is_ok);
  CHECK(nobody.text.starts_with("nothing has changed: "));
  CHECK(bench.hidden() == 0);
  const CommandAnswer done =
      bench.player(WithdrawalBench::kModerator, "chat withdraw " + mole + " " + moderator);
  CHECK(contains(done.text, mole + ": lines of the chat withdrawn: 2\n"));
  CHECK(done.text.ends_with(" has no line among the newest ones of the chat"));
  CHECK(bench.hidden() == 2);

  const GrantRole grant{WithdrawalBench::key_of(WithdrawalBench::kAna), "administrator"};
  REQUIRE(bench.bench.server.changes().change_rights(grant, {}, 0, bench.bench.now()));
  const std::string ana = WithdrawalBench::text_of(WithdrawalBench::kAna);
  CHECK_FALSE(bench.player(WithdrawalBench::kModerator, "chat withdraw " + ana).is_ok);
  CHECK(bench.hidden() == 2);
}

}  // namespace runstone::test
