// BotOptions: the command line of runstone-bot.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "client/bots/behaviour.hpp"
#include "common/os/host_port.hpp"
#include "common/tls/tls_context.hpp"
#include "protocol/default_port.hpp"

namespace runstone {

inline constexpr double kPlaySpeedMax = 1'000'000;

struct BotOptions {
  HostPort server{"127.0.0.1", kDefaultPort};
  std::vector<HostPort> more_servers;                    // of the same world
  std::optional<TlsContext> tls = TlsContext::client();  // nullopt: no encryption
  std::string web_path;   // of a gateway's WebSocket; empty: `server` is no gateway
  std::size_t count = 1;  // bots
  std::vector<BotRole> roles = {BotRole::build};  // bot i has role i modulo their number
  std::size_t replicas = 20;                      // this many bots, the first ones, keep a replica
  double join_rate = 100;                         // bots a second that join
  std::string name = "bot";            // bots are NAME-1, NAME-2, ...; a single bot is NAME
  std::string key_dir;                 // has a key file for each bot; empty: new keys each time
  std::string password;                // of the world; empty: none
  double rate = 5;                     // edits (of a join storm: joins) per second and bot
  double seconds = 10;                 // for which edits are due
  std::optional<std::uint64_t> edits;  // at most, each bot
  std::size_t sites = 0;               // building sites of all fleets in the world; set by parsing
  std::size_t first_site = 0;          // of the first bot; the others have the next ones
  std::uint64_t seed = 1;
  std::uint8_t view_radius = 2, view_radius_v = 2;  // chunks
  std::uint8_t far_levels = 0;                      // of tiles beyond them
  /// The time limit for joining and for the wait at the end; with `play`, for a lack of progress.
  double load_seconds = 60;
  std::string report;  // file; empty: none
  bool verbose = false;
  std::string play;  // .rlog file to play instead of a behaviour; empty: none
  double speed = 1;  // of play, relative to the recording; 0: as fast as the server accepts edits
};

struct ParsedBotOptions {
  std::optional<BotOptions> options;
  int exit_code = 0;
};
/// Reads the command line. Without options, the program is to end with the exit code; the reason
/// has been printed.
ParsedBotOptions parse_bot_options(int argc, const char* const* argv);

}  // namespace runstone
