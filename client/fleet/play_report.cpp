#include "client/fleet/play_report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "client/report/histogram_report.hpp"

namespace runstone {

void add_to(PlayCounts& sum, const PlayCounts& one) {
  sum.due += one.due;
  sum.submitted += one.submitted;
  sum.retried += one.retried;
  sum.confirmed += one.confirmed;
  sum.durable += one.durable;
  sum.unseen += one.unseen;
  for (const auto& [reason, count] : one.rejected) sum.rejected[reason] += count;
  for (const auto& [reason, count] : one.refused) sum.refused[reason] += count;
  sum.confirm_us.merge(one.confirm_us);
}

std::uint64_t sum_of(const std::map<std::string, std::uint64_t>& by_reason) {
  std::uint64_t sum = 0;
  for (const auto& [reason, count] : by_reason) sum += count;
  return sum;
}

std::string to_json(const PlayReport& report) {
  const PlayCounts& c = report.counts;
  const nlohmann::ordered_json json = {{"bots", report.bots},
                                       {"seconds", report.seconds},
                                       {"failure", report.failure},
                                       {"edits",
                                        {{"recorded", report.edits},
                                         {"due", c.due},
                                         {"submitted", c.submitted},
                                         {"again", c.retried},
                                         {"confirmed", c.confirmed},
                                         {"rejected", c.rejected},
                                         {"refused", c.refused},
                                         {"unseen", c.unseen},
                                         {"durable", c.durable}}},
                                       {"local_us", histogram_json(c.confirm_us)},
                                       {"traffic", traffic_json(report.traffic)}};
  return json.dump(1) + "\n";
}

std::string to_table(const PlayReport& report) {
  const PlayCounts& c = report.counts;
  std::string table = fmt::format(
      "bots {}: {} recorded edits, {} due in {:.1f} s, {} submitted, {} confirmed, {} durable; "
      "{} offered again, {} rejected, {} refused here, {} without an answer\n"
      "{}",
      report.bots, report.edits, c.due, report.seconds, c.submitted, c.confirmed, c.durable,
      c.retried, sum_of(c.rejected), sum_of(c.refused), c.unseen,
      histogram_line("due to confirmed", c.confirm_us));
  for (const auto& [reason, count] : c.rejected)
    table += fmt::format("rejected: {} {}\n", count, reason);
  for (const auto& [reason, count] : c.refused)
    table += fmt::format("refused: {} {}\n", count, reason);
  return table + traffic_table(report.traffic);
}

}  // namespace runstone
