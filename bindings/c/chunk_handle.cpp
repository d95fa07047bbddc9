#include "bindings/c/chunk_handle.hpp"

#include <atomic>

using namespace runstone;
using namespace runstone::c_interface;

namespace {

/// A mesh that is older than this many edits of its chunk is made anew.
constexpr std::size_t kPastChanges = 8;

}  // namespace

std::optional<DirtyLayers> runstone_chunk::changes_since(std::uint64_t before) const {
  DirtyLayers layers;
  if (before == revision) return layers;
  for (std::size_t i = past.size(); i-- > 0;) {
    layers |= past[i].layers;
    if (past[i].before == before) return layers;
  }
  return std::nullopt;
}

void runstone_chunk::note_change(const DirtyLayers& layers) {
  if (past.size() == kPastChanges) past.erase(past.begin());
  past.push_back({revision, layers});
  revision = new_revision();
}

void runstone_chunk::forget_past() {
  past.clear();
  revision = new_revision();
}

namespace runstone::c_interface {

std::uint64_t new_revision() {
  static std::atomic<std::uint64_t> last{0};
  return last.fetch_add(1, std::memory_order_relaxed) + 1;
}

ChunkCoord place_of(runstone_pos at, std::int32_t edge) {
  const std::int32_t limit = kWorldLimit / edge;
  for (const std::int32_t along : {at.x, at.y, at.z}) {
    if (along < -limit || along >= limit)
      refuse(RUNSTONE_BAD_ARGUMENT, "at", "is a chunk outside the world");
  }
  return {at.x, at.y, at.z};
}

}  // namespace runstone::c_interface
