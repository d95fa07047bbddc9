#include "tests/bench/network/attack_case.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <string_view>

#include "tests/bench/network/attack.hpp"
#include "tests/bench/network/fleet.hpp"
#include "tests/bench/network/join_probe.hpp"

namespace runstone::bench {
namespace {

constexpr double kLook = 0.02;
enum Phase : std::uint8_t { before, during, after };
constexpr std::array<const char*, 3> kPhases = {"before", "during", "after"};

struct AttackResult {
  std::string name;
  std::array<FleetReport, 3> seen;  // by phase
  JoinProbe::Joins joins;
  AttackOutcome outcome;
  // The reasons in the server's log. The log may drop lines.
  std::map<std::string, std::uint64_t> logged;
  // The memory at the end of the phase; for the attack itself, the peak.
  std::array<double, 3> resident_mb{};
  std::array<double, 3> server_cores{};
  double attacker_cores = 0;
  double written_mb = 0;  // to disk, during the attack
};

/// Returns the reasons in the log lines for ended sessions, such as "timed_out: no message for too
/// long".
std::map<std::string, std::uint64_t> reasons_in(const std::string& log) {
  const auto quoted = [](const std::string& line, std::string_view name) {
    const std::size_t at = line.find(name);
    if (at == std::string::npos) return std::string();
    const std::size_t begin = at + name.size();
    return line.substr(begin, line.find('"', begin) - begin);
  };
  std::map<std::string, std::uint64_t> out;
  std::ifstream in(log);
  for (std::string line; std::getline(in, line);) {
    const std::size_t reason = line.find(" reason=");
    const std::size_t open = line.find('(', reason);
    if (reason == std::string::npos || open == std::string::npos) continue;
    const std::string text = quoted(line, " text=\""), error = quoted(line, " error=\"");
    ++out[alike(line.substr(open + 1, line.find(')', open) - open - 1) + ": " +
                (text.empty() ? error : text))];
  }
  return out;
}

class AttackRun {
 public:
  AttackRun(Testbed& testbed, TestbedLink& link, const Attack& attack)
      : testbed_(testbed), link_(link), attack_(attack) {}

  Result<AttackResult, std::string> run() {
    // The server ends a silent session within the attack, not a minute after it.
    constexpr const char* kIdleSeconds = "5";
    auto server =
        testbed_.start_server(link_, testbed_.fresh("world"),
                              {"--generator", "terrain", "--seed", "7", "--idle-s", kIdleSeconds});
    if (!server) return Unexpected<std::string>{server.error()};
    server_ = *std::move(server);
    AttackResult out;
    out.name = attack_.name;
    for (const Phase phase : {before, during, after}) {
      if (const auto done = play(phase, out); !done) return Unexpected<std::string>{done.error()};
    }
    if (const auto ended = testbed_.stop_server(server_); !ended)
      return Unexpected<std::string>{ended.error()};
    out.logged = reasons_in(server_.program->log());
    return out;
  }

 private:
  Done play(Phase phase, AttackResult& out) {
    const double seconds = testbed_.options().attack_seconds;
    // Bots without a replica verify everything they receive.
    auto fleet = Fleet::join(testbed_, link_, server_.address, testbed_.options().attack_bots,
                             seconds, {"--replicas", "0"});
    if (!fleet) return Unexpected<std::string>{fleet.error()};
    const double cores_before = server_.program->core_seconds();
    const auto written_before = static_cast<double>(server_.program->written_bytes());
    std::optional<RunningAttack> attack;
    std::optional<JoinProbe> probe;
    if (phase == during) {
      attack.emplace(attack_, server_.port, testbed_.options().attackers, seconds,
                     testbed_.options().seed);
      probe.emplace(server_.port);
    }
    double& resident_mb = out.resident_mb[phase];
    for (double waited = 0; waited < seconds; waited += kLook) {
      const double now_mb = static_cast<double>(server_.program->resident_bytes()) / 1e6;
      resident_mb = phase == during ? std::max(resident_mb, now_mb) : now_mb;
      if (!pause_for(kLook)) return Unexpected<std::string>{"interrupted"};
    }
    out.server_cores[phase] = (server_.program->core_seconds() - cores_before) / seconds;
    if (phase == during) {
      out.joins = probe->finish();
      out.outcome = attack->finish();
      out.attacker_cores = out.outcome.core_seconds / seconds;
      out.written_mb =
          (static_cast<double>(server_.program->written_bytes()) - written_before) / 1e6;
    }
    const auto seen = fleet->finish(testbed_);
    if (!seen) return Unexpected<std::string>{seen.error()};
    out.seen[phase] = *seen;
    return {};
  }

