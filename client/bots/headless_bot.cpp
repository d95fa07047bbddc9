#include "client/bots/headless_bot.hpp"

#include <utility>

namespace runstone {

HeadlessBot::HeadlessBot(BotConfig config, FleetStatistics& fleet, TimeUs (*clock)())
    : Bot(std::move(config)), fleet_(fleet), session_(config_.session, fleet, clock) {}

bool HeadlessBot::offer(const EditDescriptor& edit, TimeUs due_us, TimeUs now_us) {
  return session_.offer(edit, due_us, now_us).has_value();
}

BotCounts HeadlessBot::counts() const {
  BotCounts counts = counts_;
  const HeadlessCounts& seen = session_.counts();
  const LocalEdits& local = session_.local_edits();
  counts.confirmed = local.counters().confirmed;
  counts.rejected = local.counters().rejected;
  counts.durable = local.counters().durable;
  counts.others = seen.edits - local.counters().confirmed;
  counts.confirm_us = seen.confirm_us;
  for (std::size_t i = 0; i < local.pending_count(); ++i) counts.confirm_us.add_infinite();
  return counts;
}

}  // namespace runstone
