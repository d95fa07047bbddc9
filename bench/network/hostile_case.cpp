#include "bench/network/hostile_case.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "bench/harness/statistics.hpp"
#include "bench/network/attack.hpp"
#include "bench/network/attacked_server.hpp"
#include "bench/network/echo_probe.hpp"
#include "bench/network/fleet.hpp"
#include "bench/network/hostile_result.hpp"
#include "bench/network/hostile_table.hpp"
#include "bench/network/join_probe.hpp"
#include "bench/network/message_flood.hpp"
#include "bench/network/strangers.hpp"
#include "common/os/open_files.hpp"

namespace runstone::bench {
namespace {

constexpr unsigned kHostileBuilders = 50, kHostileBuildersQuick = 5;
constexpr double kHostileEchoesPerSecond = 100;
constexpr double kAfterSeconds = 2;
constexpr int kLooksPerCount = 10;  // looks at the memory for each count of the open files
constexpr unsigned kStrangerAddresses = 250;  // each of another /24
constexpr std::size_t kOtherFiles = 1'000;    // of this process, besides the strangers' sockets

/// One row: who attacks, and how the server is started.
struct HostilePlan {
  std::string name;
  std::function<void(AttackThread&)> play;  // empty: nobody attacks
  unsigned threads = 1;
  unsigned addresses = 1;
  std::vector<std::string> flags;  // of the server
};

class HostileRun {
 public:
  HostileRun(Testbed& testbed, TestbedLink& link, const HostilePlan& plan)
      : testbed_(testbed), options_(testbed.options()), link_(link), plan_(plan) {}

  Result<HostileResult, std::string> run() {
    std::vector<std::string> flags = {"--generator", "terrain", "--seed", "7"};
    flags.insert(flags.end(), plan_.flags.begin(), plan_.flags.end());
    auto server = testbed_.start_server(link_, testbed_.fresh("world"), flags);
    if (!server) return failure(server.error());
    server_ = *std::move(server);
    out_.name = plan_.name;
    out_.addresses = plan_.addresses;
    out_.is_quiet = !plan_.play;
    out_.has_raised_limits = !plan_.flags.empty();
    out_.seconds = options_.attack_seconds;
    const auto idle = static_cast<double>(server_.program->open_files());
    if (auto done = build(out_.before, {}); !done) return failure(done.error());
    if (auto done = build(out_.during, plan_.play); !done) return failure(done.error());
    if (!pause_for(kAfterSeconds)) return failure("interrupted");
    out_.mb_after = resident_mb(server_);
    out_.sockets_after = static_cast<double>(server_.program->open_files()) - idle;
    if (auto stopped = testbed_.stop_server(server_); !stopped) return failure(stopped.error());
    out_.accepted = counter_in(server_.program->log(), "connections");
    out_.refused = counter_in(server_.program->log(), "refused");
    return out_;
  }

 private:
  /// Lets builders join, build and leave. Meanwhile newcomers join, and `play` attacks if there is
  /// one.
  Done build(HostilePhase& out, const std::function<void(AttackThread&)>& play) {
    const double seconds = options_.attack_seconds;
    auto fleet = Fleet::join(testbed_, link_, server_.address,
                             {.clients = options_.quick ? kHostileBuildersQuick : kHostileBuilders,
                              .seconds = seconds,
                              .has_replicas = false});
    if (!fleet) return failure(fleet.error());
    auto echo = EchoProbe::start(link_, kHostileEchoesPerSecond);
    if (!echo) return failure(echo.error());
    const double server_before = server_.program->core_seconds();
    const double bots_before = fleet->bots().core_seconds();
    std::optional<RunningAttack> attack;
    if (play) {
      attack.emplace(play, AttackPlan{server_.port, plan_.threads, plan_.addresses, seconds,
                                      options_.seed, !options_.insecure, !options_.quick});
    }
    JoinProbe probe(server_.port, !options_.insecure);
    for (int look = 0; look * kLookSeconds < seconds; ++look) {
      out.server_mb = std::max(out.server_mb, resident_mb(server_));
      if (look % kLooksPerCount == 0)
        out.server_files =
            std::max(out.server_files, static_cast<double>(server_.program->open_files()));
      if (!pause_for(kLookSeconds)) return failure("interrupted");
    }
    out.server_cores = (server_.program->core_seconds() - server_before) / seconds;
    out.bot_cores = (fleet->bots().core_seconds() - bots_before) / seconds;
    out.joins = probe.finish();
    const std::vector<double> echoes = (*echo)->stop();
    if (!echoes.empty()) out.echo_p99_ms = quantile(echoes, 0.99);
    if (attack) out.outcome = attack->finish();
    auto seen = fleet->finish(testbed_);
    if (!seen) return failure(seen.error());
    out.seen = *std::move(seen);
    return {};
  }