  Testbed& testbed_;
  TestbedLink& link_;
  const Attack& attack_;
  TestbedServer server_;
};

void add_figures(const AttackResult& result, std::vector<Figure>& figures) {
  const auto add = [&](std::string name, double value) {
    figures.push_back({"attack", "loopback", "loopback", result.name, std::move(name), value});
  };
  for (const Phase phase : {before, during, after}) {
    const FleetReport& seen = result.seen[phase];
    const std::string when = kPhases[phase];
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
  add("joins_tried", result.joins.tried);
  add("joins_open", result.joins.open);
  add("joins_slowest_ms", result.joins.slowest_ms);
  add("attacker_cores", result.attacker_cores);
  add("during_written_mb", result.written_mb);
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

void write_rows(const AttackResult& result, std::string& latencies, std::string& answers) {
  const auto& seen = result.seen;
  const auto times = [](const FleetReport& of) {
    return fmt::format("{}, {}, {}", number_text(of.p50_ms), number_text(of.p99_ms),
                       number_text(of.max_ms));
  };
  double samples = 0, never = 0, disconnects = 0, violations = 0;
  for (const FleetReport& phase : seen) {
    samples += phase.samples;
    never += phase.never;
    disconnects += phase.disconnects;
    violations += phase.violations;
  }
  fmt::format_to(std::back_inserter(latencies),
                 "| {} | {} | {} | {} | {:.0f}, {:.0f} | {:.0f}, {:.0f} | {} of {}, {} | "
                 "{:.0f}, {:.0f}, {:.0f} | {:.1f} | {:.2f}, {:.2f} | {:.2f} |\n",
                 result.name, times(seen[before]), times(seen[during]), times(seen[after]), samples,
                 never, disconnects, violations, result.joins.open, result.joins.tried,
                 number_text(result.joins.slowest_ms), result.resident_mb[before],
                 result.resident_mb[during], result.resident_mb[after], result.written_mb,
                 result.server_cores[before], result.server_cores[during], result.attacker_cores);
  fmt::format_to(std::back_inserter(answers), "| {} | {} | {}, {} | {} | {} |\n", result.name,
                 result.outcome.connections,
                 number_text(static_cast<double>(result.outcome.bytes_sent) / 1e6),
                 number_text(static_cast<double>(result.outcome.bytes_received) / 1e6),
                 list_of(result.outcome.endings), list_of(result.logged));
}

}  // namespace

Done measure_attacks(Testbed& testbed, NetFindings& findings) {
  auto link = testbed.make_link(test::link_profiles().front());
  if (!link) return Unexpected<std::string>{link.error()};
  std::string latencies, answers;
  for (const Attack& attack : all_attacks()) {
    const auto& wanted = testbed.options().attacks;
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), attack.name) == wanted.end())
      continue;
    const auto result = AttackRun(testbed, **link, attack).run();
    if (!result)
      return Unexpected<std::string>{fmt::format("attack {}: {}", attack.name, result.error())};
    add_figures(*result, findings.figures);
    write_rows(*result, latencies, answers);
    fmt::print(testbed.progress(), "attack {}\n", attack.name);
    testbed.progress().flush();
  }
  findings.tables += fmt::format(
      "\n### Attacks\n\n"
      "Loopback: {} bots in one place with {} edits a second each, {} s before, "
      "during and after an attack of {} clients; a server for each attack. "
      "Latency from when an edit was due until each bot that sees it had received and verified "
      "it.\n\n"
      "| attack | before p50, p99, max ms | during | after | samples, never | "
      "bots disconnected, rules broken | newcomers accepted, slowest ms | "
      "server MB before, peak, after | MB written to disk during | "
      "server cores before, during | attackers' cores |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n"
      "{}\n"
      "| attack | connections | MB sent, received | answers to the attackers | "
      "reasons in the server's log |\n"
      "|---|---|---|---|---|\n"
      "{}",
      testbed.options().attack_bots, kFleetEditsPerSecond, testbed.options().attack_seconds,
      testbed.options().attackers, latencies, answers);
  findings.tables += "\n";
  for (const Attack& attack : all_attacks()) {
    findings.tables += fmt::format("- {}: {}\n", attack.name, attack.what);
  }
  return {};
}

}  // namespace runstone::bench
