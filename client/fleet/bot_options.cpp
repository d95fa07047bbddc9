#include "client/fleet/bot_options.hpp"

#include <CLI/CLI.hpp>

#include "common/command_line/help_options.hpp"
#include "common/core/text.hpp"
#include "common/os/output_file.hpp"
#include "common/os/text_file.hpp"
#include "protocol/limits.hpp"
#include "protocol/program_version.hpp"

namespace runstone {
namespace {

double speed_of(const std::string& text) {
  if (text == "max") return 0;
  double speed = 0;
  if (!CLI::detail::lexical_cast(text, speed) || !(speed >= 0 && speed <= kPlaySpeedMax)) {
    throw CLI::ValidationError("--speed", "expected a number from 0 to 1000000, or max: " + text);
  }
  return speed;
}

/// Where `--connect` leads: to a server, or to the WebSocket of a gateway.
struct Target {
  std::vector<HostPort> servers;  // at least one, of one world
  std::string web_path;           // empty: a server
  bool is_encrypted = true;
};

Target target_of(std::string text) {
  constexpr std::uint16_t kHttpPort = 80, kHttpsPort = 443;
  Target out;
  std::uint16_t default_port = kDefaultPort;
  for (const std::string scheme : {"ws://", "wss://"}) {
    if (!text.starts_with(scheme)) continue;
    out.is_encrypted = scheme == "wss://";
    default_port = out.is_encrypted ? kHttpsPort : kHttpPort;
    text.erase(0, scheme.size());
    const std::size_t slash = std::min(text.find('/'), text.size());
    out.web_path = text.substr(slash);
    text.erase(slash);
    if (out.web_path.size() < 2)
      throw CLI::ValidationError("--connect", "a WebSocket has a path, such as /play");
    if (out.web_path.find_first_of(" \r\n?#") != std::string::npos)
      throw CLI::ValidationError("--connect", "not the path of a WebSocket: " + out.web_path);
  }
  auto servers = parse_host_ports(text, default_port);
  if (!servers) throw CLI::ValidationError("--connect", servers.error());
  out.servers = *std::move(servers);
  return out;
}

constexpr const char* kRoleNames = "idle, walk, run-away, build, brush, griefer, join-storm";
constexpr std::size_t kMixSharesMax = 1'000;

/// Returns the roles of a text such as "build=8,walk=2", which makes eight of ten bots build and
/// two walk.
std::vector<BotRole> roles_of(const std::string& text) {
  const auto wrong = [&text](const std::string& why) {
    return CLI::ValidationError("--mix",
                                "expected NAME=SHARE,NAME=SHARE,...: " + why + ": " + text);
  };
  std::vector<BotRole> roles;
  for (const std::string& part : CLI::detail::split(text, ',')) {
    const std::size_t equals = part.find('=');
    const auto role = bot_role(part.substr(0, equals));
    if (!role) throw wrong(std::string("a name is one of ") + kRoleNames);
    std::size_t share = 0;
    if (equals == std::string::npos || !CLI::detail::lexical_cast(part.substr(equals + 1), share) ||
        share == 0 || share > kMixSharesMax - roles.size()) {
      throw wrong("a share is a number from 1, and all of them make 1000 at most");
    }
    roles.insert(roles.end(), share, *role);
  }
  return roles;
}

}  // namespace

ParsedBotOptions parse_bot_options(int argc, const char* const* argv) {
  BotOptions out;
  CLI::App app{"Runstone bots: many players in one process, seeded, open loop.", "runstone-bot"};
  // The last value wins, as in the other programs.
  app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  app.set_version_flag("--version", program_version("runstone-bot"));
  add_help_options(app, "runstone-bot");
  std::string address, role = "build", mix, password_file;
  unsigned view = out.view_radius, far_levels = out.far_levels;
  std::uint64_t edits = 0;
  app.add_option("--connect", address,
                 "server: HOST or HOST:PORT, default port " + std::to_string(kDefaultPort) +
                     ", or several of one world, separated by commas; gateway: "
                     "wss://HOST:PORT/play, or ws:// without encryption")
      ->required();
  bool insecure = false;
  CLI::Option* const no_encryption = app.add_flag(
      "--insecure", insecure, "do not encrypt connections; for servers that run with --insecure");
  app.add_option("--count", out.count, "bots")->check(CLI::Range(1, 10'000));
  CLI::Option* behaviour =
      app.add_option("--behaviour", role, std::string("what they do: ") + kRoleNames)
          ->check([](const std::string& name) {
            return bot_role(name) ? "" : std::string("a behaviour is one of ") + kRoleNames;
          });
  app.add_option("--mix", mix, "several behaviours and their shares, such as build=8,walk=2")
      ->excludes(behaviour);
  app.add_option(
      "--replicas", out.replicas,
      "this many bots, the first ones, keep a replica and compare digests; the others verify");
  app.add_option("--join-rate", out.join_rate, "bots a second that join")
      ->check(CLI::Range(0.1, 100'000.0));
  app.add_option("--name", out.name, "name of one bot; of several, NAME-1, NAME-2, ...")
      ->check([](const std::string& name) {
        if (name.empty() || name.size() + 6 > kPlayerNameBytesMax)
          return "a bot's name has 1 to 26 bytes";
        return is_plain_name(name) ? "" : "a name has no quotes, backslashes or unseen characters";
      });
  app.add_option(
         "--key-dir", out.key_dir,
         "folder of their key files, which are made if missing; default: new keys each time")
      ->check(CLI::ExistingDirectory);
  app.add_option("--password-file", password_file,
                 "join with the world's password, the first line of this file")
      ->needs("--key-dir")
      ->excludes(no_encryption);
  app.add_option("--rate", out.rate, "edits, or joins of a join storm, a second, each bot")
      ->check(CLI::Range(0.001, 100'000.0));
  app.add_option("--duration", out.seconds, "seconds for which edits are due")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--edits", edits, "edits at most, each bot");
  app.add_option("--sites", out.sites,
                 "building sites of all fleets that share the world; default: --count");
  app.add_option("--first-site", out.first_site,
                 "site of the first bot, from 0: fleets that share a world can stand apart");
  app.add_option("--seed", out.seed, "seed of everything that bots choose at random");
  app.add_option("--view", view, "view radius in chunks, both ways")
      ->check(CLI::Range(0U, unsigned{kViewRadiusMax}));
  app.add_option("--far-levels", far_levels,
                 "levels of tiles beyond the view; each one doubles the distance")
      ->check(CLI::Range(0U, unsigned{kTileLevelMax}));
  app.add_option(
         "--patience", out.load_seconds,
         "seconds to wait for the world at the start and for the disk at the end; default 60")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--report", out.report, "write counts and latencies as JSON at the end")
      ->check(output_refusal);
  app.add_flag("--verbose", out.verbose, "log every step");
  CLI::Option* play = app.add_option(
      "--play", out.play,
      "play the edits of this .rlog instead: a bot for each author, each edit at its time");
  app.add_option_function<std::string>(
         "--speed", [&out](const std::string& text) { out.speed = speed_of(text); },
         "play: 2 is twice as fast as recorded, 0 or max as fast as the server takes them; "
         "default 1")
      ->needs(play);
  for (const char* other : {"--count", "--behaviour", "--mix", "--replicas", "--join-rate",
                            "--name", "--key-dir", "--rate", "--duration", "--edits", "--sites",
                            "--first-site", "--seed", "--view", "--far-levels"}) {
    play->excludes(app.get_option(other));
  }
  try {
    app.parse(argc, argv);
    Target target = target_of(address);
    if (!target.web_path.empty() && target.is_encrypted && insecure)
      throw CLI::ValidationError("--insecure", "a gateway without encryption is ws://HOST/PATH");
    if (!target.is_encrypted) insecure = true;
    out.server = target.servers.front();
    out.more_servers.assign(target.servers.begin() + 1, target.servers.end());
    out.web_path = std::move(target.web_path);
    if (!password_file.empty()) {
      if (!out.web_path.empty())
        throw CLI::ValidationError("--password-file", "a gateway passes no passwords on");
      auto password = read_first_line(password_file);
      if (!password) throw CLI::ValidationError("--password-file", password.error());
      out.password = *std::move(password);
    }
    if (app.count("--mix") != 0) out.roles = roles_of(mix);
  } catch (const CLI::ParseError& e) {
    return {std::nullopt, app.exit(e) == 0 ? 0 : 2};
  }
  if (insecure) out.tls.reset();
  if (app.count("--mix") == 0) out.roles = {*bot_role(role)};
  if (app.count("--edits") != 0) out.edits = edits;
  if (out.sites == 0) out.sites = out.count;
  out.view_radius = out.view_radius_v = static_cast<std::uint8_t>(view);
  out.far_levels = static_cast<std::uint8_t>(far_levels);
  return {out, 0};
}

}  // namespace runstone
