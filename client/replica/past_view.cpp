#include "client/replica/past_view.hpp"

#include <utility>

namespace runstone {

void PastView::show(const std::optional<PastMoment>& moment, ReplicaChunks& chunks) {
  const bool is_from_past = std::exchange(moment_, moment).has_value();
  const bool keeps_current = is_from_past && is_past();
  for (auto& [key, chunk] : chunks) {
    if (!keeps_current || !chunk.is_current()) chunks.expect(chunk);
    chunk.behind_of = {};
    chunk.cached.reset();
    if (!is_past()) continue;
    chunk.pending.clear();
    chunk.inbox.clear();
    chunk.repeatable.clear();
    chunk.latest = 0;
    chunks.recount(chunk);
  }
}

}  // namespace runstone
