#include "tests/bench/net/crowd_case.hpp"

#include <fmt/ostream.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

namespace runstone::bench {
namespace {

using nlohmann::json;

constexpr double kEditsPerSecond = 2;  // of each
constexpr double kPatience = 300;      // seconds until all have joined, and until all is on disk
constexpr unsigned kSpareSessions = 16;
constexpr unsigned kBigCrowd = 1000;  // the bar's
constexpr double kBigCrowdMsMax = 100;

struct CrowdResult {
  unsigned clients = 0;
  double joined_s = 0;                                    // until the last one saw the world
  double p50_ms = 0, p90_ms = 0, p99_ms = 0, max_ms = 0;  // due to received and verified, all subscribers
  double samples = 0, never = 0;
  bool own_only = false;                   // the bots' report knew only of own edits
  double kb_s_each = 0;                    // received by each client, from its start to its end
  double server_cores = 0, bot_cores = 0;  // while edits were due
  double server_mb = 0;                    // resident
  double edits = 0, commits = 0, send_us_per_commit = 0;
  double disconnects = 0, rejected = 0, drifted = 0;
};

/// The number behind `name=` in the last line of counters of a server's log; 0 if there is none.
double counter_in(const std::string& log, std::string_view name) {
  std::ifstream in(log);
  double out = 0;
  const std::string wanted = fmt::format(" {}=", name);
  for (std::string line; std::getline(in, line);) {
    const std::size_t at = line.find(wanted);
    if (line.find("counters ") != std::string::npos && at != std::string::npos) {
      out = std::strtod(line.c_str() + at + wanted.size(), nullptr);
    }
  }
  return out;
}

double number_at(const json& object, const char* name) {
  const auto found = object.find(name);
  return found == object.end() ? 0 : number_in(*found);
}

void take_report(const json& report, CrowdResult& result) {
  const json none = json::object();
  result.own_only = !report.contains("seen_us");
  const json& seen = report.value(result.own_only ? "own_us" : "seen_us", none);
  result.p50_ms = number_at(seen, "p50") / 1000;
  result.p90_ms = number_at(seen, "p90") / 1000;
  result.p99_ms = number_at(seen, "p99") / 1000;
  result.max_ms = number_at(seen, "max") / 1000;
  result.never = number_at(seen, "infinite");
  const json& edits = report.value("edits", none);
  result.samples = result.own_only ? number_at(edits, "confirmed") : number_at(seen, "count");
  result.rejected = number_at(edits, "rejected") + number_at(edits, "refused");
  result.disconnects = number_at(report, "losses");
  result.drifted = number_at(report, "drifted");
  result.kb_s_each = number_at(report, "bytes_received") / 1000 / result.clients;
}

Result<CrowdResult, std::string> run_crowd(Lab& lab, unsigned clients) {
  const auto failed = [](const auto& what) { return Unexpected<std::string>{what.error()}; };
  const double seconds = lab.options().crowd_seconds;
  auto link = lab.make_link(test::link_profiles().front());
  if (!link) return failed(link);
  auto server = lab.start_server(
      **link, lab.fresh("world"),
      {"--generator", "terrain", "--seed", "7", "--sessions-max", fmt::to_string(clients + kSpareSessions),
       "--handshakes-per-address", fmt::to_string(clients + kSpareSessions)});
  if (!server) return failed(server);
  const std::string report_file = lab.fresh("report.json");
  auto bots = lab.start_client(
      **link, "runstone-bot",
      {"--connect", server->address, "--count", fmt::to_string(clients), "--sites", "1", "--behaviour",
       "build", "--rate", fmt::to_string(kEditsPerSecond), "--duration", fmt::to_string(seconds), "--seed",
       fmt::to_string(lab.options().seed), "--patience", fmt::to_string(kPatience), "--report", report_file});
  if (!bots) return failed(bots);
  CrowdResult out;
  out.clients = clients;
  constexpr double kLook = 0.05;
  bool joined = false;
  for (; out.joined_s < kPatience && !joined && !(*bots)->wait(kLook); out.joined_s += kLook) {
    joined = output_has((*bots)->log(), "see the world");
    if (interrupted()) return Unexpected<std::string>{"interrupted"};
  }
  if (!joined) return Unexpected<std::string>{(*bots)->explain("did not join")};
  const double server_before = server->program->core_seconds(), bots_before = (*bots)->core_seconds();
  if (!pause_for(seconds)) return Unexpected<std::string>{"interrupted"};
  out.server_cores = (server->program->core_seconds() - server_before) / seconds;
  out.bot_cores = ((*bots)->core_seconds() - bots_before) / seconds;
  out.server_mb = static_cast<double>(server->program->resident_bytes()) / 1e6;
  if (const auto ended = lab.finish(**bots, 2 * kPatience); !ended) return failed(ended);
  const auto report = read_report(report_file);
  if (!report) return failed(report);
  take_report(*report, out);
  out.kb_s_each /= out.joined_s + seconds;
  if (const auto ended = lab.stop_server(*server); !ended) return failed(ended);
  out.edits = counter_in(server->program->log(), "edits_ordered");
  out.commits = counter_in(server->program->log(), "commits");
  const double send_ms = counter_in(server->program->log(), "commit_send_ms");
  if (out.commits != 0) out.send_us_per_commit = 1000 * send_ms / out.commits;
  return out;
}

void add_figures(const CrowdResult& result, std::vector<Figure>& figures) {
  const auto add = [&](const char* name, double value) {
    figures.push_back(
        {"crowd", "loopback", "loopback", fmt::format("{} clients", result.clients), name, value});
  };
  add("joined_s", result.joined_s);
  add("seen_p50_ms", result.p50_ms);
  add("seen_p90_ms", result.p90_ms);
  add("seen_p99_ms", result.p99_ms);
  add("seen_max_ms", result.max_ms);
  add("samples", result.samples);
  add("never", result.never);
  add("own_edits_only", result.own_only ? 1 : 0);
  add("received_kb_s_each", result.kb_s_each);
  add("server_cores", result.server_cores);
  add("bot_cores", result.bot_cores);
  add("server_resident_mb", result.server_mb);
  add("edits", result.edits);
  add("commits", result.commits);
  add("send_us_per_commit", result.send_us_per_commit);
  add("disconnects", result.disconnects);
  add("rejected", result.rejected);
  add("drifted_chunks", result.drifted);
}

void write_row(const CrowdResult& result, std::string& out) {
  fmt::format_to(
      std::back_inserter(out),
      "| {} | {} | {}, {}, {}, {} | {:.0f}, {:.0f} | {} | {:.2f} | {:.2f} | {} | {} | {} | {:.0f} |\n",
      result.clients, number_text(result.joined_s), number_text(result.p50_ms), number_text(result.p90_ms),
      number_text(result.p99_ms), number_text(result.max_ms), result.samples, result.never,
      number_text(result.kb_s_each), result.server_cores, result.bot_cores, number_text(result.server_mb),
      result.commits == 0 ? "–" : number_text(result.edits / result.commits),
      number_text(result.send_us_per_commit), result.disconnects);
}

}  // namespace

Done measure_crowds(Lab& lab, LabFindings& findings) {
  std::string rows;
  bool own_only = false;
  for (const unsigned clients : lab.options().clients) {
    const auto result = run_crowd(lab, clients);
    if (!result) return Unexpected<std::string>{fmt::format("crowd of {}: {}", clients, result.error())};
    own_only = own_only || result->own_only;
    add_figures(*result, findings.figures);
    write_row(*result, rows);
    if (clients == kBigCrowd) {
      findings.bars.push_back(
          {"1,000 clients in one place, 2 edits/s each: due to received and verified, all subscribers: p99; "
           "disconnects",
           fmt::format("under {} ms; 0", kBigCrowdMsMax),
           fmt::format("{} ms; {:.0f}", number_text(result->p99_ms), result->disconnects),
           result->p99_ms < kBigCrowdMsMax && result->disconnects == 0 ? Verdict::met : Verdict::missed});
    }
    fmt::print(lab.progress(), "crowd of {}\n", clients);
    lab.progress().flush();
  }
  findings.tables += fmt::format(
      "\n### Crowds\n\nLoopback, {} edits a second each for {} s. Latency from when an edit was due until "
      "{}.\n\n"
      "| clients | joined in s | p50, p90, p99, max ms | samples, never | received KB/s each | server cores "
      "| bots' cores "
      "| server MB | edits a commit | send µs a commit | disconnects "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|\n",
      kEditsPerSecond, lab.options().crowd_seconds,
      own_only ? "its own bot had it confirmed" : "each bot that sees it had received and verified it");
  findings.tables += rows;
  return {};
}

}  // namespace runstone::bench
