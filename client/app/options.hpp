// ClientOptions: what the command line of runstone-client says.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

namespace runstone {

struct ClientOptions {
  std::string host = "127.0.0.1";
  std::uint16_t port = 0;
  std::string name = "builder";
  std::string key_file;            // empty: a key for this process only
  std::uint8_t view_radius = 6;    // chunks, horizontal
  std::uint8_t view_radius_v = 3;  // chunks, vertical
  bool headless = false;           // off screen, no display needed
  bool render = true;              // false: mesh, but draw nothing
  int width = 1280, height = 720;  // pixels
  std::string script;              // file; empty: none
  std::string report;              // file; empty: none
  std::string digests;             // file written at the end; empty: none
  std::uint8_t encodings = 7;      // as in Hello
  std::string screenshot_dir = ".";
  bool exit_on_goodbye = false;
  double reconnect_seconds = 30;  // without a session for this long: give up
  unsigned workers = 0;           // mesh threads; 0: one fewer than cores, at least one
  bool cache = true;              // keep chunks between runs; off by default where nobody watches
  std::string cache_dir;          // empty: $XDG_CACHE_HOME/runstone
  std::uint64_t cache_mib = 256;  // at most, on disk
  bool verbose = false;
  bool draw = false;  // take draw orders from standard input instead of playing (docs/client.md)
};

/// The options, or the exit code of a program that has nothing more to do (help, or a mistake that was
/// printed).
struct ParsedOptions {
  std::optional<ClientOptions> options;
  int exit_code = 0;
};
ParsedOptions parse_options(int argc, const char* const* argv);

}  // namespace runstone
