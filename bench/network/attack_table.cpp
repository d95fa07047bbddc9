#include "bench/network/attack_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>

#include "bench/network/attacked_server.hpp"
#include "bench/network/page_table.hpp"

namespace runstone::bench {
namespace {

// The targets.
constexpr double kOfQuietMax = 2, kAttackedMsMax = 10;
constexpr double kDiskKbMax = 100;
constexpr double kStopSecondsMax = 8;

double of_quiet(const AttackResult& result, const AttackResult& quiet) {
  return result.seen[during].p99_ms / quiet.seen[during].p99_ms;
}

double disk_kb_s(const AttackResult& result, const NetOptions& options) {
  return result.written_kb / options.attack_seconds;
}

/// Returns the KB that the server wrote for each attacker and second, more than without an attack.
/// They include the snapshots of the stop. Attackers attack twice: beside builders and at the stop.
double disk_kb_s_each(const AttackResult& result, const AttackResult& quiet,
                      const NetOptions& options) {
  const double more = std::max(0.0, result.written_all_kb - quiet.written_all_kb);
  return more / (2 * options.attack_seconds * options.attackers);
}

void add_figures_of(const AttackResult& result, const AttackResult& quiet,
                    const NetOptions& options, std::vector<Figure>& figures) {
  const auto add = [&](std::string name, double value) {
    figures.push_back({"attack", "loopback", "loopback", result.name, std::move(name), value});
  };
  for (const AttackPhase phase : kAttackPhases) {
    const FleetReport& seen = result.seen[phase];
    const std::string when = kAttackPhaseNames[phase];
    add(when + "_p50_ms", seen.p50_ms);
    add(when + "_p99_ms", seen.p99_ms);
    add(when + "_max_ms", seen.max_ms);
    add(when + "_samples", seen.samples);
    add(when + "_never", seen.never);
    add(when + "_disconnects", seen.disconnects);
    add(when + "_violations", seen.violations);
    add(when + "_server_resident_mb", result.resident_mb[phase]);
    add(when + "_server_cores", result.server_cores[phase]);
  }
  add("during_p99_of_quiet", of_quiet(result, quiet));
  add("during_echo_p99_ms", result.echo_p99_ms);
  add("server_resident_max_mb", result.resident_max_mb);
  add("during_disk_kb_s", disk_kb_s(result, options));
  add("disk_kb_s_per_attacker", disk_kb_s_each(result, quiet, options));
  add("stop_s", result.stop_s);
  add("joins_tried", result.joins.tried);
  add("joins_open", result.joins.open);
  add("joins_slowest_ms", result.joins.slowest_ms);
  add("bot_cores", result.bot_cores);
  add("attacker_cores", result.attacker_cores);
  add("attacker_connections", static_cast<double>(result.outcome.connections));
  add("attacker_sent_mb", static_cast<double>(result.outcome.bytes_sent) / 1e6);
  add("attacker_received_mb", static_cast<double>(result.outcome.bytes_received) / 1e6);
  const auto add_reasons = [&](const char* where,
                               const std::map<std::string, std::uint64_t>& reasons) {
    std::map<std::string, std::uint64_t> sums;  // by reason, without its details
    for (const auto& [reason, count] : reasons) sums[reason.substr(0, reason.find(':'))] += count;
    for (const auto& [reason, count] : sums) {
      add(fmt::format("{} {}", where, reason), static_cast<double>(count));
    }
  };
  add_reasons("told", result.outcome.endings);
  add_reasons("logged", result.logged);
}

std::string list_of(const std::map<std::string, std::uint64_t>& reasons) {
  std::string out;
  for (const auto& [reason, count] : reasons) {
    fmt::format_to(std::back_inserter(out), "{}{} × {}", out.empty() ? "" : "; ", count, reason);
  }
  return out.empty() ? "–" : out;
}

std::string times(const FleetReport& seen) {
  return fmt::format("{}, {}, {}", number_text(seen.p50_ms), number_text(seen.p99_ms),
                     number_text(seen.max_ms));
}

/// Returns the target that newcomers from other ranges find a seat.
Target newcomers_target(const AttackResult& result) {
  const JoinProbe::Joins& joins = result.joins;
  return {fmt::format("{}: newcomers from other ranges who found a seat", result.name), "all",
          fmt::format("{} of {}, the slowest after {} ms", joins.open, joins.tried,
                      number_text(joins.slowest_ms)),
          joins.tried > 0 && joins.open == joins.tried ? Verdict::met : Verdict::missed};
}

std::string load_row(const AttackResult& result, const AttackResult& quiet,
                     const NetOptions& options) {
  return fmt::format(
      "| {} | {} | {} | {:.2f} | {} | {:.0f} | {:.0f}, {:.1f} | {:.2f} |\n", result.name,
      number_text(result.seen[during].p50_ms), number_text(result.seen[during].p99_ms),
      of_quiet(result, quiet), number_text(result.echo_p99_ms), result.resident_max_mb,
      disk_kb_s(result, options), disk_kb_s_each(result, quiet, options), result.stop_s);
}

std::string builders_row(const AttackResult& result) {
  const auto& seen = result.seen;
  double samples = 0, never = 0, disconnects = 0, violations = 0;
  for (const FleetReport& phase : seen) {
    samples += phase.samples;
    never += phase.never;
    disconnects += phase.disconnects;
    violations += phase.violations;
  }
  return fmt::format(
      "| {} | {} | {} | {} | {:.0f}, {:.0f} | {:.0f}, {:.0f} | {} of {}, {} | "
      "{:.0f}, {:.0f}, {:.0f} | {:.2f}, {:.2f} | {:.2f} | {:.2f} |\n",
      result.name, times(seen[before]), times(seen[during]), times(seen[after]), samples, never,
      disconnects, violations, result.joins.open, result.joins.tried,
      number_text(result.joins.slowest_ms), result.resident_mb[before], result.resident_mb[during],
      result.resident_mb[after], result.server_cores[before], result.server_cores[during],
      result.bot_cores, result.attacker_cores);
}

std::string answers_row(const AttackResult& result) {
  return fmt::format("| {} | {} | {}, {} | {} | {} |\n", result.name, result.outcome.connections,
                     number_text(static_cast<double>(result.outcome.bytes_sent) / 1e6),
                     number_text(static_cast<double>(result.outcome.bytes_received) / 1e6),
                     list_of(result.outcome.endings), list_of(result.logged));
}

}  // namespace

void add_attack_figures(std::span<const AttackResult> results, const NetOptions& options,
                        std::vector<Figure>& figures) {
  for (const AttackResult& result : results) {
    add_figures_of(result, results.front(), options, figures);
    add_page_figures(result, figures);
  }
}

void add_attack_targets(std::span<const AttackResult> results, const NetOptions& options,
                        std::vector<Target>& targets) {
  const AttackResult& quiet = results.front();
  const auto add = [&](const char* what, const char* unit, double most, const auto& measure) {
    const AttackResult* worst = nullptr;
    for (const AttackResult& result : results) {
      if (result.is_hostile && (worst == nullptr || measure(*worst) < measure(result)))
        worst = &result;
    }
    if (worst == nullptr) return;
    targets.push_back(
        {fmt::format("{} attackers, the worst of all attacks: {}", options.attackers, what),
         fmt::format("at most {} {}", number_text(most), unit),
         fmt::format("{} {} ({})", number_text(measure(*worst)), unit, worst->name),
         measure(*worst) <= most ? Verdict::met : Verdict::missed});
  };
  add("p99 of honest builders", "ms", kAttackedMsMax,
      [](const AttackResult& result) { return result.seen[during].p99_ms; });
  add("the same, against that without an attack", "times", kOfQuietMax,
      [&](const AttackResult& result) { return of_quiet(result, quiet); });
  add("memory of the server", "MB", kServerMbMax,
      [](const AttackResult& result) { return result.resident_max_mb; });
  add("disk written for each attacker", "KB/s", kDiskKbMax,
      [&](const AttackResult& result) { return disk_kb_s_each(result, quiet, options); });
  add("orderly stop", "s", kStopSecondsMax,
      [](const AttackResult& result) { return result.stop_s; });
  for (const AttackResult& result : results) {
    if (result.name == kSeatsByRange) targets.push_back(newcomers_target(result));
  }
  add_page_targets(results, targets);
}

std::string attack_tables(std::span<const AttackResult> results, const NetOptions& options) {
  std::string loads, builders, answers, list;
  for (const AttackResult& result : results) {
    loads += load_row(result, results.front(), options);
    builders += builders_row(result);
    answers += answers_row(result);
  }
  for (const Attack& attack : all_attacks()) {
    fmt::format_to(std::back_inserter(list), "- {}: {}\n", attack.name, attack.what);
  }
  return fmt::format(
      "\n### Attacks\n\n"
      "Loopback: {} bots in one place with {} edits a second each, {} s before, "
      "during and after an attack of {} clients from {} address(es); a server for each attack. "
      "Latency from when an edit was due until each bot that sees it had received and verified "
      "it. The server is stopped after {} s of a second attack, which goes on meanwhile. "
      "The echo is the round trip of a message to a plain Asio server in the same seconds: it shows "
      "the load of the machine. "
      "Disk: bytes written during the first attack; for each attacker, bytes written from the "
      "first attack to the end of the server, less those of the quiet row.\n\n"
      "| attack | p50 ms | p99 ms | p99, times quiet | echo p99 ms | server MB, most | "
      "disk KB/s, each attacker | stop s |\n"
      "|---|---|---|---|---|---|---|---|\n"
      "{}\n"
      "| attack | before p50, p99, max ms | during | after | samples, never | "
      "bots disconnected, rules broken | newcomers accepted, slowest ms | "
      "server MB before, peak, after | server cores before, during | bots' cores | attackers' cores |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n"
      "{}{}\n"
      "| attack | connections | MB sent, received | answers to the attackers | "
      "reasons in the server's log |\n"
      "|---|---|---|---|---|\n"
      "{}\n{}",
      options.attack_bots, kAttackedEditsPerSecond, options.attack_seconds, options.attackers,
      options.attacker_addresses, options.attack_seconds, loads, builders, page_table(results),
      answers, list);
}

}  // namespace runstone::bench
