#include "server/replay/replay_program.hpp"

#include <CLI/CLI.hpp>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "server/replay/replay_commands.hpp"
#include "tests/support/replay/run_replay.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

/// Returns true if the arguments, behind --world w, are a valid command line. They are stored in
/// `options`.
template <class Options>
bool parses(void (*declare)(SubcommandOptions&, Options&), std::vector<std::string> arguments,
            Options& options) {
  CLI::App app;
  app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  SubcommandOptions command_line(app);
  declare(command_line, options);
  arguments.insert(arguments.begin(), {"--world", "w"});
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::ParseError&) {
    return false;
  }
  return true;
}

}  // namespace

TEST_CASE("a flag of the old command line fails and names its subcommand", "[server][replay]") {
  const std::vector<std::pair<std::vector<std::string>, std::string>> old = {
      {{"--world", "w", "--verify"}, "--verify is a subcommand now: runstone-replay verify "},
      {{"--world", "w", "--diff", "1", "2"}, "runstone-replay diff --world DIR --from A --to B"},
      {{"--world", "w", "--at", "7", "--write", "d"}, "runstone-replay copy "},
      {{"--export=f", "--world", "w"}, "runstone-replay export "},
      {{"--world", "w", "--import", "f"}, "runstone-replay import "},
      {{"--world", "w", "--into", "h:1"}, "runstone-replay play "},
      {{"--world", "w", "--timelapse", "d"}, "runstone-replay timelapse "},
      {{"--world", "w", "--keyframes"}, "runstone-replay keyframes "},
      {{"--world", "w", "--bench"}, "runstone-replay bench "},
      {{"--world", "w"}, "a subcommand comes first, such as: runstone-replay verify "},
      {{}, "a subcommand comes first"}};
  for (const auto& [arguments, said] : old) {
    CAPTURE(said);
    const ReplayOutcome outcome = run_replay(arguments);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK(outcome.err.starts_with("runstone-replay: "));
    CHECK(outcome.err.find(said) != std::string::npos);
  }
}

TEST_CASE("a mistyped address of a database is neither a world nor a folder", "[server][replay]") {
  for (const std::string& bad :
       {std::string("postgre://ana:secret@h/d"), std::string("host=localhost dbname=x")}) {
    CAPTURE(bad);
    for (const std::vector<std::string>& line :
         std::vector<std::vector<std::string>>{{"verify", "--world", bad},
                                               {"import", "--world", bad, "f.rlog"},
                                               {"copy", "--world", "w", bad},
                                               {"timelapse", "--world", "w", bad}}) {
      const ReplayOutcome outcome = run_replay(line);
      CHECK(outcome.code == 2);
      CHECK(outcome.err.find("postgresql://") != std::string::npos);
      CHECK(outcome.err.find("secret") == std::string::npos);
    }
  }
}

TEST_CASE("a subcommand that does not exist, or lacks its world, exits with 2",
          "[server][replay]") {
  const ReplayOutcome unknown = run_replay({"verfy", "--world", "w"});
  CHECK(unknown.code == 2);
  CHECK(
      unknown.err ==
      "runstone-replay: \"verfy\" is no subcommand: verify, diff, copy, export, dump, import, play, "
      "timelapse, keyframes, bench\n");
  const ReplayOutcome extra = run_replay({"verify", "--world", "w", "--fast", "now"});
  CHECK(extra.code == 2);
  CHECK(extra.err == "runstone-replay: unexpected argument \"--fast\"\n");
  CHECK(run_replay({"verify"}).code == 2);
  CHECK(run_replay({"export", "--world", "w"}).code == 2);  // no file
  CHECK(run_replay({"verify", "--world", "w", "diff", "--world", "w"}).code == 2);
}

TEST_CASE("help lists the subcommands, and the options of one", "[server][replay]") {
  const ReplayOutcome all = run_replay({"--help"});
  CHECK(all.code == 0);
  for (const char* name :
       {"verify", "diff", "copy", "export", "import", "play", "timelapse", "keyframes", "bench"}) {
    CAPTURE(name);
    CHECK(all.out.find("\n  " + std::string(name) + " ") != std::string::npos);
    const ReplayOutcome one = run_replay({name, "--help"});
    CHECK(one.code == 0);
    CHECK(one.out.find("--world") != std::string::npos);
  }
}

TEST_CASE("a log is played at a speed", "[server][replay]") {
  PlayOptions plain;
  REQUIRE(parses(declare_play, {"--connect", "localhost:4747"}, plain));
  CHECK(plain.common.world == "w");
  CHECK(plain.connect == "localhost:4747");
  CHECK(plain.speed == "1");
  CHECK_FALSE(plain.at.has_value());
  for (const std::string speed : {"0", "max", "2.5", "1000000"}) {
    CAPTURE(speed);
    PlayOptions options;
    REQUIRE(parses(declare_play, {"--connect", "h:1", "--speed", speed, "--at", "7", "--bot", "b"},
                   options));
    CHECK(options.speed == speed);
    CHECK(options.bot == "b");
    CHECK(options.at == NamedMoment{Sequence{7}});
  }
  for (const std::string wrong : {"-1", "fast", "", "nan", "1000001", "2x"}) {
    CAPTURE(wrong);
    PlayOptions options;
    CHECK_FALSE(parses(declare_play, {"--connect", "h:1", "--speed", wrong}, options));
  }
  PlayOptions options;
  CHECK_FALSE(parses(declare_play, {"--speed", "2"}, options));  // no server
}

TEST_CASE("a difference needs both moments", "[server][replay]") {
  DiffOptions options;
  REQUIRE(parses(declare_diff, {"--from", "-2h30m", "--to", "9"}, options));
  CHECK(options.from == NamedMoment{BeforeEnd{9'000'000'000}});
  CHECK(options.to == NamedMoment{Sequence{9}});
  DiffOptions one;
  CHECK_FALSE(parses(declare_diff, {"--from", "9"}, one));
  CHECK_FALSE(parses(declare_diff, {"--from", "9", "--to", "soon"}, one));
}

TEST_CASE("numbers of a command line have bounds", "[server][replay]") {
  BenchOptions bench;
  CHECK(parses(declare_bench, {"--rounds", "3"}, bench));
  CHECK(bench.rounds == 3);
  CHECK_FALSE(parses(declare_bench, {"--rounds", "0"}, bench));
  CHECK_FALSE(parses(declare_bench, {"--rounds", "1001"}, bench));

  TimelapseCommandOptions drawn;
  REQUIRE(parses(declare_timelapse,
                 {"frames", "--from", "0", "--size", "64x48", "--radius", "0", "--fps", "60"},
                 drawn));
  CHECK(drawn.timelapse.folder == "frames");
  CHECK(drawn.timelapse.from == Sequence{0});
  CHECK(drawn.timelapse.size == PictureSize{64, 48});
  CHECK(drawn.timelapse.radius == 0);
  CHECK(drawn.fps == 60);
  for (const std::vector<std::string>& wrong : {std::vector<std::string>{"--size", "64"},
                                                {"--size", "15x64"},
                                                {"--size", "64x8193"},
                                                {"--size", "64x48 "},
                                                {"--size", "65552x64"},
                                                {"--from", "-1"},
                                                {"--every", "0"},
                                                {"--radius", "33"},
                                                {"--fps", "121"},
                                                {"--camera", "/no/such/file"}}) {
    CAPTURE(wrong);
    auto arguments = wrong;
    arguments.insert(arguments.begin(), "frames");
    TimelapseCommandOptions options;
    CHECK_FALSE(parses(declare_timelapse, arguments, options));
  }
}
