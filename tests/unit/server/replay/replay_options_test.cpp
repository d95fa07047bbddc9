#include "server/replay/replay_options.hpp"

#include <catch2/catch.hpp>
#include <sstream>
#include <vector>

using namespace runstone;

namespace {

ParsedReplayOptions parse(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), {"runstone-replay", "--world", "w"});
  std::ostringstream out, err;
  return parse_replay_options(static_cast<int>(arguments.size()), arguments.data(), out, err);
}

}  // namespace

TEST_CASE("a log is played into a server at a speed", "[server][replay]") {
  const auto plain = parse({"--into", "localhost:4747"});
  REQUIRE(plain.options.has_value());
  CHECK(plain.options->into == "localhost:4747");
  CHECK(plain.options->speed == "1");
  for (const char* speed : {"0", "max", "2.5", "1000000"}) {
    CAPTURE(speed);
    const auto parsed =
        parse({"--into", "localhost:4747", "--speed", speed, "--at", "7", "--bot", "./bot"});
    REQUIRE(parsed.options.has_value());
    CHECK(parsed.options->speed == speed);
    CHECK(parsed.options->bot == "./bot");
    CHECK(parsed.options->moment.has_value());
  }
  for (const char* wrong : {"-1", "fast", "", "nan", "1000001"}) {
    CAPTURE(wrong);
    CHECK(parse({"--into", "localhost:4747", "--speed", wrong}).exit_code == 2);
  }
  CHECK(parse({"--speed", "2"}).exit_code == 2);
  CHECK(parse({"--bot", "./bot"}).exit_code == 2);
}

TEST_CASE("one run of the program does one thing", "[server][replay]") {
  const std::vector<std::vector<const char*>> modes = {
      {"--export", "f"},    {"--import", "f"},    {"--keyframes"},   {"--write", "d"},
      {"--diff", "1", "2"}, {"--timelapse", "d"}, {"--into", "h:1"}, {"--bench"}};
  for (std::size_t a = 0; a < modes.size(); ++a) {
    CAPTURE(modes[a][0]);
    CHECK(parse(modes[a]).options.has_value());
    for (std::size_t b = 0; b < modes.size(); ++b) {
      if (a == b) continue;
      CAPTURE(modes[b][0]);
      auto both = modes[a];
      both.insert(both.end(), modes[b].begin(), modes[b].end());
      CHECK(parse(both).exit_code == 2);
    }
    auto verified = modes[a];
    verified.push_back("--verify");
    CHECK(parse(verified).exit_code == 2);
  }
  CHECK(parse({"--rounds", "3"}).exit_code == 2);
  CHECK(parse({"--bench", "--rounds", "0"}).exit_code == 2);
  CHECK(parse({"--bench", "--rounds", "3"}).options->rounds == 3);
}
