#include "server/world/people/reach.hpp"

#include "protocol/rules/edit_check.hpp"

namespace runstone {

bool is_within_reach(const WorldConfig& config, Session& session, const EditDescriptor& edit,
                     const Clocks& now) {
  if (config.reach_max == 0) return true;
  const WorldPos& from = session.position.advance(session.pose.at, config.speed_max, now.steady_us);
  return within_reach(edit, from, config.reach_max);
}

}  // namespace runstone
