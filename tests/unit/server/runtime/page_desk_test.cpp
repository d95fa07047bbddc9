// PageDesk: what a gateway may send, also one that somebody else has taken over.
#include "server/runtime/page_desk.hpp"

#include <catch2/catch.hpp>
#include <memory>
#include <string>

#include "server/runtime/logging.hpp"
#include "server/runtime/read_clocks.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/core/text_contains.hpp"

namespace runstone::test {
namespace {

constexpr PublicKey kOperator{7};

/// A desk with one page token, whose server keeps the commands that it gets.
struct DeskBench {
  DeskBench() {
    start_logging(LogLevel::error);
    const auto link = tokens->make_link(kOperator, 3, RightSet::all(), read_clocks().utc_us);
    REQUIRE(link.has_value());
    const CommandAnswer entered = ask("enter " + link->secret);
    REQUIRE(entered.is_ok);
    secret = entered.text.substr(entered.text.find("token ") + 6, kTokenDigits);
    CHECK(ask("enter " + link->secret).text == kPageUnknown);  // it works once
  }
  /// Returns the answer to one line.
  CommandAnswer ask(const std::string& line) {
    CommandAnswer out;
    asio::thread_pool workers(1);
    PageDesk desk(*tokens, workers, folder.path(), server());
    desk.take(line, [&out](const CommandAnswer& answer) { out = answer; });
    workers.join();
    return out;
  }
  PageDesk::Server server() {
    PageDesk::Server out;
    out.give = [this](const AccessToken&, const std::string& line, const CommandReply& reply) {
      given += line + "\n";
      reply(CommandAnswer::last(kPageKnown));
    };
    out.describe = [](const AccessToken&, const CommandReply& reply) {
      reply(CommandAnswer::last(kPageKnown));
    };
    out.rights = [](const AccessToken&, const std::function<void(RightSet)>& then) {
      then(RightSet());
    };
    return out;
  }
  std::unique_ptr<AccessTokenStore> open() {
    std::string warning;
    return *AccessTokenStore::open(folder.path(), warning);
  }

  const TempFolder folder;
  const std::unique_ptr<AccessTokenStore> tokens = open();
  std::string secret, given;
};

}  // namespace

TEST_CASE("a command needs the token and the key of its forms", "[server]") {
  DeskBench bench;
  const std::string key = page_form_key(bench.secret);
  CHECK(bench.ask("do " + bench.secret + " " + key + " bans").is_ok);
  CHECK(bench.given == "bans\n");
  for (const std::string& line :
       {"do " + bench.secret + " bans", "do " + bench.secret + " " + bench.secret + " bans",
        "do " + bench.secret + " " + std::string(64, '0') + " bans",
        "do " + key + " " + key + " bans", "look " + bench.secret + " ban eve",
        "look " + bench.secret + " \"stop\"", "picture " + bench.secret + " ../p1 before",
        "picture " + bench.secret + " p1 before", "leave " + bench.secret,
        "leave " + bench.secret + " " + bench.secret, "give " + bench.secret + " " + key + " bans",
        std::string()}) {
    CAPTURE(line);
    CHECK_FALSE(bench.ask(line).is_ok);
  }
  CHECK(bench.given == "bans\n");
  CHECK(bench.ask("leave " + bench.secret + " " + key).is_ok);
  CHECK(bench.ask("do " + bench.secret + " " + key + " bans").text == kPageUnknown);
}

TEST_CASE("a gateway cannot write control characters into the log of the server", "[server]") {
  DeskBench bench;
  const std::string begin = "do " + bench.secret + " " + page_form_key(bench.secret) + " ";
  for (const char* command : {"bans\r", "bans \x1b[2J", "bans \xff", "\x7f", "\xc2\x85"}) {
    const CommandAnswer refused = bench.ask(begin + command);
    CHECK_FALSE(refused.is_ok);
    CHECK(contains(refused.text, "printable"));
  }
  CHECK(bench.given.empty());
}

}  // namespace runstone::test
