#include "bench/network/hostile_table.hpp"

#include <fmt/format.h>

#include <iterator>
#include <map>

#include "bench/harness/statistics.hpp"

namespace runstone::bench {
namespace {

// The targets.
constexpr double kTimesQuietMax = 2, kGrownMbMax = 64;

/// Returns the p99 of builders beside whom nobody attacks: the median of all such phases of the
/// run.
double quiet_p99_ms(std::span<const HostileResult> results) {
  std::vector<double> values;
  for (const HostileResult& result : results) values.push_back(result.before.seen.p99_ms);
  return median(values);
}

double lost_connections(const HostileResult& result) {
  return result.before.seen.disconnects + result.during.seen.disconnects;
}

/// Returns the KB by which the server grew for each connection that it held.
double kb_each(const HostileResult& result) {
  return result.sockets_during() > 0 ? result.grown_mb() * 1e3 / result.sockets_during() : 0;
}

std::string label_of(const HostileResult& result) {
  std::string out = result.name;
  if (!result.is_quiet) out += fmt::format(", {} address(es)", result.addresses);
  if (result.has_raised_limits) out += ", raised limits";
  return out;
}

std::string endings_of(const AttackOutcome& outcome) {
  std::string out;
  for (const auto& [ending, count] : outcome.endings)
    fmt::format_to(std::back_inserter(out), "{}{} × {}", out.empty() ? "" : "; ", count, ending);
  return out.empty() ? "–" : out;
}

}  // namespace

void add_hostile_figures(std::span<const HostileResult> results, const std::string& experiment,
                         std::vector<Figure>& figures) {
  const double quiet_ms = quiet_p99_ms(results);
  for (const HostileResult& result : results) {
    const auto add = [&](std::string name, double value) {
      figures.push_back(
          {experiment, "loopback", "loopback", label_of(result), std::move(name), value});
    };
    const auto add_phase = [&](const std::string& when, const HostilePhase& phase) {
      add(when + "_p50_ms", phase.seen.p50_ms);
      add(when + "_p99_ms", phase.seen.p99_ms);
      add(when + "_max_ms", phase.seen.max_ms);
      add(when + "_samples", phase.seen.samples);
      add(when + "_never", phase.seen.never);
      add(when + "_disconnects", phase.seen.disconnects);
      add(when + "_violations", phase.seen.violations);
      add(when + "_joins_tried", phase.joins.tried);
      add(when + "_joins_open", phase.joins.open);
      add(when + "_joins_slowest_ms", phase.joins.slowest_ms);
      add(when + "_echo_p99_ms", phase.echo_p99_ms);
      add(when + "_server_mb", phase.server_mb);
      add(when + "_server_files", phase.server_files);
      add(when + "_server_cores", phase.server_cores);
      add(when + "_bot_cores", phase.bot_cores);
    };
    add_phase("before", result.before);
    add_phase("during", result.during);
    add("during_p99_of_quiet", result.during.seen.p99_ms / quiet_ms);
    add("grown_mb", result.grown_mb());
    add("after_server_mb", result.mb_after);
    add("sockets_during", result.sockets_during());
    add("sockets_after", result.sockets_after);
    add("grown_kb_per_socket", kb_each(result));
    add("attacker_cores", result.attacker_cores());
    add("accepted", result.accepted);
    add("refused", result.refused);
    const AttackOutcome& outcome = result.during.outcome;
    add("attacker_connections", static_cast<double>(outcome.connections));
    add("attacker_sent_mb", static_cast<double>(outcome.bytes_sent) / 1e6);
    add("attacker_received_mb", static_cast<double>(outcome.bytes_received) / 1e6);
    std::map<std::string, std::uint64_t> told;  // by reason, without its details
    for (const auto& [ending, count] : outcome.endings)
      told[ending.substr(0, ending.find(':'))] += count;
    for (const auto& [ending, count] : told) add("told " + ending, static_cast<double>(count));
  }
}

void add_hostile_targets(std::span<const HostileResult> results, const std::string& experiment,
                         std::vector<Target>& targets) {
  const double quiet_ms = quiet_p99_ms(results);
  const auto add = [&](const char* what, const char* unit, double most, const auto& measure) {
    const HostileResult* worst = nullptr;
    for (const HostileResult& result : results) {
      if (result.is_quiet || result.has_raised_limits) continue;
      if (worst == nullptr || measure(*worst) < measure(result)) worst = &result;
    }
    if (worst == nullptr) return;
    targets.push_back(
        {fmt::format("{}, the worst row: {}", experiment, what),
         fmt::format("at most {} {}", number_text(most), unit),
         fmt::format("{} {} ({})", number_text(measure(*worst)), unit, label_of(*worst)),
         measure(*worst) <= most ? Verdict::met : Verdict::missed});
  };
  add("p99 of the builders, against that of quiet phases of the run", "times", kTimesQuietMax,
      [&](const HostileResult& result) { return result.during.seen.p99_ms / quiet_ms; });
  add("memory of the server, more than before", "MB", kGrownMbMax,
      [](const HostileResult& result) { return result.grown_mb(); });
  add("builders that lost their connection", "", 0, lost_connections);
}

std::string hostile_table(std::span<const HostileResult> results, const std::string& title,
                          const std::string& text) {
  const double quiet_ms = quiet_p99_ms(results);
  std::string rows, costs, answers;
  const auto times = [](const FleetReport& seen) {
    return fmt::format("{}, {}, {}", number_text(seen.p50_ms), number_text(seen.p99_ms),
                       number_text(seen.max_ms));
  };
  for (const HostileResult& result : results) {
    const HostilePhase &before = result.before, &during = result.during;
    const AttackOutcome& outcome = during.outcome;
    fmt::format_to(std::back_inserter(rows),
                   "| {} | {} | {} | {:.2f} | {:.0f}, {:.0f} | {:.0f} | {} of {}, {} | {}, {} |\n",
                   label_of(result), times(before.seen), times(during.seen),
                   during.seen.p99_ms / quiet_ms, during.seen.samples, during.seen.never,
                   lost_connections(result), during.joins.open, during.joins.tried,
                   number_text(during.joins.slowest_ms), number_text(before.echo_p99_ms),
                   number_text(during.echo_p99_ms));
    fmt::format_to(std::back_inserter(costs),
                   "| {} | {:.0f} | {:+.1f}, {:+.1f} | {:.0f}, {:.0f} | {:.1f} | {:.2f}, {:.2f} | "
                   "{:.2f}, {:.2f} |\n",
                   label_of(result), before.server_mb, result.grown_mb(),
                   result.mb_after - before.server_mb, result.sockets_during(),
                   result.sockets_after, kb_each(result), before.server_cores, during.server_cores,
                   during.bot_cores, result.attacker_cores());
    fmt::format_to(std::back_inserter(answers), "| {} | {} | {:.0f}, {:.0f} | {}, {} | {} |\n",
                   label_of(result), outcome.connections, result.accepted, result.refused,
                   number_text(static_cast<double>(outcome.bytes_sent) / 1e6),
                   number_text(static_cast<double>(outcome.bytes_received) / 1e6),
                   endings_of(outcome));
  }
  return fmt::format(
      "\n### {}\n\n{}\n\n"
      "Latency from when an edit was due until each builder had received and verified it; \"times "
      "quiet\" compares its p99 with {} ms, the median p99 of all phases of this run without an "
      "attack. Newcomers join ten times a second and leave. The echo is the round trip of a message "
      "to a plain Asio server in the same seconds: it shows the load of the machine. Memory: "
      "resident, the most before the attack, and how much more it was at most during the attack and "
      "two seconds after it. Sockets: of the attackers, as many as the server held at a time, and "
      "two seconds after the attack.\n\n"
      "| row | before: p50, p99, max ms | during | p99, times quiet | samples, never | "
      "builders disconnected | newcomers accepted, slowest ms | echo p99 ms before, during |\n"
      "|---|---|---|---|---|---|---|---|\n"
      "{}\n"
      "| row | server MB before | more during, after | sockets during, after | KB a socket | "
      "server cores before, during | builders' cores, attackers' |\n"
      "|---|---|---|---|---|---|---|\n"
      "{}\n"
      "| row | connections tried | all accepted, refused | MB sent, received | "
      "answers to the attackers |\n"
      "|---|---|---|---|---|\n"
      "{}",
      title, text, number_text(quiet_ms), rows, costs, answers);
}

}  // namespace runstone::bench
