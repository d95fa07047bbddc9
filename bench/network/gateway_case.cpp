#include "bench/network/gateway_case.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/harness/statistics.hpp"
#include "bench/network/fleet.hpp"
#include "common/os/steady_clock.hpp"
#include "tests/support/net/raw_client.hpp"
#include "tests/support/net/web_player.hpp"
#include "tests/support/tls/pem_files.hpp"

namespace runstone::bench {
namespace {

constexpr double kAddedMsMax = 1;
constexpr double kFleetRatioMax = 1.3;
constexpr unsigned kSpareSockets = 16;
constexpr TimeUs kFrameEveryUs = 4'000;
constexpr std::array<const char*, 2> kWays = {"TCP", "gateway"};

/// A server with a gateway in front of it.
struct Gateway {
  TestbedServer server, web;
  std::string url;  // of the WebSocket
};

Result<Gateway, std::string> start_both(Testbed& testbed, TestbedLink& link,
                                        const test::PemFiles& pem, unsigned clients) {
  const std::string socket = testbed.fresh("web.sock");
  const std::string sockets = fmt::to_string(clients + kSpareSockets);
  auto server = testbed.start_server(
      link, testbed.fresh("world"),
      without_player_limits({"--generator", "terrain", "--seed", "7", "--sessions-max", sockets,
                             "--handshakes-per-address", sockets, "--gateway-socket", socket}));
  if (!server) return failure(server.error());
  std::vector<std::string> flags = {
      "--sockets-max", sockets, "--sockets-per-address", sockets, "--connections-per-second", "0"};
  if (!testbed.options().insecure) {
    flags.insert(flags.end(), {"--tls-certificate", pem.chain_file(), "--tls-key", pem.key_file()});
  }
  auto web = testbed.start_gateway(link, socket, flags);
  if (!web) return failure(web.error());
  Gateway out{*std::move(server), *std::move(web), {}};
  out.url = (testbed.options().insecure ? "ws://" : "wss://") + out.web.address + "/play";
  return out;
}

Done stop_both(Testbed& testbed, Gateway& gateway) {
  if (const auto ended = testbed.stop_server(gateway.web); !ended) return ended;
  return testbed.stop_server(gateway.server);
}

View view_at_spawn() {
  View view;
  view.number = 1;
  view.radius_h = view.radius_v = 1;
  return view;
}

/// A frame and the message that answers it.
struct RoundTrip {
  const char* what;
  runstone::Message (*frame)(std::uint64_t number);
  bool (*is_answer)(const runstone::Message& message, std::uint64_t number);
};
constexpr std::array<RoundTrip, 2> kRoundTrips = {{
    {"ping and pong",
     [](std::uint64_t number) -> runstone::Message { return Ping{static_cast<TimeUs>(number)}; },
     [](const runstone::Message& message, std::uint64_t number) {
       const auto* pong = std::get_if<Pong>(&message);
       return pong != nullptr && pong->sent_us == static_cast<TimeUs>(number);
     }},
    {"edit and commit",
     [](std::uint64_t number) -> runstone::Message {
       // Sixteen edits in turn change sixteen voxels, the next sixteen change them back.
       const auto at = static_cast<std::int32_t>(number % 16);
       const auto material = static_cast<Material>(1 + number / 16 % 2);
       return EditRequest{number, 0, {SetVoxel{{at, 90, at}}, {}, material}};
     },
     // No two edits of the probes have the same number, so it tells this edit from the other probe's.
     [](const runstone::Message& message, std::uint64_t number) {
       const auto* commit = std::get_if<Commit>(&message);
       return commit != nullptr && std::ranges::any_of(commit->edits, [&](const OrderedEdit& edit) {
                return edit.op.seq == number;
              });
     }},
}};

/// Sends a frame and waits for its answer. Returns the time in ms, or nullopt if none comes.
template <class Player>
std::optional<double> round_trip(Player& player, const RoundTrip& kind, std::uint64_t number) {
  const runstone::Message frame = kind.frame(number);
  const TimeUs sent_us = steady_now_us();
  player.send(frame);
  while (const auto message = player.next()) {
    if (kind.is_answer(*message, number))
      return static_cast<double>(steady_now_us() - sent_us) / 1e3;
  }
  return std::nullopt;
}

/// Reads what comes until the view is complete.
template <class Player>
bool sees_its_view(Player& player) {
  player.send(view_at_spawn());
  while (const auto state = player.template next_of<ViewState>()) {
    if (state->phase == ViewPhase::complete) return true;
  }
  return false;
}

Done measure_round_trips(Testbed& testbed, const test::PemFiles& pem, NetFindings& findings) {
  auto link = testbed.make_link(test::link_profiles().front());
  if (!link) return failure(link.error());
  auto both = start_both(testbed, **link, pem, 4);
  if (!both) return failure(both.error());
  const bool is_encrypted = !testbed.options().insecure;
  test::RawClient direct(
      both->server.port, INADDR_LOOPBACK,
      is_encrypted ? test::RawClient::Encryption::tls : test::RawClient::Encryption::none);
  test::WebPlayer browser(both->web.port, INADDR_LOOPBACK, is_encrypted);
  if (!direct.join(1) || !browser.join(2) || !sees_its_view(direct) || !sees_its_view(browser))
    return failure("gateway: the probes cannot join");
  std::string rows;
  double added_most_ms = 0;
  for (const RoundTrip& kind : kRoundTrips) {
    std::array<std::vector<double>, kWays.size()> times;
    TimeUs due_us = steady_now_us();
    for (std::uint64_t i = 1; i <= testbed.options().edits; ++i) {
      // Each way is the first one every other time.
      for (const std::size_t turn : {0U, 1U}) {
        due_us += kFrameEveryUs;
        if (!pause_for(static_cast<double>(std::max<TimeUs>(due_us - steady_now_us(), 0)) / 1e6))
          return failure("interrupted");
        // An edit of one player is sent to the other one, too. It is read before the next frame.
        while (direct.next(1)) {
        }
        while (browser.next_within(1)) {
        }
        const std::size_t way = (i + turn) % 2;
        const std::uint64_t number = 2 * i + turn;
        const auto ms =
            way == 0 ? round_trip(direct, kind, number) : round_trip(browser, kind, number);
        if (!ms) return failure("gateway: a frame has no answer");
        times[way].push_back(*ms);
      }
    }
    std::array<std::array<double, 2>, kWays.size()> ms{};  // p50 and p99
    for (std::size_t way = 0; way < kWays.size(); ++way) {
      ms[way] = {quantile(times[way], 0.5), quantile(times[way], 0.99)};
      for (std::size_t rank = 0; rank < 2; ++rank) {
        findings.figures.push_back(
            {"gateway", "loopback", "loopback", kind.what,
             fmt::format("{}_{}_ms", way == 0 ? "tcp" : "gateway", rank == 0 ? "p50" : "p99"),
             ms[way][rank]});
      }
    }
    added_most_ms = std::max(added_most_ms, ms[1][1] - ms[0][1]);
    fmt::format_to(std::back_inserter(rows), "| {} | {} | {}, {} | {}, {} | {}, {} |\n", kind.what,
                   times[0].size(), number_text(ms[0][0]), number_text(ms[0][1]),
                   number_text(ms[1][0]), number_text(ms[1][1]), number_text(ms[1][0] - ms[0][0]),
                   number_text(ms[1][1] - ms[0][1]));
    fmt::print(testbed.progress(), "gateway: {}\n", kind.what);
    testbed.progress().flush();
  }
  if (const auto ended = stop_both(testbed, *both); !ended) return ended;
  findings.tables += fmt::format(
      "\n### Gateway\n\nRound trips on loopback, one frame at a time, in turn over the server's "
      "port and over a WebSocket of the gateway, {}.\n\n"
      "| frames | of each | TCP p50, p99 ms | gateway p50, p99 ms | added p50, p99 ms |\n"
      "|---|---|---|---|---|\n",
      is_encrypted ? "both with TLS" : "both without encryption");
  findings.tables += rows;
  findings.targets.push_back({"gateway: added to a round trip, the worse kind of frame: p99",
                              fmt::format("at most {} ms", kAddedMsMax),
                              number_text(added_most_ms) + " ms",
                              added_most_ms <= kAddedMsMax ? Verdict::met : Verdict::missed});
  return {};
}

struct FleetRun {
  FleetReport seen;
  double server_cores = 0, gateway_cores = 0, bot_cores = 0;
  double gateway_mb = 0;
};

Result<FleetRun, std::string> run_fleet_by(Testbed& testbed, const test::PemFiles& pem,
                                           bool is_web) {
  const auto failed = [](const auto& what) { return failure(what.error()); };
  const NetOptions& options = testbed.options();
  auto link = testbed.make_link(test::link_profiles().front());
  if (!link) return failed(link);
  auto both = start_both(testbed, **link, pem, options.gateway_bots);
  if (!both) return failed(both);
  const FleetPlan plan{.clients = options.gateway_bots,
                       .seconds = options.fleet_seconds,
                       .sites = options.fleet_sites};
  auto fleet = Fleet::join(testbed, **link, is_web ? both->url : both->server.address, plan);
  if (!fleet) return failed(fleet);
  const std::array<Child*, 3> programs = {both->server.program.get(), both->web.program.get(),
                                          &fleet->bots()};
  FleetRun out;
  const std::array<double*, 3> cores = {&out.server_cores, &out.gateway_cores, &out.bot_cores};
  for (std::size_t i = 0; i < programs.size(); ++i) *cores[i] -= programs[i]->core_seconds();
  if (!pause_for(options.fleet_seconds)) return failure("interrupted");
  for (std::size_t i = 0; i < programs.size(); ++i) {
    *cores[i] = (*cores[i] + programs[i]->core_seconds()) / options.fleet_seconds;
  }
  out.gateway_mb = static_cast<double>(both->web.program->resident_bytes()) / 1e6;
  const auto seen = fleet->finish(testbed);
  if (!seen) return failed(seen);
  out.seen = *seen;
  if (const auto ended = stop_both(testbed, *both); !ended) return failed(ended);
  return out;
}

Done measure_web_fleets(Testbed& testbed, const test::PemFiles& pem, NetFindings& findings) {
  const NetOptions& options = testbed.options();
  std::array<std::vector<double>, kWays.size()> p99_ms;
  std::array<double, kWays.size()> broken{};
  std::string rows;
  for (unsigned run = 0; run < options.repetitions; ++run) {
    for (const std::size_t turn : {0U, 1U}) {
      const std::size_t way = (run + turn) % 2;
      const auto result = run_fleet_by(testbed, pem, way == 1);
      if (!result) return failure(fmt::format("fleet by {}: {}", kWays[way], result.error()));
      const FleetReport& seen = result->seen;
      p99_ms[way].push_back(seen.p99_ms);
      broken[way] += seen.disconnects + seen.violations + seen.drifted;
      const auto add = [&](const char* name, double value) {
        findings.figures.push_back({"gateway", "loopback", "loopback",
                                    fmt::format("{} bots by {}", options.gateway_bots, kWays[way]),
                                    name, value});
      };
      add("seen_p50_ms", seen.p50_ms);
      add("seen_p99_ms", seen.p99_ms);
      add("seen_max_ms", seen.max_ms);
      add("samples", seen.samples);
      add("never", seen.never);
      add("disconnects", seen.disconnects);
      add("violations", seen.violations);
      add("server_cores", result->server_cores);
      add("gateway_cores", result->gateway_cores);
      add("bot_cores", result->bot_cores);
      add("gateway_resident_mb", result->gateway_mb);
      fmt::format_to(
          std::back_inserter(rows),
          "| {} | {}, {}, {} | {:.0f}, {:.0f} | {:.2f} | {:.2f} | {:.2f} | {} | {:.0f} |\n",
          kWays[way], number_text(seen.p50_ms), number_text(seen.p99_ms), number_text(seen.max_ms),
          seen.samples, seen.never, result->server_cores, result->gateway_cores, result->bot_cores,
          number_text(result->gateway_mb), seen.disconnects);
      fmt::print(testbed.progress(), "gateway: {} bots by {}\n", options.gateway_bots, kWays[way]);
      testbed.progress().flush();
    }
  }
  findings.tables += fmt::format(
      "\n{} bots, {} place(s), {} edits a second each for {} s; from when an edit was due until each "
      "bot that sees it had received and verified it:\n\n"
      "| way | p50, p99, max ms | samples, never | server cores | gateway cores | bots' cores | "
      "gateway MB | disconnects |\n|---|---|---|---|---|---|---|---|\n",
      options.gateway_bots, options.fleet_sites, kFleetEditsPerSecond, options.fleet_seconds);
  findings.tables += rows;
  const double ratio = median(p99_ms[1]) / median(p99_ms[0]);
  findings.targets.push_back(
      {fmt::format(
           "gateway: {} bots that build over WebSockets, against TCP: p99 of edits, medians "
           "of {} runs each; disconnects and broken rules",
           options.gateway_bots, options.repetitions),
       fmt::format("at most {}x; 0", kFleetRatioMax),
       fmt::format("{:.2f}x; {:.0f}", ratio, broken[0] + broken[1]),
       ratio <= kFleetRatioMax && broken[0] + broken[1] == 0 ? Verdict::met : Verdict::missed});
  return {};
}

}  // namespace

Done measure_gateway(Testbed& testbed, NetFindings& findings) {
  const test::PemFiles pem("localhost");
  if (const auto done = measure_round_trips(testbed, pem, findings); !done) return done;
  return measure_web_fleets(testbed, pem, findings);
}

}  // namespace runstone::bench
