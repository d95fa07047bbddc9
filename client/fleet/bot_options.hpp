// BotOptions: what the command line of runstone-bot says.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "client/bots/behaviour.hpp"

namespace runstone {

inline constexpr double kPlaySpeedMax = 1'000'000;

struct BotOptions {
  std::string host = "127.0.0.1";
  std::uint16_t port = 0;
  std::size_t count = 1;  // bots
  std::vector<BotRole> roles = {
      BotRole::build};                 // of the first bots, in turn; then from the first again
  std::size_t replicas = 20;           // so many bots, the first ones, keep a replica
  double join_rate = 100;              // bots a second that join
  std::string name = "bot";            // bots are NAME-1, NAME-2, ...; one alone is NAME
  std::string key_dir;                 // holds NAME-i.key; empty: new keys each time
  double rate = 5;                     // edits, or joins of a join storm, a second and bot
  double seconds = 10;                 // for which edits are due
  std::optional<std::uint64_t> edits;  // at most, each bot
  std::size_t sites = 0;  // of the whole crowd, for a fleet that joins another; 0: count
  std::uint64_t seed = 1;
  std::uint8_t view_radius = 2, view_radius_v = 2;  // chunks
  double load_seconds =
      60;  // to see everything in view before the start, and to settle at the end; of a play
           // without any progress
  std::string report;  // file; empty: none
  bool verbose = false;
  std::string play;  // .rlog to play in place of a behaviour; empty: none
  double speed = 1;  // of its time; 0: as fast as the server takes it
};

struct ParsedBotOptions {
  std::optional<BotOptions> options;
  int exit_code = 0;
};
/// The options, or the exit code of a program that has nothing more to do (help, or a mistake that was
/// printed).
ParsedBotOptions parse_bot_options(int argc, const char* const* argv);

}  // namespace runstone
