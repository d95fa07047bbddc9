// GroundBase: what all parts of the ground use: the rooms below, who sees what, and the sessions
// whose delivery goes on.
// Thread: the world strand.
#pragma once
#include <map>
#include <vector>

#include "server/interest/interest.hpp"
#include "server/world/ground/session_turns.hpp"
#include "server/world/ground/viewer.hpp"
#include "server/world/order/order.hpp"
#include "server/world/rights/quotas.hpp"
#include "server/world/rights/rights.hpp"

namespace runstone {

struct GroundBase {
  /// Returns the viewer of an open session, or null if there is none or the session is closed.
  Viewer* find(SessionId session) {
    const auto found = viewers.find(session);
    return found == viewers.end() || found->second.session.is_closed ? nullptr : &found->second;
  }
  /// Returns the viewers of the open sessions, ascending.
  std::vector<Viewer*> open() {
    std::vector<Viewer*> out;
    out.reserve(viewers.size());
    for (auto& [id, viewer] : viewers) {
      if (!viewer.session.is_closed) out.push_back(&viewer);
    }
    return out;
  }

  const WorldConfig& config;
  WorldEnvironment& environment;
  WorldCounters& counters;
  Sessions& sessions;
  Order& order;
  const Rights& rights;
  Quotas& quotas;
  Interest interest{CoordLimit::of(config.chunk_edge)};
  std::map<SessionId, Viewer> viewers{};
  SessionTurns deliveries{};  // sessions whose delivery goes on in a task of its own
};

}  // namespace runstone
