#include "server/replay/replay_options.hpp"

#include <CLI/CLI.hpp>

namespace runstone {
namespace {

/// As runstone-bot takes it: told before the log is exported.
bool is_speed(const std::string& text) {
  double speed = 0;
  return text == "max" ||
         (CLI::detail::lexical_cast(text, speed) && speed >= 0 && speed <= 1'000'000);
}

}  // namespace

ParsedReplayOptions parse_replay_options(int argc, const char* const* argv, std::ostream& out,
                                         std::ostream& err) {
  ReplayOptions options;
  CLI::App app(
      "Rebuilds a world from base and edit log and compares digests. Exit code 0: equal, 1: "
      "different, "
      "2: cannot read.",
      "runstone-replay");
  app.option_defaults()->multi_option_policy(
      CLI::MultiOptionPolicy::TakeLast);  // as the other programs
  app.add_option("--world", options.world, "folder of the world; a server may be running")
      ->required();
  const auto moment_of = [](const std::string& option, const std::string& text) {
    const auto moment = parse_moment(text);
    if (!moment) throw CLI::ValidationError(option, moment.error());
    return *moment;
  };
  app.add_option_function<std::string>(
      "--at", [&](const std::string& text) { options.moment = moment_of("--at", text); },
      "stop at this moment: a sequence number, a time (2026-11-21T23:05:00Z), or a time before the "
      "end "
      "(-2h30m)");
  app.add_option("--write", options.write_to,
                 "write the world of the moment --at as a new world into this folder instead");
  app.add_option_function<std::vector<std::string>>(
         "--diff",
         [&](const std::vector<std::string>& texts) {
           if (texts.size() != 2) throw CLI::ValidationError("--diff", "expected two moments");
           options.diff = {moment_of("--diff", texts.at(0)), moment_of("--diff", texts.at(1))};
         },
         "say what differs between two moments, and whose work it is, instead")
      ->expected(2);
  app.add_flag("--verify", options.verify, "also read and verify every row of every table");
  app.add_option("--json", options.json,
                 "write the report, of a replay with all digests, to this file");
  app.add_option("--against", options.against,
                 "compare with digests that a server or client wrote");
  app.add_option("--export", options.export_to, "write the log to this .rlog file instead");
  app.add_option("--import", options.import_from,
                 "append this .rlog file to the world's log instead; makes the world if the folder "
                 "holds none");
  app.add_flag("--keyframes", options.keyframes,
               "make the keyframes that the world lacks instead; no server may run it");
  app.add_option("--keyframe-edits", options.keyframe_edits,
                 "edits between two keyframes, at least")
      ->check(CLI::Range(1, 1'000'000'000))
      ->needs("--keyframes");
  CLI::Option* into = app.add_option(
      "--into", options.into,
      "play the log into the live server at HOST:PORT instead, as players of its own");
  app.add_option(
         "--speed", options.speed,
         "into: 2 is twice as fast as recorded, 0 or max as fast as the server takes it; default 1")
      ->check([](const std::string& text) {
        return is_speed(text) ? "" : "expected 0 to 1000000, or max";
      })
      ->needs(into);
  app.add_option(
         "--bot", options.bot,
         "into: the program that plays; default: RUNSTONE_BOT, or runstone-bot beside this one")
      ->needs(into);
  CLI::Option* bench = app.add_flag("--bench", options.bench,
                                    "time reading the log and rebuilding the world instead");
  app.add_option("--rounds", options.rounds, "bench: how often; default 5")
      ->check(CLI::Range(1U, 1'000U))
      ->needs(bench);
  app.add_flag("--progress", options.progress,
               "tell how far it is also where stderr is no terminal");
  const char* modes[] = {"--export", "--import", "--keyframes", "--write",
                         "--diff",   "--into",   "--bench"};
  for (const char* mode : modes) {
    for (const char* other : {"--verify", "--against"}) app.get_option(mode)->excludes(other);
    for (const char* other : modes) {
      if (other != mode) app.get_option(mode)->excludes(other);
    }
  }
  app.get_option("--import")->excludes("--at");
  app.get_option("--keyframes")->excludes("--at");
  app.get_option("--diff")->excludes("--at");
  add_timelapse_options(app, options.timelapse);
  for (const char* other : {"--verify", "--against", "--export", "--import", "--keyframes",
                            "--write", "--diff", "--into", "--bench"}) {
    app.get_option("--timelapse")->excludes(other);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return {std::nullopt, app.exit(error, out, err) == 0 ? 0 : 2};
  }
  return {options, 0};
}

}  // namespace runstone
