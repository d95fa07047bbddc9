#include "client/app/options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <thread>

#include "common/os/host_port.hpp"
#include "protocol/codec/chunk_codec.hpp"
#include "protocol/limits.hpp"

namespace runstone {
namespace {

std::string parse_size(const std::string& text, ClientOptions& out) {
  const std::size_t cross = text.find('x');
  if (cross == std::string::npos || !CLI::detail::lexical_cast(text.substr(0, cross), out.width) ||
      !CLI::detail::lexical_cast(text.substr(cross + 1), out.height) || out.width < 16 ||
      out.height < 16 || out.width > 8192 || out.height > 8192) {
    return "expected WIDTHxHEIGHT, 16 to 8192 each";
  }
  return {};
}

}  // namespace

ParsedOptions parse_options(int argc, const char* const* argv) {
  ClientOptions out;
  CLI::App app{"Runstone client: shows a world, and plays scripts.", "runstone-client"};
  // The last one wins, so that arguments added to a fixed command line (a container's) change it.
  app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  app.set_version_flag("--version",
                       std::string("runstone-client protocol ") + std::to_string(kProtocolVersion));
  std::string address, size, encoding = "auto";
  unsigned view = out.view_radius, view_v = 0;
  bool no_render = false, no_cache = false;
  app.add_option("--connect", address, "server, HOST:PORT");
  app.add_option("--name", out.name, "name shown to others, 1 to 32 bytes")
      ->check([](const std::string& name) {
        return name.empty() || name.size() > kPlayerNameBytesMax ? "a name has 1 to 32 bytes" : "";
      });
  app.add_option("--key", out.key_file, "identity; made if missing. Default: a new one each time");
  app.add_option("--view", view, "view radius in chunks, horizontal")
      ->check(CLI::Range(0U, unsigned{kViewRadiusMax}));
  app.add_option("--view-vertical", view_v, "and vertical; default: half of --view, rounded up")
      ->check(CLI::Range(0U, unsigned{kViewRadiusMax}));
  app.add_flag("--headless", out.headless, "draw off screen, without a display");
  app.add_flag("--no-render", no_render, "mesh, but draw nothing (no OpenGL needed)");
  app.add_option("--size", size, "picture or window, WIDTHxHEIGHT; default 1280x720");
  app.add_option("--script", out.script, "run this script, then end (docs/client.md)")
      ->check(CLI::ExistingFile);
  app.add_option("--report", out.report, "write latencies and counts as JSON at the end");
  app.add_option("--digests", out.digests,
                 "write the digests of all chunks held as JSON at the end");
  app.add_option("--encoding", encoding, "chunk encodings to offer")
      ->check(CLI::IsMember({"raw", "packed", "coded", "auto"}));
  app.add_option("--screenshot-dir", out.screenshot_dir, "where screenshots go")
      ->check(CLI::ExistingDirectory);
  app.add_flag("--exit-on-goodbye", out.exit_on_goodbye, "end when the server says goodbye");
  app.add_option("--reconnect-seconds", out.reconnect_seconds,
                 "give up after so long without the server")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--workers", out.workers, "mesh threads; default: cores - 1, at least 1")
      ->check(CLI::Range(0U, 64U));
  app.add_option("--cache-dir", out.cache_dir,
                 "keep chunks for the next run in this folder; default $XDG_CACHE_HOME/runstone "
                 "with a window, "
                 "no cache with --headless or --no-render");
  app.add_option("--cache-mib", out.cache_mib, "size of the cache at most, MiB; default 256")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 20));
  app.add_flag("--no-cache", no_cache, "keep no chunks");
  app.add_flag("--verbose", out.verbose, "log every step");
  CLI::Option* draw = app.add_flag(
      "--draw", out.draw, "draw what standard input orders, off screen; for other programs");
  for (CLI::Option* other : app.get_options()) {
    if (other != draw && !other->check_name("--workers") && !other->check_name("--help") &&
        !other->check_name("--version")) {
      draw->excludes(other);
    }
  }
  try {
    app.parse(argc, argv);
    if (address.empty() && !out.draw) throw CLI::RequiredError("--connect");
    std::string wrong = out.draw ? "" : parse_host_port(address, out.host, out.port);
    if (!wrong.empty()) throw CLI::ValidationError("--connect", wrong);
    if (!size.empty()) wrong = parse_size(size, out);
    if (!wrong.empty()) throw CLI::ValidationError("--size", wrong);
  } catch (const CLI::ParseError& e) {
    const int code = app.exit(e);
    return {std::nullopt, code == 0 ? 0 : 2};
  }
  out.view_radius = static_cast<std::uint8_t>(view);
  out.view_radius_v =
      static_cast<std::uint8_t>(app.count("--view-vertical") != 0 ? view_v : (view + 1) / 2);
  out.render = !no_render;
  const bool is_watched = out.render && !out.headless;
  out.cache =
      !no_cache && (is_watched || app.count("--cache-dir") != 0 || app.count("--cache-mib") != 0);
  out.encodings = encoding == "raw"      ? 1
                  : encoding == "packed" ? 2
                  : encoding == "coded"  ? 4
                                         : kEncodingsKnown;
  if (out.workers == 0) out.workers = std::max(2U, std::thread::hardware_concurrency()) - 1;
  return {out, 0};
}

}  // namespace runstone
