#include "client/fleet/fleet_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "client/report/histogram_report.hpp"

namespace runstone {
namespace {

using Json = nlohmann::ordered_json;

/// Returns `bytes` per bot and second of the report.
double each_second(const FleetReport& report, std::uint64_t bytes) {
  const double of = static_cast<double>(std::max<std::size_t>(report.bots, 1)) * report.seconds;
  return of > 0 ? static_cast<double>(bytes) / of : 0;
}

double cores(const FleetReport& report) {
  return report.seconds > 0 ? (report.process.user_s + report.process.system_s) / report.seconds
                            : 0;
}

Json versions_json(const FleetReport& report) {
  const VersionCounts& v = report.versions;
  Json violations = Json::object();
  for (const auto& [name, entry] : report.violations.all()) {
    violations[name] = {{"count", entry.count}, {"first", entry.first}};
  }
  return {{"commits", report.commits},
          {"edits", report.commit_edits},
          {"snapshots", v.snapshots},
          {"tiles", v.tiles},
          {"chunk_edits_followed", v.followed},
          {"chunk_edits_contained", v.contained},
          {"chunk_edits_held_back", v.held_back},
          {"snapshots_stale", v.stale},
          {"answers_outside", v.outside},
          {"chunks_resent", v.resent},
          {"behind_us", histogram_json(v.behind_us)},
          {"versions_checked", v.versions_checked},
          {"violations", std::move(violations)}};
}

}  // namespace

std::string to_json(const FleetReport& report) {
  const BotCounts& c = report.counts;
  const auto by_class = [&](FrameClass frame_class) {
    return each_second(report, report.class_bytes[static_cast<std::size_t>(frame_class)]);
  };
  const Json json = {{"bots", report.bots},
                     {"replicas", report.replicas},
                     {"seconds", report.seconds},
                     {"failure", report.failure},
                     {"edits",
                      {{"due", c.due},
                       {"not_ready", c.not_ready},
                       {"refused", c.refused},
                       {"submitted", c.submitted},
                       {"confirmed", c.confirmed},
                       {"rejected", c.rejected},
                       {"durable", c.durable},
                       {"of_others", c.others}}},
                     {"local_us", histogram_json(c.confirm_us)},
                     {"seen_us", histogram_json(report.seen_us)},
                     {"seen_worst_us", report.seen_worst_us},
                     {"unattributed", report.unattributed},
                     {"joins", c.joins},
                     {"join_us", histogram_json(c.join_us)},
                     {"standing",
                      {{"held", report.standing.held},
                       {"intact", report.standing.intact},
                       {"changed", report.standing.changed},
                       {"unseen", report.standing.unseen}}},
                     {"digests_checked", report.digests_checked},
                     {"drifted", report.drifted},
                     {"verified", versions_json(report)},
                     {"losses", report.losses},
                     {"bytes_received", report.bytes_received},
                     {"bytes_sent", report.bytes_sent},
                     {"traffic", traffic_json(report.traffic)},
                     {"bytes_each_second",
                      {{"control", by_class(FrameClass::control)},
                       {"edits", by_class(FrameClass::edits)},
                       {"chunks", by_class(FrameClass::chunks)},
                       {"with_frames", each_second(report, report.frame_bytes)}}},
                     {"process",
                      {{"user_s", report.process.user_s},
                       {"system_s", report.process.system_s},
                       {"cores", cores(report)},
                       {"lag_us", histogram_json(report.lag_us)}}}};
  return json.dump(1) + "\n";
}

std::string to_table(const FleetReport& report) {
  const BotCounts& c = report.counts;
  const VersionCounts& v = report.versions;
  const auto by_class = [&](FrameClass frame_class) {
    return each_second(report, report.class_bytes[static_cast<std::size_t>(frame_class)]);
  };
  std::string table = fmt::format(
      "bots {} ({} with a replica): {} edits due in {:.1f} s, {} submitted, {} confirmed, "
      "{} rejected, {} durable; {} not ready, {} refused\n",
      report.bots, report.replicas, c.due, report.seconds, c.submitted, c.confirmed, c.rejected,
      c.durable, c.not_ready, c.refused);
  table += histogram_line("due to confirmed", c.confirm_us);
  table += histogram_line("due to received and verified, over all subscribers", report.seen_us);
  table += histogram_bars(report.seen_us);
  table += "slowest of each second, ms:";
  for (const TimeUs worst_us : report.seen_worst_us)
    table += fmt::format(" {}", (worst_us + 500) / 1000);
  table += "\n";
  table += histogram_line("connecting to all of the view", c.join_us);
  table += fmt::format(
      "voxels set and not set again: {}, of them {} intact, {} changed, {} out of sight\n"
      "edits of others seen {}; drift: {} of {} chunk digests\n",
      report.standing.held, report.standing.intact, report.standing.changed, report.standing.unseen,
      c.others, report.drifted, report.digests_checked);
  table += fmt::format(
      "without a replica: {} commits of {} edits verified, {} chunk edits followed, {} snapshots, "
      "{} chunks resent, {} versions checked, {} violations\n",
      report.commits, report.commit_edits, v.followed, v.snapshots, v.resent, v.versions_checked,
      report.violations.total());
  for (const auto& [name, entry] : report.violations.all()) {
    table += fmt::format("violation: {} {}, first: {}\n", entry.count, name, entry.first);
  }
  for (const auto& [reason, count] : report.losses)
    table += fmt::format("lost: {} {}\n", count, reason);
  table += fmt::format(
      "bytes a second and bot: control {:.0f}, edits {:.0f}, chunks {:.0f}; with frames {:.0f}\n",
      by_class(FrameClass::control), by_class(FrameClass::edits), by_class(FrameClass::chunks),
      each_second(report, report.frame_bytes));
  table += traffic_table(report.traffic);
  table += fmt::format("this process: {:.2f} s user, {:.2f} s system, {:.2f} cores\n",
                       report.process.user_s, report.process.system_s, cores(report));
  table += histogram_line("its steps late by", report.lag_us);
  return table;
}

}  // namespace runstone
