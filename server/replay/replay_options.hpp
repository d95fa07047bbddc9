// ReplayOptions: what the command line of runstone-replay says.
#pragma once
#include <iosfwd>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/core/ids.hpp"
#include "server/history/named_moment.hpp"
#include "server/replay/timelapse_options.hpp"

namespace runstone {

struct ReplayOptions {
  std::string world;  // folder
  bool verify = false;
  std::optional<NamedMoment> moment;  // --at as written
  Sequence at = std::numeric_limits<
      Sequence>::max();  // what it means in the world; replay_program() looks it up
  std::string write_to;  // folder of a new world
  std::optional<std::pair<NamedMoment, NamedMoment>> diff;
  std::string json;                    // file; empty: none
  std::vector<std::string> against;    // files
  std::string export_to, import_from;  // .rlog files; at most one is not empty
  std::string into;                    // HOST:PORT of a live server that the log is played into
  std::string speed = "1", bot;        // of that, as runstone-bot takes it; the program that plays
  bool bench = false;                  // time reading and rebuilding
  std::uint32_t rounds = 5;            // of it
  bool keyframes = false;              // make those that are missing
  std::uint64_t keyframe_edits = 32'768;
  bool progress = false;       // also where stderr is no terminal
  TimelapseOptions timelapse;  // instead of comparing, if it has a folder
};

/// The options, or the exit code of a program that has nothing more to do: 0 after help, 2 after a mistake.
/// Both were printed, to `out` and `err`.
struct ParsedReplayOptions {
  std::optional<ReplayOptions> options;
  int exit_code = 0;
};
ParsedReplayOptions parse_replay_options(int argc, const char* const* argv, std::ostream& out,
                                         std::ostream& err);

}  // namespace runstone
