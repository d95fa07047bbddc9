#include "client/app/options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iterator>
#include <thread>

#include "client/app/key_options.hpp"
#include "client/display/look_control.hpp"
#include "client/render/antialiasing.hpp"
#include "client/session/join_check.hpp"
#include "common/command_line/help_options.hpp"
#include "common/core/day_time.hpp"
#include "common/core/tile_keys.hpp"
#include "common/os/output_file.hpp"
#include "common/os/text_file.hpp"
#include "protocol/chunks/chunk_codec.hpp"
#include "protocol/codec/server_link.hpp"
#include "protocol/codec/view_tiles.hpp"
#include "protocol/limits.hpp"
#include "protocol/program_version.hpp"

namespace runstone {
namespace {

/// Returns an empty text, or what is wrong with the size.
std::string parse_size(const std::string& text, ClientOptions& out) {
  const std::size_t cross = text.find('x');
  if (cross == std::string::npos || !CLI::detail::lexical_cast(text.substr(0, cross), out.width) ||
      !CLI::detail::lexical_cast(text.substr(cross + 1), out.height) || out.width < 16 ||
      out.height < 16 || out.width > 8192 || out.height > 8192) {
    return "expected WIDTHxHEIGHT, 16 to 8192 each";
  }
  return {};
}

/// Values that are converted to options after the whole command line was read.
struct RawOptions {
  std::string address, link, size, encoding = "auto", authorities, password_file;
  unsigned view = ClientOptions{}.view_radius, view_v = 0, far_levels = 0;
  std::string time, quality = "auto", antialiasing = "auto", benchmark;
  bool no_render = false, no_cache = false, insecure = false;
};

void add_session_options(CLI::App& app, ClientOptions& out, RawOptions& raw) {
  CLI::Option* const connect = app.add_option(
      "--connect", raw.address,
      "server: HOST, HOST:PORT or a link runstone://HOST:PORT/#INVITE; several servers of one "
      "world are separated by commas; default port " +
          std::to_string(kDefaultPort));
  app.add_option("LINK", raw.link, "the same as --connect LINK")->excludes(connect);
  CLI::Option* const local =
      app.add_option("--local", out.local_world,
                     "start a server for this world on this computer, and join it; makes the world "
                     "if there is none")
          ->excludes(connect);
  app.add_option("--generator", out.local_creation.generator,
                 "for a new world of --local: landscape, terrain, flat or empty; default "
                 "landscape")
      ->check(CLI::IsMember({"landscape", "terrain", "flat", "empty"}))
      ->needs(local);
  app.add_option("--seed", out.local_creation.seed,
                 "for a new world of --local: seed of the terrain; default: a random one")
      ->needs(local);
  CLI::Option* const insecure =
      app.add_flag("--insecure", raw.insecure,
                   "do not encrypt the connection; for servers that run with --insecure");
  app.add_option("--ca", raw.authorities,
                 "accept only certificates of these authorities for the server's name: a PEM file, "
                 "or \"system\". Default: any certificate, because the server's key is checked")
      ->excludes(insecure);
  app.add_option("--name", out.name, "name shown to others, 1 to 32 bytes")
      ->check([](const std::string& name) {
        const auto checked = check_player_name(name);
        return checked ? std::string() : checked.error();
      });
  app.add_option(
      "--key", out.key_file,
      "file of the identity; created if missing. Default: the kept identity with a window or "
      "--local, otherwise a new one");
  app.add_option("--password-file", raw.password_file,
                 "join with the world's password, the first line of this file, if the server asks "
                 "for one; default: ask for it")
      ->needs("--key")
      ->excludes(insecure);
  app.add_option("--view", raw.view, "view radius in chunks, horizontal")
      ->check(CLI::Range(0U, unsigned{kViewRadiusMax}));
  app.add_option("--view-vertical", raw.view_v,
                 "view radius in chunks, vertical; default: half of --view, rounded up")
      ->check(CLI::Range(0U, unsigned{kViewRadiusMax}));
  app.add_option(
         "--far-levels", raw.far_levels,
         "levels of coarser ground beyond the view radius; each sees twice as far. Default: "
         "that of the settings with a window, otherwise 0")
      ->check(CLI::Range(0U, unsigned{kTileLevelMax}));
  app.add_option("--encoding", raw.encoding, "chunk encodings to offer")
      ->check(CLI::IsMember({"raw", "packed", "coded", "auto"}));
  app.add_flag("--exit-on-goodbye", out.exit_on_goodbye, "end when the server says goodbye");
  app.add_option("--reconnect-seconds", out.reconnect_seconds,
                 "end after this time without the server; default 30")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--cache-dir", out.cache_dir,
                 "keep chunks for the next run in this folder; "
                 "default $XDG_CACHE_HOME/runstone with a window, "
                 "no cache with --headless or --no-render");
  app.add_option("--cache-mib", out.cache_mib, "greatest size of the cache in MiB; default 256")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 20));
  app.add_flag("--no-cache", raw.no_cache, "keep no chunks on disk");
}