  Testbed& testbed_;
  const NetOptions& options_;
  TestbedLink& link_;
  const HostilePlan& plan_;
  TestbedServer server_;
  HostileResult out_;
};

Result<std::vector<HostileResult>, std::string> run_rows(Testbed& testbed,
                                                         const std::string& experiment,
                                                         const std::vector<HostilePlan>& plans) {
  auto link = testbed.make_link(test::link_profiles().front());
  if (!link) return failure(link.error());
  const std::vector<std::string>& wanted = testbed.options().attacks;
  std::vector<HostileResult> out;
  for (const HostilePlan& plan : plans) {
    const bool is_wanted = !plan.play || wanted.empty() ||
                           std::find(wanted.begin(), wanted.end(), plan.name) != wanted.end();
    if (!is_wanted) continue;
    auto row = HostileRun(testbed, **link, plan).run();
    if (!row) return failure(fmt::format("{}, {}: {}", experiment, plan.name, row.error()));
    fmt::print(testbed.progress(),
               "{}: {}, {} address(es): p99 {} ms before, {} ms during, {:+.1f} MB\n", experiment,
               row->name, row->addresses, number_text(row->before.seen.p99_ms),
               number_text(row->during.seen.p99_ms), row->grown_mb());
    testbed.progress().flush();
    out.push_back(*std::move(row));
  }
  return out;
}

HostilePlan quiet_plan() {
  HostilePlan plan;
  plan.name = kQuiet;
  return plan;
}

}  // namespace

Done measure_strangers(Testbed& testbed, NetFindings& findings) {
  const NetOptions& options = testbed.options();
  const unsigned count = options.strangers;
  if (const std::size_t files = allow_open_files(count + kOtherFiles);
      files < count + kOtherFiles) {
    return failure(fmt::format("strangers: {} sockets need a limit of {} open files; it is {}",
                               count, count + kOtherFiles, files));
  }
  // A server whose limits admit all strangers, to see what each of them costs.
  const std::string seats = fmt::to_string(count + kHostileBuilders);
  const std::vector<std::string> raised = {
      "--sessions-max",         seats, "--handshakes-per-address", seats,
      "--sessions-per-address", "0",   "--connections-per-second", "0"};
  std::vector<HostilePlan> plans = {quiet_plan()};
  for (const StrangerSort& sort : stranger_sorts()) {
    const auto play = [stages = sort.stages, count](AttackThread& thread) {
      hold_strangers(thread, stages, count);
    };
    plans.push_back({sort.name, play, 1, 1, {}});
    plans.push_back({sort.name, play, 1, kStrangerAddresses, {}});
    plans.push_back({sort.name, play, 1, kStrangerAddresses, raised});
  }
  auto rows = run_rows(testbed, "strangers", plans);
  if (!rows) return failure(rows.error());
  add_hostile_figures(*rows, "strangers", findings.figures);
  add_hostile_targets(*rows, "strangers", findings.targets);
  std::string text = fmt::format(
      "{} builders in one place on loopback, {} edits a second each, for {} s. {} strangers, at most "
      "{} new ones a second; whoever is ended comes again after a second. A server with default "
      "settings for each row; in rows with raised limits it admits all strangers.",
      options.quick ? kHostileBuildersQuick : kHostileBuilders, kFleetEditsPerSecond,
      options.attack_seconds, count, kStrangersPerSecond);
  findings.tables += hostile_table(*rows, "Strangers", text);
  for (const StrangerSort& sort : stranger_sorts())
    findings.tables += fmt::format("\n- {}: {}", sort.name, sort.what);
  findings.tables += "\n";
  return {};
}

Done measure_floods(Testbed& testbed, NetFindings& findings) {
  const NetOptions& options = testbed.options();
  std::vector<HostilePlan> plans = {quiet_plan()};
  for (const MessageKind kind : client_kinds()) {
    const auto play = [kind](AttackThread& thread) { flood_messages(thread, kind); };
    plans.push_back({info_of(kind).name, play, options.attackers, options.attacker_addresses, {}});
  }
  auto rows = run_rows(testbed, "floods", plans);
  if (!rows) return failure(rows.error());
  add_hostile_figures(*rows, "floods", findings.figures);
  add_hostile_targets(*rows, "floods", findings.targets);
  const std::string text = fmt::format(
      "{} builders in one place on loopback, {} edits a second each, for {} s. {} clients send "
      "messages of one kind as fast as the server reads them, with drawn contents. A server with "
      "default settings for each row.",
      options.quick ? kHostileBuildersQuick : kHostileBuilders, kFleetEditsPerSecond,
      options.attack_seconds, options.attackers);
  findings.tables += hostile_table(*rows, "Floods", text);
  return {};
}

}  // namespace runstone::bench
