// ClientOptions: the command line of runstone-client.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "client/app/flight_path.hpp"
#include "client/local/local_server.hpp"
#include "client/render/frame_look.hpp"
#include "client/settings/client_settings.hpp"
#include "common/os/host_port.hpp"
#include "common/tls/tls_context.hpp"
#include "protocol/default_port.hpp"

namespace runstone {

struct ClientOptions {
  HostPort server{"127.0.0.1", kDefaultPort};
  std::vector<HostPort> more_servers;  // of the same world
  bool has_server = true;              // false: the player chooses one on the title screen
  std::string local_world;       // name of a world on this computer to start and join; empty: none
  NewLocalWorld local_creation;  // of local_world, if there is none of this name
  ClientSettings settings;       // of a client with a window; `given` says what overrides them
  /// The options that the command line has set. The settings give the others to a client with a
  /// window.
  struct {
    bool name = false, view = false, view_vertical = false, memory = false, quality = false;
    bool far_levels = false, antialiasing = false;
  } given;
  std::optional<TlsContext> tls = TlsContext::client();  // nullopt: no encryption
  std::string name = "builder";
  std::string key_file;            // empty: a new key, for this process only
  std::string ticket;              // an invite token from the link; empty: none
  std::string password;            // of the world; empty: none was given
  bool asks_at_terminal = true;    // for the password, if there is a terminal
  std::string kits_file;           // the hotbars and tools by world; empty: they are not kept
  std::string hotbars_file;        // the hotbars that were kept; empty: they are not kept
  std::string servers_file;        // the list of servers that were joined; empty: no list is kept
  std::uint8_t view_radius = 6;    // chunks, horizontal
  std::uint8_t view_radius_v = 3;  // chunks, vertical
  std::uint8_t far_levels = 0;     // of tiles beyond the view radius (View::levels)
  bool headless = false;           // off screen, no display needed
  bool render = true;              // false: mesh, but draw nothing
  int width = 1280, height = 720;  // pixels
  std::string script;              // file; empty: none
  std::string report;              // file; empty: none
  std::string digests;             // file; empty: none
  std::uint8_t encodings = 7;      // as in Hello
  std::string screenshot_dir = ".";
  std::optional<double> time_of_day;  // as FrameLook::time_of_day; nullopt: that of the world
  std::optional<Quality> quality;     // nullopt: automatic
  Antialiasing antialiasing = Antialiasing::automatic;
  std::optional<FlightPath> benchmark;
  bool show_protected = false;  // outline protected boxes from the start
  bool no_textures = false;     // the pictures of worlds are not loaded
  bool exit_on_goodbye = false;
  double reconnect_seconds = 30;  // the client ends after this time without an open world
  unsigned workers = 0;           // mesh threads, at least 1 after parsing
  bool cache = true;              // keep chunks on disk between runs
  std::string cache_dir;          // empty: $XDG_CACHE_HOME/runstone
  std::uint64_t cache_mib = 256;  // at most, on disk
  /// For chunks, edits, meshes and textures (MemoryBudget). 0: the client uses
  /// automatic_memory_mib().
  std::uint64_t memory_mib = 0;
  bool verbose = false;
  bool list_materials = false;  // print the materials of the world instead of playing
  /// Returns true if frames go to a window.
  bool has_window() const { return render && !headless && !draw; }
  bool draw = false;  // take draw orders from standard input instead of playing (docs/client.md)
};

/// The parsed options, or nullopt and an exit code if the program is to end. The reason has been
/// printed.
struct ParsedOptions {
  std::optional<ClientOptions> options;
  int exit_code = 0;
};
/// Reads the command line. --help and --version give exit code 0, a mistake gives 2.
ParsedOptions parse_options(int argc, const char* const* argv);

}  // namespace runstone