void add_output_options(CLI::App& app, ClientOptions& out, RawOptions& raw) {
  app.add_flag("--headless", out.headless, "draw off screen, without a display");
  app.add_flag("--no-render", raw.no_render, "mesh, but draw nothing (no OpenGL needed)");
  app.add_option("--size", raw.size,
                 "size of the window or picture, WIDTHxHEIGHT; default 1280x720");
  app.add_option("--script", out.script, "run this script, then end (docs/client.md)")
      ->check(CLI::ExistingFile);
  app.add_option("--report", out.report, "write latencies and counts as JSON at the end")
      ->check(output_refusal);
  app.add_option("--digests", out.digests,
                 "write the digests of all confirmed chunks as JSON at the end")
      ->check(output_refusal);
  app.add_option("--screenshot-dir", out.screenshot_dir, "folder for screenshots")
      ->check(CLI::ExistingDirectory);
  app.add_option("--time", raw.time,
                 "time of day of the picture, HH or HH:MM, instead of the world's")
      ->check([](const std::string& text) {
        return parse_day_time(text) ? "" : "expected a time from 0:00 to 23:59";
      });
  app.add_option("--quality", raw.quality,
                 "effort of the picture; auto measures frames, off screen it is high")
      ->check(CLI::IsMember({"low", "medium", "high", "auto"}));
  app.add_option("--antialiasing", raw.antialiasing,
                 "smooth edges; auto is msaa on a GPU at quality medium and high, otherwise off")
      ->check(CLI::IsMember({"off", "fxaa", "msaa", "auto"}));
  app.add_option("--benchmark", raw.benchmark,
                 "fly this camera path (docs/client.md), print how long frames took, then end")
      ->check(CLI::ExistingFile);
  app.add_flag("--show-protected", out.show_protected,
               "outline protected boxes: green where the player may edit, red elsewhere");
  app.add_option("--workers", out.workers, "mesh threads; default: cores - 1, at least 1")
      ->check(CLI::Range(0U, 64U));
  app.add_option("--memory-mib", out.memory_mib,
                 "memory for chunks, edits, meshes and textures in MiB; default: an eighth of the "
                 "machine's, from 256 to 1024. Beyond it the view shrinks")
      ->check(CLI::Range(std::uint64_t{64}, std::uint64_t{65'536}));
  app.add_flag("--no-textures", out.no_textures,
               "draw patterns, not the pictures that a world brings for its materials");
  app.add_flag("--verbose", out.verbose, "log every step");
}

/// Adds the modes, which exclude options. Call it after all other options are added.
void add_modes(CLI::App& app, ClientOptions& out) {
  CLI::Option* materials = app.add_flag("--materials", out.list_materials,
                                        "list the materials of the server's world, then end");
  for (const char* other : {"--script", "--report", "--digests"})
    materials->excludes(app.get_option(other));
  CLI::Option* draw = app.add_flag(
      "--draw", out.draw, "draw the orders of standard input, off screen; for other programs");
  for (CLI::Option* other : app.get_options()) {
    if (other != draw && !other->check_name("--workers") && !other->check_name("--help") &&
        !other->check_name("--version")) {
      draw->excludes(other);
    }
  }
}

/// Sets the server to join. Throws CLI::ParseError.
void set_server(const RawOptions& raw, ClientOptions& out) {
  const std::string& address = raw.address.empty() ? raw.link : raw.address;
  // A client with a window keeps an identity, and one without a server shows the title screen.
  const bool has_window = !raw.no_render && !out.headless && !out.list_materials;
  if (address.empty()) {
    out.has_server = false;
    if (out.local_world.empty() && (!has_window || !out.script.empty()))
      throw CLI::RequiredError("--connect");
    return;
  }
  auto link = parse_server_link(address);
  if (!link) throw CLI::ValidationError("--connect", link.error());
  out.ticket = std::move(link->ticket);
  if (!out.ticket.empty() && out.key_file.empty() && !has_window)
    throw CLI::ValidationError("--connect",
                               "the invite is for an identity that you keep: add --key FILE");
  auto servers = parse_host_ports(link->address, kDefaultPort);
  if (!servers) throw CLI::ValidationError("--connect", servers.error());
  out.server = servers->front();
  out.more_servers.assign(servers->begin() + 1, servers->end());
}

/// Sets the options that depend on `raw`. Throws CLI::ParseError.
void finish(const CLI::App& app, const RawOptions& raw, ClientOptions& out) {
  if (!out.draw) {
    set_server(raw, out);
  }
  if (raw.insecure) out.tls.reset();
  if (!raw.password_file.empty()) {
    auto password = read_first_line(raw.password_file);
    if (!password) throw CLI::ValidationError("--password-file", password.error());
    out.password = *std::move(password);
  }
  if (app.count("--ca") != 0) {
    if (raw.authorities.empty()) throw CLI::ValidationError("--ca", "names no file");
    auto tls =
        TlsContext::client_of_authorities(raw.authorities == "system" ? "" : raw.authorities);
    if (!tls) throw CLI::ValidationError("--ca", tls.error());
    out.tls = *std::move(tls);
  }
  const std::string wrong_size = raw.size.empty() ? "" : parse_size(raw.size, out);
  if (!wrong_size.empty()) throw CLI::ValidationError("--size", wrong_size);
  out.given = {app.count("--name") != 0,          app.count("--view") != 0,
               app.count("--view-vertical") != 0, app.count("--memory-mib") != 0,
               app.count("--quality") != 0,       app.count("--far-levels") != 0,
               app.count("--antialiasing") != 0};
  out.view_radius = static_cast<std::uint8_t>(raw.view);
  out.view_radius_v = static_cast<std::uint8_t>(
      app.count("--view-vertical") != 0 ? raw.view_v : (raw.view + 1) / 2);
  out.far_levels = static_cast<std::uint8_t>(raw.far_levels);
  if (out.far_levels != 0 && out.view_radius < kTileRadiusHMin)
    throw CLI::ValidationError(
        "--far-levels", "far ground needs --view " + std::to_string(kTileRadiusHMin) + " or more");
  out.render = !raw.no_render && !out.list_materials;
  const bool has_window = out.render && !out.headless;
  const bool asks_for_cache = app.count("--cache-dir") != 0 || app.count("--cache-mib") != 0;
  out.cache = !raw.no_cache && !out.list_materials && (has_window || asks_for_cache);
  out.encodings = raw.encoding == "raw"      ? 1
                  : raw.encoding == "packed" ? 2
                  : raw.encoding == "coded"  ? 4
                                             : kEncodingsKnown;
  out.time_of_day = parse_day_time(raw.time);
  out.quality = parse_quality(raw.quality);
  out.antialiasing = parse_antialiasing(raw.antialiasing).value_or(out.antialiasing);
  if (!raw.benchmark.empty()) {
    if (!out.render) throw CLI::ValidationError("--benchmark", "needs a renderer");
    const auto text = read_text_file(raw.benchmark, kTextFileBytesMax);
    if (!text) throw CLI::ValidationError("--benchmark", text.error());
    auto path = FlightPath::parse(*text, raw.benchmark);
    if (!path) throw CLI::ValidationError("--benchmark", path.error().message());
    out.benchmark = *std::move(path);
  }
  if (out.workers == 0) out.workers = std::max(2U, std::thread::hardware_concurrency()) - 1;
}

}  // namespace

ParsedOptions parse_options(int argc, const char* const* argv) {
  ClientOptions out;
  RawOptions raw;
  CLI::App app{"Runstone client: shows a world, and plays scripts.", "runstone-client"};
  app.footer(
      "runstone-client key --help: show, export, import, send and receive the key of a player");
  // The last value wins, so that a user can append options to the fixed command line of a
  // container.
  app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  app.set_version_flag("--version", program_version("runstone-client"));
  add_session_options(app, out, raw);
  add_output_options(app, out, raw);
  add_modes(app, out);
  add_help_options(app, "runstone-client", [] { return std::vector{key_command_help()}; });
  try {
    app.parse(argc, argv);
    finish(app, raw, out);
  } catch (const CLI::ParseError& e) {
    const int code = app.exit(e);
    return {std::nullopt, code == 0 ? 0 : 2};
  }
  return {out, 0};
}

}  // namespace runstone
