#include "server/app/replay_options.hpp"

#include <CLI/CLI.hpp>

namespace runstone {

ParsedReplayOptions parse_replay_options(int argc, const char* const* argv, std::ostream& out,
                                         std::ostream& err) {
  ReplayOptions options;
  CLI::App app(
      "Rebuilds a world from base and edit log and compares digests. Exit code 0: equal, 1: different, "
      "2: cannot read.",
      "runstone-replay");
  app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);  // as the other programs
  app.add_option("--world", options.world, "folder of the world; a server may be running")->required();
  app.add_option("--at", options.at, "stop after this sequence number");
  app.add_flag("--verify", options.verify, "also read and verify every row of every table");
  app.add_option("--json", options.json, "write digests and report to this file");
  app.add_option("--against", options.against, "compare with digests that a server or client wrote");
  CLI::Option* to = app.add_option("--export", options.export_to, "write the log to this .rlog file instead");
  app.add_option(
         "--import", options.import_from,
         "append this .rlog file to the world's log instead; makes the world if the folder holds none")
      ->excludes(to);
  app.add_flag("--keyframes", options.keyframes,
               "make the keyframes that the world lacks instead; no server may run it");
  app.add_option("--keyframe-edits", options.keyframe_edits, "edits between two keyframes, at least")
      ->check(CLI::Range(1, 1'000'000'000))
      ->needs("--keyframes");
  app.add_flag("--progress", options.progress, "tell how far it is also where stderr is no terminal");
  for (const char* mode : {"--export", "--import", "--keyframes"}) {
    for (const char* other : {"--verify", "--json", "--against"}) app.get_option(mode)->excludes(other);
  }
  app.get_option("--import")->excludes("--at");
  for (const char* other : {"--at", "--export", "--import"}) app.get_option("--keyframes")->excludes(other);
  add_timelapse_options(app, options.timelapse);
  for (const char* other : {"--verify", "--against", "--export", "--import", "--keyframes"}) {
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
