#include "client/fleet/bot_options.hpp"

#include <catch2/catch.hpp>
#include <vector>

using namespace runstone;

namespace {

ParsedBotOptions parse(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), {"runstone-bot", "--connect", "localhost:4747"});
  return parse_bot_options(static_cast<int>(arguments.size()), arguments.data());
}

}  // namespace

TEST_CASE("the speed of a play is a number or max", "[client_app][play]") {
  const auto speed = [](std::vector<const char*> more) {
    more.insert(more.begin(), {"--play", "a.rlog"});
    const auto parsed = parse(more);
    REQUIRE(parsed.options.has_value());
    CHECK(parsed.options->play == "a.rlog");
    return parsed.options->speed;
  };
  CHECK(speed({}) == 1);
  CHECK(speed({"--speed", "0.5"}) == 0.5);
  CHECK(speed({"--speed", "0"}) == 0);
  CHECK(speed({"--speed", "max"}) == 0);
  for (const char* wrong : {"-1", "fast", "", "nan", "inf", "1e9", "2x"}) {
    CAPTURE(wrong);
    CHECK(parse({"--play", "a.rlog", "--speed", wrong}).exit_code == 2);
  }
  CHECK(parse({"--speed", "2"}).exit_code == 2);
}

TEST_CASE("bots connect to a server or to the WebSocket of a gateway", "[client_app]") {
  const auto options = [](const char* address, std::vector<const char*> more = {}) {
    more.insert(more.begin(), {"--connect", address});
    return parse(more).options;
  };
  const auto server = options("play.example.org");
  REQUIRE(server.has_value());
  CHECK(server->web_path.empty());
  CHECK(server->more_servers.empty());
  const auto several = options("one.example,two.example:5000");
  REQUIRE(several.has_value());
  CHECK(several->server == HostPort{"one.example", kDefaultPort});
  CHECK(several->more_servers == std::vector<HostPort>{{"two.example", 5000}});
  const auto secure = options("wss://play.example.org/play");
  REQUIRE(secure.has_value());
  CHECK(secure->server == HostPort{"play.example.org", 443});
  CHECK(secure->web_path == "/play");
  CHECK(secure->tls.has_value());
  const auto plain = options("ws://[::1]:8080/world/valley/play");
  REQUIRE(plain.has_value());
  CHECK(plain->server == HostPort{"::1", 8080});
  CHECK(plain->web_path == "/world/valley/play");
  CHECK_FALSE(plain->tls.has_value());
  CHECK(options("ws://localhost/play", {"--insecure"}).has_value());
  CHECK_FALSE(options("wss://localhost/play", {"--insecure"}).has_value());
  for (const char* wrong : {"wss://localhost", "wss://localhost/", "ws:///play",
                            "wss://localhost/play x", "wss://localhost/play?a=b"}) {
    CAPTURE(wrong);
    CHECK_FALSE(options(wrong).has_value());
  }
}

TEST_CASE("the option --play excludes the options of behaviours", "[client_app][play]") {
  for (const char* other : {"--count", "--rate", "--duration", "--edits", "--sites", "--first-site",
                            "--seed", "--view"}) {
    CAPTURE(other);
    CHECK(parse({other, "3"}).options.has_value());
    CHECK(parse({"--play", "a.rlog", other, "3"}).exit_code == 2);
  }
  CHECK(parse({"--play", "a.rlog", "--behaviour", "walk"}).exit_code == 2);
  CHECK(parse({"--play", "a.rlog", "--name", "ada"}).exit_code == 2);
  CHECK(parse({"--play", "a.rlog", "--key-dir", "."}).exit_code == 2);
}

TEST_CASE("a fleet has one behaviour, or several by their shares", "[client_app]") {
  CHECK(parse({}).options->roles == std::vector<BotRole>{BotRole::build});
  CHECK(parse({"--behaviour", "run-away"}).options->roles ==
        std::vector<BotRole>{BotRole::run_away});
  CHECK(parse({"--mix", "idle=2,join-storm=1"}).options->roles ==
        std::vector<BotRole>{BotRole::idle, BotRole::idle, BotRole::join_storm});
  for (const char* wrong :
       {"", "idle", "idle=", "idle=0", "idle=x", "fly=1", "idle=600,walk=600"}) {
    CAPTURE(wrong);
    CHECK(parse({"--mix", wrong}).exit_code == 2);
  }
  CHECK(parse({"--mix", "idle=1", "--behaviour", "walk"}).exit_code == 2);
  CHECK(parse({"--behaviour", "fly"}).exit_code == 2);
  CHECK(parse({"--replicas", "5", "--join-rate", "300"}).options->replicas == 5);
  CHECK(parse({"--join-rate", "0"}).exit_code == 2);
}
