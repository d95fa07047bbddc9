// Access tokens: what a link and a page token are good for, what is stored of them, and the commands
// that make, list and revoke them.
#include "server/admin/access_tokens.hpp"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <string>

#include "server/admin/access_token_store.hpp"
#include "server/admin/command_table.hpp"
#include "server/admin/page_commands.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/core/text_contains.hpp"
#include "tests/unit/server/admin/command_bench.hpp"

namespace runstone::test {
namespace {

constexpr TimeUs kNowUs = TimeUs{1'700'000'000} * 1'000'000;
constexpr PublicKey kAna{7}, kBea{8};

MadeToken link_for(AccessTokens& tokens, const PublicKey& owner, TimeUs now_us = kNowUs) {
  auto made = tokens.make_link(owner, 3, RightSet::all(), now_us);
  REQUIRE(made.has_value());
  return *made;
}

std::string file_text(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A world with a builder and a moderator, whose server has the page or not.
struct TokenBench : CommandBench {
  explicit TokenBench(bool has_page = true)
      : services{bench.server,
                 service,
                 *this,
                 placing,
                 folder.path(),
                 actions(has_page),
                 [](const PublicKey&) { return false; }} {
    join(kBuilder);
    join(kModerator);
    set(kModerator, {1, 1, 1}, 2);
    REQUIRE(bench.server.changes().change_rights(GrantRole{key_of(kModerator), "moderator"}, {}, 0,
                                                 bench.now()));
    run_all();
  }
  static constexpr std::uint8_t kModerator = 9, kStranger = 10;
  static PublicKey key_of(std::uint8_t who) { return key_pair_of(seed_of(who)).public_key; }
  CommandAnswer give(const std::string& line, const CommandCaller& caller = {}) {
    answers.clear();
    give_command({services, caller, bench.now(), reply()}, line);
    for (int i = 0; i < 6; ++i) {
      run_all();
      services.tick(bench.now());
    }
    return answer();
  }
  OperatorActions actions(bool has_page) {
    OperatorActions all;
    std::string warning;
    if (has_page) all.tokens = *AccessTokenStore::open(folder.path(), warning);
    all.page_base = "https://play.example.org";
    return all;
  }
  std::string moderator() { return "player" + std::to_string(kModerator); }

  CommandServices services;
};

}  // namespace

TEST_CASE("a link is exchanged once for a page token of the same player", "[admin][tokens]") {
  AccessTokens tokens;
  const MadeToken link = link_for(tokens, kAna);
  CHECK(link.secret.size() == kTokenDigits);
  CHECK(tokens.find(TokenKind::page, link.secret, kNowUs) == nullptr);
  const auto page = tokens.enter(link.secret, kNowUs + 1);
  REQUIRE(page.has_value());
  CHECK(page->token.owner == kAna);
  CHECK(page->token.author == 3);
  CHECK(page->secret != link.secret);
  CHECK_FALSE(tokens.enter(link.secret, kNowUs + 2).has_value());   // used up
  CHECK_FALSE(tokens.enter(page->secret, kNowUs + 2).has_value());  // it is no link
  REQUIRE(tokens.find(TokenKind::page, page->secret, kNowUs + 2) != nullptr);
  for (const std::string& guess :
       {std::string(), std::string(kTokenDigits, '0'), page->secret.substr(1), page->secret + "0"})
    CHECK(tokens.find(TokenKind::page, guess, kNowUs + 2) == nullptr);
}

TEST_CASE("links and page tokens end, also if the clock goes back far", "[admin][tokens]") {
  AccessTokens tokens;
  const MadeToken late = link_for(tokens, kAna), used = link_for(tokens, kAna);
  const auto page = tokens.enter(used.secret, kNowUs);
  REQUIRE(page.has_value());
  CHECK(tokens.find(TokenKind::link, late.secret, kNowUs + AccessTokens::kLinkUs - 1) != nullptr);
  CHECK_FALSE(tokens.enter(late.secret, kNowUs + AccessTokens::kLinkUs).has_value());
  CHECK(tokens.find(TokenKind::page, page->secret, kNowUs + AccessTokens::kPageUs - 1) != nullptr);
  CHECK(tokens.find(TokenKind::page, page->secret, kNowUs + AccessTokens::kPageUs) == nullptr);
  CHECK(tokens.find(TokenKind::page, page->secret, kNowUs - AccessTokens::kClockBackUsMax - 1) ==
        nullptr);
}

TEST_CASE("a player has a bounded number of links and page tokens", "[admin][tokens]") {
  AccessTokens tokens;
  for (std::size_t i = 0; i < AccessTokens::kOfOwnerMax; ++i) link_for(tokens, kAna);
  CHECK_FALSE(tokens.make_link(kAna, 3, RightSet::all(), kNowUs).has_value());
  link_for(tokens, kBea);  // others are not kept out
  AccessTokens pages;
  const auto first = pages.enter(link_for(pages, kAna).secret, kNowUs);
  REQUIRE(first.has_value());
  for (std::size_t i = 0; i < AccessTokens::kOfOwnerMax; ++i)
    REQUIRE(pages.enter(link_for(pages, kAna).secret, kNowUs).has_value());
  CHECK(pages.find(TokenKind::page, first->secret, kNowUs) == nullptr);
  CHECK(pages.list(kNowUs).size() == AccessTokens::kOfOwnerMax);
}

TEST_CASE("the text of tokens reads back, and no other text does", "[admin][tokens]") {
  AccessTokens tokens;
  link_for(tokens, kAna);
  REQUIRE(tokens.make_link(kBea, 4, {Right::moderate}, kNowUs).has_value());
  const std::string text = tokens.text();
  const auto read = AccessTokens::parse(text);
  REQUIRE(read.has_value());
  CHECK(read->list(kNowUs) == tokens.list(kNowUs));
  CHECK(read->text() == text);
  for (std::size_t i = 0; i < text.size(); ++i) {
    CAPTURE(i);
    const auto part = AccessTokens::parse(text.substr(0, i));
    // A part that ends with a line is a shorter list.
    CHECK(part.has_value() == (i > 0 && text[i - 1] == '\n'));
  }
  const auto with_made = [&](const std::string& made_us) {
    const std::size_t at = text.find(std::to_string(kNowUs));
    return text.substr(0, at) + made_us + text.substr(text.find(' ', at));
  };
  CHECK(AccessTokens::parse(with_made(std::to_string(kNowUs))).has_value());
  CHECK_FALSE(AccessTokens::parse(with_made("-9223372036854775808")).has_value());
  CHECK_FALSE(AccessTokens::parse(with_made("9223372036854775807")).has_value());
  CHECK(AccessTokens::parse("something else\n").error().find("line 1") == 0);
  CHECK(AccessTokens::parse(text + text.substr(text.find('\n') + 1)).error().find("order") !=
        std::string::npos);
}

TEST_CASE("the file of tokens has no secret, is private, and a broken one ends all tokens",
          "[admin][tokens]") {
  const TempFolder folder;
  std::string warning, secret;
  {
    const auto store = *AccessTokenStore::open(folder.path(), warning);
    const auto link = store->make_link(kAna, 3, RightSet::all(), kNowUs);
    REQUIRE(link.has_value());
    const auto page = store->enter(link->secret, kNowUs);
    REQUIRE((page.has_value() && page->has_value()));
    secret = (*page)->secret;
    const std::string text = file_text(folder / kAccessTokensFile);
    CHECK_FALSE(contains(text, secret));
    CHECK_FALSE(contains(text, link->secret));
    struct stat about{};
    REQUIRE(::stat((folder / kAccessTokensFile).c_str(), &about) == 0);
    CHECK((about.st_mode & 0777) == 0600);
  }
  CHECK((*AccessTokenStore::open(folder.path(), warning))
            ->find(TokenKind::page, secret, kNowUs)
            .has_value());
  CHECK(warning.empty());
  std::ofstream(folder / kAccessTokensFile, std::ios::app) << "half a li";
  CHECK_FALSE((*AccessTokenStore::open(folder.path(), warning))
                  ->find(TokenKind::page, secret, kNowUs)
                  .has_value());
  CHECK(contains(warning, "line 3: has no end: all access tokens end"));
}

TEST_CASE("tokens end whose owner has another number in the log of an older world",
          "[admin][tokens]") {
  const TempFolder folder;
  std::string warning;
  const auto store = *AccessTokenStore::open(folder.path(), warning);
  REQUIRE(store->make_link(kAna, 3, RightSet::all(), kNowUs).has_value());
  REQUIRE(store->make_link(kBea, 4, RightSet::all(), kNowUs).has_value());
  const auto none = store->end_of_others({{3, kAna, "ana"}, {4, kBea, "bea"}}, kNowUs);
  REQUIRE(none.has_value());
  CHECK(*none == 0);
  const auto one = store->end_of_others({{3, kAna, "ana"}, {4, PublicKey{9}, "eve"}}, kNowUs);
  REQUIRE(one.has_value());
  CHECK(*one == 1);
  const auto moved = store->end_of_others({{5, kAna, "ana"}}, kNowUs);
  REQUIRE(moved.has_value());
  CHECK(*moved == 1);
  CHECK(store->list(kNowUs).empty());
}

TEST_CASE("page link is for players with a right that the page needs", "[admin][tokens]") {
  TokenBench off(false);
  CHECK(contains(off.give("page link " + off.moderator()).text, "operators_page turns it on"));
  CHECK_FALSE(off.give("page list").is_ok);
  TokenBench bench;
  bench.join(TokenBench::kStranger);
  REQUIRE(bench.give("grant player" + std::to_string(TokenBench::kStranger) + " moderator").is_ok);
  CHECK(contains(bench.give("page link player" + std::to_string(TokenBench::kStranger)).text,
                 "has no record"));
  CHECK(contains(bench.give("page link nobody").text, "page link \"nobody\""));
  CHECK(contains(bench.give("page link player" + std::to_string(kBuilder)).text, "has no right"));
  CHECK(contains(bench.give("page link " + bench.moderator() + " rights build").text,
                 "page link rights: name one of"));
  const CommandAnswer made = bench.give("page link " + bench.moderator());
  INFO(made.text);
  REQUIRE(made.is_ok);
  CHECK(made.text.find("https://play.example.org/operators/enter?link=") == 0);
  CHECK(contains(made.text, "works once, within 10 minutes"));
  CHECK(contains(bench.give("page list").text, "1 link "));
  CHECK_FALSE(contains(bench.give("page list").text, made.text.substr(46, kTokenDigits)));
  CHECK(bench.give("page revoke 7").is_ok == false);
  CHECK(contains(bench.give("page revoke 1").text, "1 token revoked"));
  CHECK(contains(bench.give("page list").text, "nobody has a link"));
  REQUIRE(bench.give("page link " + bench.moderator()).is_ok);
  CHECK(contains(bench.give("page revoke " + bench.moderator()).text, "1 token revoked"));
  REQUIRE(bench.give("page link " + bench.moderator()).is_ok);
  CHECK(contains(bench.give("page revoke all").text, "1 token revoked"));
  const CommandCaller player{TokenBench::kModerator,
                             {TokenBench::key_of(TokenBench::kModerator), false}};
  CHECK(contains(bench.give("page link " + bench.moderator(), player).text, "for the console"));
  CHECK(contains(bench.give("page list", player).text, "needs the right administer"));
}

TEST_CASE("a token of a smaller scope gives fewer commands than its owner", "[admin][tokens]") {
  TokenBench bench;
  CommandCaller caller{TokenBench::kModerator,
                       {TokenBench::key_of(TokenBench::kModerator), false},
                       std::nullopt,
                       {Right::roll_back}};
  CHECK(bench.give("rollback list", caller).is_ok);
  CHECK(contains(bench.give("bans", caller).text,
                 "the token in use is for commands that need roll_back"));
  caller.actor.is_operator = true;  // every right, and nevertheless the scope
  CHECK_FALSE(bench.give("stop", caller).is_ok);
  caller.scope = RightSet::all();
  CHECK(bench.give("bans", caller).is_ok);
}

TEST_CASE("who is banned or has lost the role has no right for the page", "[admin][tokens]") {
  TokenBench bench;
  const PublicKey key = TokenBench::key_of(TokenBench::kModerator);
  const auto rights = [&](RightSet scope = RightSet::all()) {
    return page_rights(bench.bench.server.rights().state(), {key, false}, scope,
                       bench.bench.server.rights().time());
  };
  CHECK(rights().has(Right::moderate));
  CHECK(rights({Right::roll_back}) == RightSet{Right::roll_back});
  REQUIRE(bench.give("ban " + bench.moderator()).is_ok);
  CHECK(rights() == RightSet());
  REQUIRE(bench.give("unban " + bench.moderator()).is_ok);
  CHECK(rights().has(Right::moderate));
  REQUIRE(bench.give("revoke " + bench.moderator()).is_ok);
  CHECK(rights() == RightSet());
}

}  // namespace runstone::test
