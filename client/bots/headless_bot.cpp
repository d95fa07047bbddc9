#include "client/bots/headless_bot.hpp"

#include <utility>

namespace runstone {

HeadlessBot::HeadlessBot(BotConfig config, FleetStatistics& fleet, TimeUs (*clock)())
    : Bot(std::move(config)), crowd_(fleet), session_(config_.session, fleet, clock) {}

bool HeadlessBot::submit(const EditDescriptor& edit, TimeUs due_us, TimeUs now_us) {
  return session_.submit(edit, due_us, now_us).has_value();
}

BotCounts HeadlessBot::counts() const {
  BotCounts counts = counts_;
  const LightCounts& seen = session_.counts();
  counts.confirmed = seen.own_confirmed;
  counts.rejected = seen.own_rejected;
  counts.durable = seen.own_durable;
  counts.others = seen.edits - seen.own_confirmed;
  counts.own_us = seen.own_us;
  for (std::size_t i = 0; i < session_.local_edits().undecided(); ++i) counts.own_us.add_infinite();
  return counts;
}

}  // namespace runstone
