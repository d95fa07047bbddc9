#include "bench/network/latency_case.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "bench/harness/statistics.hpp"
#include "bench/network/echo_probe.hpp"

namespace runstone::bench {
namespace {

using nlohmann::json;

constexpr double kEditsPerSecond = 50;
constexpr unsigned kLatencyView = 8, kLatencyViewVertical = 4;  // chunks
constexpr int kRoamVoxels = 128;                                // well inside the view
constexpr int kRoamSpeed = 640;                                 // voxels a second
constexpr unsigned kBots = 18;  // twenty clients together with the two
constexpr double kBotEditsPerSecond = 2;
constexpr double kLatencyWaitSeconds = 180;  // for worlds to load and edits to arrive

/// A client gives this command after its last edit, and the answer appears in its output. Then the
/// bots leave while the client still watches. An edit that is in flight when a client ends would
/// count as never seen.
constexpr const char* kDoneCommand = "help";
constexpr const char* kDoneAnswer = "undo";
constexpr int kBotsLeaveSeconds = 10;

struct Load {
  const char* name;
  bool streams;
  unsigned bots;
};
constexpr std::array<Load, 3> kLoads = {
    {{"idle", false, 0}, {"streaming", true, 0}, {"streaming, 20 clients", true, kBots}}};

struct Stage {
  const char* way;
  const char* stage;
  const char* title;
};
constexpr std::array<Stage, 12> kStages = {{
    {"local_predicted", "applied", "local edit, predicted: applied"},
    {"local_predicted", "meshed", "local edit, predicted: meshed"},
    {"local_confirmed", "ordered", "local edit, confirmed: ordered"},
    {"local_confirmed", "received", "local edit, confirmed: received"},
    {"local_confirmed", "unpacked", "local edit, confirmed: unpacked"},
    {"local_confirmed", "applied", "local edit, confirmed: applied"},
    {"remote", "ordered", "remote edit: ordered"},
    {"remote", "received", "remote edit: received"},
    {"remote", "unpacked", "remote edit: unpacked"},
    {"remote", "applied", "remote edit: applied"},
    {"remote", "meshed", "remote edit: meshed"},
    {"local_durable", "", "local edit: durable on disk"},
}};
constexpr std::array<const char*, 4> kRanks = {"p50", "p90", "p99", "max"};

/// Milliseconds by rank: the greater of both clients.
using Ranks = std::array<double, kRanks.size()>;

struct CaseResult {
  test::LinkProfile profile;
  LinkKind link = LinkKind::loopback;
  const Load* load = nullptr;
  std::map<std::string, Ranks> stages;  // by title
  Ranks echo{};
  double edits = 0, never = 0;  // remote edits due at the two clients; those never meshed
  double clock_error_ms = 0;    // of either client, measured against the true offset
  double terrain_kb = 0;        // received by each client, from the start
  double terrain_kb_s = 0;      // received by each client while the edits were made
  double drifted = 0;
  std::optional<TunCounts> passed;
};

const json& histogram_of(const json& report, const Stage& stage) {
  static const json kNone;
  const json& way = report["latency_us"][stage.way];
  if (*stage.stage == '\0') return way;
  const auto found = way["since_submit"].find(stage.stage);
  return found == way["since_submit"].end() ? kNone : *found;
}

void take_report(const json& report, CaseResult& result) {
  for (const Stage& stage : kStages) {
    const json& histogram = histogram_of(report, stage);
    if (histogram.is_null()) continue;
    Ranks& ranks = result.stages[stage.title];
    for (std::size_t i = 0; i < kRanks.size(); ++i) {
      ranks[i] = std::max(ranks[i], number_in(histogram[kRanks[i]]) / 1000);
    }
  }
  const json& meshed = histogram_of(report, kStages[10]);
  if (!meshed.is_null()) {
    result.edits += number_in(meshed["count"]);
    result.never += number_in(meshed["infinite"]);
  }
  // Server and clients read one clock here, so a client's estimate of the offset is its error.
  const json& clock = report["clock"];
  if (!clock.is_null()) {
    result.clock_error_ms =
        std::max(result.clock_error_ms, std::fabs(number_in(clock["offset_us"])) / 1000);
  }
  result.drifted += number_in(report["replica"]["drifted"]);
  result.terrain_kb += number_in(report["net"]["chunk_bytes"]) / 1000 / 2;
}

std::string script_of(const Testbed& testbed, const Load& load, unsigned client) {
  const unsigned edits = testbed.options().edits;
  // The move ends the roaming: a client that keeps flying never has the whole view.
  return fmt::format(
      "wait loaded {0}\nmove 0 ^+4 -20\nwait loaded {0}\nwait 5\n{1}burst {2} {3} 8 {4} wool_red\n"
      "move ~ ~ ~\nwait synced\nwait durable\ncommand {5}\nwait {6}\nwait synced\n",
      kLatencyWaitSeconds,
      load.streams ? fmt::format("roam ~{} ~ ~ {}\n", kRoamVoxels, kRoamSpeed) : "", edits,
      kEditsPerSecond, testbed.options().seed * 2 + client, kDoneCommand,
      load.bots == 0 ? 2 : kBotsLeaveSeconds);
}

Result<CaseResult, std::string> run_case(Testbed& testbed, const test::LinkProfile& profile,
                                         const Load& load) {
  const auto failed = [](const auto& what) { return failure(what.error()); };
  auto link = testbed.make_link(profile);
  if (!link) return failed(link);
  auto server =
      testbed.start_server(**link, testbed.fresh("world"),
                           without_player_limits({"--generator", "terrain", "--seed", "7"}));
  if (!server) return failed(server);
  std::unique_ptr<Child> bots;
  if (load.bots != 0) {
    auto started = testbed.start_client(
        **link, "runstone-bot",
        {"--connect", server->address, "--count", fmt::to_string(load.bots), "--behaviour", "build",
         "--rate", fmt::to_string(kBotEditsPerSecond), "--duration", "3600", "--patience",
         fmt::to_string(kLatencyWaitSeconds)});
    if (!started) return failed(started);
    bots = *std::move(started);
  }
  auto echo = EchoProbe::start(**link, kEditsPerSecond);
  if (!echo) return failed(echo);
  struct Running {
    std::unique_ptr<Child> program;
    std::string report;
  };
  std::vector<Running> clients;
  for (unsigned i = 0; i < 2; ++i) {
    const std::string script = testbed.fresh("script.txt"), report = testbed.fresh("report.json");
    write_text(script, script_of(testbed, load, i));
    auto client = testbed.start_client(
        **link, "runstone-client",
        {"--connect", server->address, "--name", i == 0 ? "carol" : "dave", "--no-render",
         "--workers", "1", "--view", fmt::to_string(kLatencyView), "--view-vertical",
         fmt::to_string(kLatencyViewVertical), "--script", script, "--report", report});
    if (!client) return failed(client);
    clients.push_back({*std::move(client), report});
  }
  if (bots) {
    wait_until(testbed.options().edits / kEditsPerSecond + 3 * kLatencyWaitSeconds, [&] {
      return std::all_of(clients.begin(), clients.end(), [](const Running& client) {
        return output_has(client.program->log(), kDoneAnswer) || client.program->wait(0);
      });
    });
    bots->terminate();
    if (const auto ended = testbed.finish(*bots, kLatencyWaitSeconds); !ended) return failed(ended);
  }
  CaseResult out;
  out.profile = profile;
  out.link = (*link)->kind();
  out.load = &load;
  const double edit_seconds = testbed.options().edits / kEditsPerSecond;
  for (Running& client : clients) {
    if (const auto ended = testbed.finish(*client.program, edit_seconds + 3 * kLatencyWaitSeconds);
        !ended)
      return failed(ended);
    const auto report = read_report(client.report);
    if (!report) return failed(report);
    take_report(*report, out);
  }
  const std::vector<double> echoes = (*echo)->stop();
  if (!echoes.empty()) {
    out.echo = {quantile(echoes, 0.5), quantile(echoes, 0.9), quantile(echoes, 0.99),
                *std::max_element(echoes.begin(), echoes.end())};
  }
  if (const auto ended = testbed.stop_server(*server); !ended) return failed(ended);
  out.passed = (*link)->stop();
  return out;
}

/// Returns the allowed latency: one network delay, the transmission of what is on the line, and 10
/// ms.
double allowed_ms(const test::LinkProfile& profile) {
  constexpr std::uint64_t kFrameBytes = 16 * 1024;
  constexpr double kOwnMs = 10;
  return static_cast<double>(profile.round_trip_ns + 2 * profile.jitter_ns +
                             2 * profile.transmit_ns(kFrameBytes)) /
             1e6 +
         kOwnMs;
}

const Ranks* find(const CaseResult& result, const char* title) {
  const auto it = result.stages.find(title);
  return it == result.stages.end() ? nullptr : &it->second;
}

std::string what_of(const CaseResult& result) {
  return fmt::format("{} {}", result.profile.name, result.load->name);
}

void add_figures(const CaseResult& result, NetFindings& findings) {
  const auto add = [&](const std::string& name, double value) {
    findings.figures.push_back({"latency", std::string(result.profile.name), name_of(result.link),
                                result.load->bots == 0 ? result.load->name : "streaming 20 clients",
                                name, value});
  };
  for (const Stage& stage : kStages) {
    const Ranks* ranks = find(result, stage.title);
    if (ranks == nullptr) continue;
    for (std::size_t i = 0; i < kRanks.size(); ++i) {
      add(fmt::format("{}{}{}_{}_ms", stage.way, *stage.stage == '\0' ? "" : "_", stage.stage,
                      kRanks[i]),
          (*ranks)[i]);
    }
  }
  for (std::size_t i = 0; i < kRanks.size(); ++i)
    add(fmt::format("echo_{}_ms", kRanks[i]), result.echo[i]);
  add("remote_edits", result.edits);
  add("remote_never_meshed", result.never);
  add("clock_error_ms", result.clock_error_ms);
  add("terrain_kb_s", result.terrain_kb_s);
  add("drifted_chunks", result.drifted);
  if (!result.passed) return;
  add("forwarder_late_p99_us", result.passed->late_us_p99);
  add("forwarder_late_max_us", result.passed->late_us_max);
  add("forwarder_core_share", result.passed->busy);
  add("packets_lost",
      static_cast<double>(result.passed->to_client.lost + result.passed->to_server.lost));
  add("packets_without_room",
      static_cast<double>(result.passed->to_client.no_room + result.passed->to_server.no_room));
}

void add_targets(const CaseResult& result, std::vector<Target>& targets) {
  const auto judged = [&](std::string what, std::string wanted, std::string measured, bool met) {
    targets.push_back({std::move(what), std::move(wanted), std::move(measured),
                       met ? Verdict::met : Verdict::missed});
  };
  const Ranks* remote = find(result, "remote edit: meshed");
  const Ranks* own = find(result, "local edit, predicted: meshed");
  if (remote == nullptr || own == nullptr) return;
  if (result.profile.passes_all() && !result.load->streams) {
    judged("remote edit, loopback, idle, submit to meshed: p50", "1 ms",
           number_text((*remote)[0]) + " ms", (*remote)[0] <= 1);
    judged("the same: p99, against that of a bare Asio echo in the same run", "3 ms above",
           fmt::format("{} ms; the echo {} ms", number_text((*remote)[2]),
                       number_text(result.echo[2])),
           (*remote)[2] <= result.echo[2] + 3);
  }
  if (!result.profile.passes_all() && result.load->streams && result.profile.loss == 0) {
    judged(fmt::format("remote edit, {}: p99", what_of(result)),
           number_text(allowed_ms(result.profile)) + " ms", number_text((*remote)[2]) + " ms",
           (*remote)[2] <= allowed_ms(result.profile));
  }
  judged(fmt::format("local edit, submit to meshed, {}: p99", what_of(result)), "2 ms",
         number_text((*own)[2]) + " ms", (*own)[2] <= 2);
}

/// Writes a row for each case: its load, and the first and the last stage.
void write_overview(const std::vector<CaseResult>& results, std::string& out) {
  const auto into = std::back_inserter(out);
  fmt::format_to(
      into,
      "| link | load | terrain KB/s each | echo p50, p99 | local edit meshed p50, p99 | "
      "remote edit meshed p50, p99, max | never | clocks off by | forwarder late p99, max µs |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  for (const CaseResult& result : results) {
    const Ranks* remote = find(result, "remote edit: meshed");
    const Ranks* own = find(result, "local edit, predicted: meshed");
    if (remote == nullptr || own == nullptr) continue;
    fmt::format_to(
        into, "| {} ({}) | {} | {} | {}, {} | {}, {} | {}, {}, {} | {:.0f} of {:.0f} | {} | {} |\n",
        result.profile.name, name_of(result.link), result.load->name,
        number_text(result.terrain_kb_s), number_text(result.echo[0]), number_text(result.echo[2]),
        number_text((*own)[0]), number_text((*own)[2]), number_text((*remote)[0]),
        number_text((*remote)[2]), number_text((*remote)[3]), result.never, result.edits,
        number_text(result.clock_error_ms),
        result.passed ? fmt::format("{}, {}", number_text(result.passed->late_us_p99),
                                    number_text(result.passed->late_us_max))
                      : "–");
  }
}

/// Writes a table for each load: a row for each stage, a column for each link.
void write_stages(const std::vector<CaseResult>& results, std::string& out) {
  const auto into = std::back_inserter(out);
  for (const Load& load : kLoads) {
    std::vector<const CaseResult*> of;
    for (const CaseResult& result : results) {
      if (result.load == &load) of.push_back(&result);
    }
    if (of.empty()) continue;
    fmt::format_to(into, "\n{}, ms since the edit was due, p50 and p99:\n\n| stage |", load.name);
    for (const CaseResult* result : of) fmt::format_to(into, " {} |", result->profile.name);
    fmt::format_to(into, "\n|---|");
    for (std::size_t i = 0; i < of.size(); ++i) fmt::format_to(into, "---|");
    fmt::format_to(into, "\n");
    for (const Stage& stage : kStages) {
      fmt::format_to(into, "| {} |", stage.title);
      for (const CaseResult* result : of) {
        const Ranks* ranks = find(*result, stage.title);
        fmt::format_to(into, " {} |",
                       ranks == nullptr ? "–"
                                        : fmt::format("{}, {}", number_text((*ranks)[0]),
                                                      number_text((*ranks)[2])));
      }
      fmt::format_to(into, "\n");
    }
    fmt::format_to(into, "| a bare Asio echo |");
    for (const CaseResult* result : of) {
      fmt::format_to(into, " {}, {} |", number_text(result->echo[0]), number_text(result->echo[2]));
    }
    fmt::format_to(into, "\n");
  }
}

}  // namespace

Done measure_latency(Testbed& testbed, NetFindings& findings) {
  std::vector<CaseResult> results;
  for (const test::LinkProfile& profile : testbed.profiles()) {
    double join_kb = 0;
    for (const Load& load : kLoads) {
      auto result = run_case(testbed, profile, load);
      if (!result) {
        return failure(fmt::format("latency, {} {}: {}", profile.name, load.name, result.error()));
      }
      // The terrain during the edits is all terrain without that of the join, which is what the
      // idle case receives.
      if (!load.streams) join_kb = result->terrain_kb;
      result->terrain_kb_s =
          (result->terrain_kb - join_kb) * kEditsPerSecond / testbed.options().edits;
      add_figures(*result, findings);
      add_targets(*result, findings.targets);
      fmt::print(testbed.progress(), "latency {}\n", what_of(*result));
      testbed.progress().flush();
      results.push_back(*std::move(result));
    }
  }
  findings.tables += "\n### Latency-plus-mesh\n\n";
  write_overview(results, findings.tables);
  write_stages(results, findings.tables);
  return {};
}

}  // namespace runstone::bench
