#include "bench/network/fleet.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

namespace runstone::bench {
namespace {

using nlohmann::json;

// Seconds until all bots have joined, and until all edits are on disk.
constexpr double kPatience = 300;
constexpr double kFleetPollSeconds = 0.05;

double number_at(const json& object, const char* name) {
  const auto found = object.find(name);
  return found == object.end() ? 0 : number_in(*found);
}

}  // namespace

FleetReport fleet_report(const json& report) {
  const json none = json::object();
  FleetReport out;
  out.local_only = !report.contains("seen_us");
  const json& seen = report.value(out.local_only ? "local_us" : "seen_us", none);
  out.p50_ms = number_at(seen, "p50") / 1000;
  out.p90_ms = number_at(seen, "p90") / 1000;
  out.p99_ms = number_at(seen, "p99") / 1000;
  out.max_ms = number_at(seen, "max") / 1000;
  out.never = number_at(seen, "infinite");
  out.rows = sample_rows(seen);
  const json& edits = report.value("edits", none);
  out.due = number_at(edits, "due");
  out.samples = out.local_only ? number_at(edits, "confirmed") : number_at(seen, "count");
  out.rejected = number_at(edits, "rejected") + number_at(edits, "refused");
  const json& losses = report.value("losses", none);
  for (const auto& [reason, count] : losses.items()) out.disconnects += number_in(count);
  out.drifted = number_at(report, "drifted");
  const json& verified = report.value("verified", none);
  out.tiles = number_at(verified, "tiles");
  const json& violations = verified.value("violations", none);
  for (const auto& [name, entry] : violations.items()) out.violations += number_at(entry, "count");
  out.bytes_received = number_at(report, "bytes_received");
  return out;
}

Result<Fleet, std::string> Fleet::join(Testbed& testbed, TestbedLink& link,
                                       const std::string& address, const FleetPlan& plan) {
  Fleet out;
  out.plan_ = plan;
  out.report_ = testbed.fresh("report.json");
  std::vector<std::string> words = {"--connect",    address,
                                    "--count",      fmt::to_string(plan.clients),
                                    "--sites",      fmt::to_string(plan.sites),
                                    "--behaviour",  "build",
                                    "--far-levels", fmt::to_string(plan.far_levels),
                                    "--rate",       fmt::to_string(plan.edits_per_second),
                                    "--duration",   fmt::to_string(plan.seconds),
                                    "--seed",       fmt::to_string(testbed.options().seed),
                                    "--patience",   fmt::to_string(kPatience),
                                    "--report",     out.report_};
  if (!plan.has_replicas) words.insert(words.end(), {"--replicas", "0"});
  auto bots = testbed.start_client(link, "runstone-bot", std::move(words));
  if (!bots) return failure(bots.error());
  out.bots_ = *std::move(bots);
  for (; out.joined_s_ < kPatience && !out.bots_->wait(kFleetPollSeconds);
       out.joined_s_ += kFleetPollSeconds) {
    if (output_has(out.bots_->log(), "see the world")) return out;
    if (interrupted()) return failure("interrupted");
  }
  return failure(out.bots_->explain("did not join"));
}

Result<FleetReport, std::string> Fleet::finish(Testbed& testbed) {
  const auto ended = testbed.finish(*bots_, 2 * kPatience);
  const auto report = read_report(report_);
  if (!report) return failure(ended ? report.error() : ended.error());
  FleetReport out = fleet_report(*report);
  // In one place, every bot sees every edit that was not rejected.
  if (plan_.sites == 1 && !out.local_only)
    out.never = (out.due - out.rejected) * plan_.clients - out.samples;
  const bool broke_rules = out.violations != 0 || out.drifted != 0;
  if (!ended && !broke_rules) return failure(ended.error());
  return out;
}

}  // namespace runstone::bench
