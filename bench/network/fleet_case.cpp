#include "bench/network/fleet_case.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bench/harness/statistics.hpp"
#include "bench/network/fleet.hpp"

namespace runstone::bench {
namespace {

constexpr unsigned kSpareSessions = 16;
constexpr unsigned kBigFleet = 1000;  // the size that the target names
constexpr double kBigFleetMsMax = 100;
constexpr double kEnqueueUsMax = 1;
constexpr double kFarRatioMax = 1.2;

struct FleetResult {
  unsigned clients = 0, levels = 0;
  double joined_s = 0;  // until the last bot had the world
  FleetReport seen;
  double kb_s_each = 0;                    // received by each client, from its start to its end
  double server_cores = 0, bot_cores = 0;  // while edits were due
  double server_mb = 0;                    // resident
  double edits = 0, commits = 0, send_us_per_commit = 0;
  double enqueue_us = 0;  // of a commit, for each receiver
};

Result<FleetResult, std::string> run_fleet(Testbed& testbed, unsigned clients, unsigned levels) {
  const auto failed = [](const auto& what) { return failure(what.error()); };
  const double seconds = testbed.options().fleet_seconds;
  auto link = testbed.make_link(test::link_profiles().front());
  if (!link) return failed(link);
  auto server = testbed.start_server(
      **link, testbed.fresh("world"),
      without_player_limits({"--generator", "terrain", "--seed", "7", "--sessions-max",
                             fmt::to_string(clients + kSpareSessions), "--handshakes-per-address",
                             fmt::to_string(clients + kSpareSessions)}));
  if (!server) return failed(server);
  auto fleet = Fleet::join(testbed, **link, server->address,
                           {.clients = clients,
                            .seconds = seconds,
                            .sites = testbed.options().fleet_sites,
                            .far_levels = levels});
  if (!fleet) return failed(fleet);
  FleetResult out;
  out.clients = clients;
  out.levels = levels;
  out.joined_s = fleet->joined_s();
  const double server_before = server->program->core_seconds(),
               bots_before = fleet->bots().core_seconds();
  if (!pause_for(seconds)) return failure("interrupted");
  out.server_cores = (server->program->core_seconds() - server_before) / seconds;
  out.bot_cores = (fleet->bots().core_seconds() - bots_before) / seconds;
  out.server_mb = static_cast<double>(server->program->resident_bytes()) / 1e6;
  const auto seen = fleet->finish(testbed);
  if (!seen) return failed(seen);
  out.seen = *seen;
  out.kb_s_each = seen->bytes_received / 1000 / clients / (out.joined_s + seconds);
  if (const auto ended = testbed.stop_server(*server); !ended) return failed(ended);
  out.edits = counter_in(server->program->log(), "edits_ordered");
  out.commits = counter_in(server->program->log(), "commits");
  const double send_ms = counter_in(server->program->log(), "commit_send_ms");
  const double receivers = counter_in(server->program->log(), "commits_sent");
  if (receivers != 0)
    out.enqueue_us = counter_in(server->program->log(), "commit_enqueue_us") / receivers;
  if (out.commits != 0) out.send_us_per_commit = 1000 * send_ms / out.commits;
  return out;
}

void add_figures(const FleetResult& result, std::vector<Figure>& figures) {
  const auto add = [&](std::string name, double value) {
    std::string fleet = fmt::format("{} clients", result.clients);
    if (result.levels != 0) fleet += fmt::format(", {} levels", result.levels);
    figures.push_back({"crowd", "loopback", "loopback", std::move(fleet), std::move(name), value});
  };
  add("joined_s", result.joined_s);
  add("seen_p50_ms", result.seen.p50_ms);
  add("seen_p90_ms", result.seen.p90_ms);
  add("seen_p99_ms", result.seen.p99_ms);
  add("seen_max_ms", result.seen.max_ms);
  add("samples", result.seen.samples);
  add("never", result.seen.never);
  for (const SampleRow& row : result.seen.rows) {
    add(fmt::format("samples_{:.3f}_to_{:.3f}_ms", row.from_ms, row.below_ms), row.samples);
  }
  add("own_edits_only", result.seen.local_only ? 1 : 0);
  add("received_kb_s_each", result.kb_s_each);
  add("tiles", result.seen.tiles);
  add("server_cores", result.server_cores);
  add("bot_cores", result.bot_cores);
  add("server_resident_mb", result.server_mb);
  add("edits", result.edits);
  add("commits", result.commits);
  add("send_us_per_commit", result.send_us_per_commit);
  add("enqueue_us_per_receiver", result.enqueue_us);
  add("disconnects", result.seen.disconnects);
  add("rejected", result.seen.rejected);
  add("drifted_chunks", result.seen.drifted);
  add("violations", result.seen.violations);
}

void write_row(const FleetResult& result, std::string& out) {
  fmt::format_to(
      std::back_inserter(out),
      "| {} | {} | {} | {}, {}, {}, {} | {:.0f}, {:.0f} | {} | {:.0f} | {:.2f} | {:.2f} | {} "
      "| {} | {} | {:.2f} | {:.0f} |\n",
      result.clients, result.levels, number_text(result.joined_s), number_text(result.seen.p50_ms),
      number_text(result.seen.p90_ms), number_text(result.seen.p99_ms),
      number_text(result.seen.max_ms), result.seen.samples, result.seen.never,
      number_text(result.kb_s_each), result.seen.tiles / result.clients, result.server_cores,
      result.bot_cores, number_text(result.server_mb),
      result.commits == 0 ? "–" : number_text(result.edits / result.commits),
      number_text(result.send_us_per_commit), result.enqueue_us, result.seen.disconnects);
}

void judge(const std::vector<FleetResult>& results, const NetOptions& options,
           std::vector<Target>& targets) {
  const auto verdict = [](bool is_met) { return is_met ? Verdict::met : Verdict::missed; };
  std::map<std::pair<unsigned, unsigned>, std::vector<double>> p99_ms;  // by clients and levels
  for (const FleetResult& result : results) {
    p99_ms[{result.clients, result.levels}].push_back(result.seen.p99_ms);
    if (result.clients != kBigFleet || options.fleet_sites != 1 || result.levels != 0) continue;
    targets.push_back(
        {"1,000 clients in one place, 2 edits/s each: due to received and verified, "
         "all subscribers: p99; disconnects",
         fmt::format("under {} ms; 0", kBigFleetMsMax),
         fmt::format("{} ms; {:.0f}", number_text(result.seen.p99_ms), result.seen.disconnects),
         verdict(result.seen.p99_ms < kBigFleetMsMax && result.seen.disconnects == 0)});
    targets.push_back({"one more subscriber to a commit: processor time to enqueue",
                       fmt::format("under {} us", kEnqueueUsMax),
                       fmt::format("{:.2f} us", result.enqueue_us),
                       verdict(result.enqueue_us < kEnqueueUsMax)});
  }
  for (const auto& [fleet, times] : p99_ms) {
    const auto near = p99_ms.find({fleet.first, 0});
    if (fleet.second == 0 || near == p99_ms.end()) continue;
    const double ratio = median(times) / median(near->second);
    targets.push_back({fmt::format("{} clients that see {} levels of tiles: p99 of edits, against "
                                   "the same without tiles, medians of {} and {} runs",
                                   fleet.first, fleet.second, times.size(), near->second.size()),
                       fmt::format("at most {}x", kFarRatioMax), fmt::format("{:.2f}x", ratio),
                       verdict(ratio <= kFarRatioMax)});
  }
}

}  // namespace

Done measure_fleets(Testbed& testbed, NetFindings& findings) {
  std::string rows;
  std::vector<FleetResult> results;
  for (const unsigned clients : testbed.options().clients) {
    for (const unsigned levels : testbed.options().fleet_levels) {
      const auto result = run_fleet(testbed, clients, levels);
      if (!result) return failure(fmt::format("fleet of {}: {}", clients, result.error()));
      add_figures(*result, findings.figures);
      write_row(*result, rows);
      results.push_back(*result);
      fmt::print(testbed.progress(), "fleet of {}, {} levels\n", clients, levels);
      testbed.progress().flush();
    }
  }
  judge(results, testbed.options(), findings.targets);
  const bool local_only =
      std::ranges::any_of(results, [](const FleetResult& r) { return r.seen.local_only; });
  findings.tables += fmt::format(
      "\n### Crowds\n\n"
      "Loopback, {} place(s), {} edits a second each for {} s. Latency from when an edit was due until {}.\n\n"
      "| clients | levels of tiles | joined in s | p50, p90, p99, max ms | samples, never | "
      "received KB/s each | tiles each | server cores | bots' cores | server MB | edits a commit | "
      "send µs a commit | enqueue µs a receiver | disconnects |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
      testbed.options().fleet_sites, kFleetEditsPerSecond, testbed.options().fleet_seconds,
      local_only ? "its own bot had it confirmed"
                 : "each bot that sees it had received and verified it");
  findings.tables += rows;
  const FleetResult& largest = *std::ranges::max_element(results, {}, &FleetResult::clients);
  findings.tables += fmt::format("\nThese latencies of {} clients:\n\n", largest.clients);
  findings.tables += histogram_table(largest.seen.rows, largest.seen.never);
  return {};
}

}  // namespace runstone::bench
