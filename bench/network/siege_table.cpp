#include "bench/network/siege_table.hpp"

#include <fmt/format.h>

#include <utility>

#include "bench/network/attacked_server.hpp"
#include "bench/network/siege_flags.hpp"

namespace runstone::bench {
namespace {

std::string siege_row(const SiegeWindow& window) {
  const FleetReport& seen = window.seen;
  return fmt::format(
      "| {:.0f} | {} | {}, {}, {} | {:.0f}, {:.0f} | {:.0f}, {:.0f}, {:.0f} | {:.0f} | "
      "{:.0f} |\n",
      window.from_s, window.attack, number_text(seen.p50_ms), number_text(seen.p99_ms),
      number_text(seen.max_ms), seen.samples, seen.never, seen.disconnects, seen.rejected,
      seen.violations, window.resident_mb, window.disk_kb_s);
}

}  // namespace

void add_siege_figures(const SiegeResult& result, std::vector<Figure>& figures) {
  std::string what;
  const auto add = [&](const char* name, double value) {
    figures.push_back({"siege", "loopback", "loopback", what, name, value});
  };
  for (std::size_t i = 0; i < result.windows.size(); ++i) {
    const SiegeWindow& window = result.windows[i];
    what = fmt::format("window {} {}", i, window.attack);
    add("from_s", window.from_s);
    add("to_s", window.to_s);
    add("p50_ms", window.seen.p50_ms);
    add("p99_ms", window.seen.p99_ms);
    add("max_ms", window.seen.max_ms);
    add("samples", window.seen.samples);
    add("never", window.seen.never);
    add("disconnects", window.seen.disconnects);
    add("rejected", window.seen.rejected);
    add("violations", window.seen.violations);
    add("server_resident_mb", window.resident_mb);
    add("disk_kb_s", window.disk_kb_s);
  }
  what = "all";
  add("server_resident_max_mb", result.resident_max_mb);
  add("stop_s", result.stop_s);
  add("errors_logged", static_cast<double>(result.errors));
}

void add_siege_targets(const SiegeResult& result, const NetOptions& options,
                       std::vector<Target>& targets) {
  const auto add = [&](const char* what, std::string wanted, std::string measured, bool is_met) {
    targets.push_back({fmt::format("siege of {} builders by {} attackers: {}", options.siege_bots,
                                   options.attackers, what),
                       std::move(wanted), std::move(measured),
                       is_met ? Verdict::met : Verdict::missed});
  };
  double never = 0, disconnects = 0;
  for (const SiegeWindow& window : result.windows) {
    never += window.seen.never;
    disconnects += window.seen.disconnects;
  }
  add("edits that a builder never saw", "0", fmt::format("{:.0f}", never), never == 0);
  add("lost connections of builders", "0", fmt::format("{:.0f}", disconnects), disconnects == 0);
  add("memory of the server", fmt::format("at most {} MB", number_text(kServerMbMax)),
      fmt::format("{} MB", number_text(result.resident_max_mb)),
      result.resident_max_mb <= kServerMbMax);
}

std::string siege_table(const SiegeResult& result, const NetOptions& options) {
  std::string rows, flags = "--idle-s 5";
  for (const SiegeWindow& window : result.windows) rows += siege_row(window);
  for (const std::string& word : siege_flags(options.siege_bots)) flags += " " + word;
  return fmt::format(
      "\n### Siege\n\n"
      "Loopback: {} bots in one place with {} edits a second each, in windows of {:.0f} s, and one "
      "server for all windows. In each window but the quiet ones, {} clients from {} address(es) "
      "attack. Every window has new bots, which join before it begins. Latency from when an edit "
      "was due until each bot that sees it had received and verified it. "
      "The server has default settings and `{}`: what exceeds the defaults is what that many bots "
      "from one address need, and the attackers' addresses have the same limits. "
      "Server MB: the highest in the window. Disk: bytes written in the window.\n\n"
      "| from s | attack | p50, p99, max ms | samples, never | "
      "bots disconnected, edits rejected, rules broken | server MB | disk KB/s |\n"
      "|---|---|---|---|---|---|---|\n"
      "{}\n"
      "The server stopped in {:.2f} s. Its log has {} line(s) of level error.\n",
      options.siege_bots, kFleetEditsPerSecond, kSiegeWindowSeconds, options.attackers,
      options.attacker_addresses, flags, rows, result.stop_s, result.errors);
}

}  // namespace runstone::bench
