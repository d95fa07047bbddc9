// paste_limits: how PasteSource must cut a build for the limits of a world.
#pragma once
#include <algorithm>

#include "common/builds/paste_source.hpp"
#include "protocol/rules/edit_check.hpp"

namespace runstone {

/// Returns the limits of the edits of a paste in a world.
inline PasteLimits paste_limits(const EditLimits& limits) {
  PasteLimits out;
  out.chunk_edge = limits.chunk_edge;
  out.volume_max = std::max<std::uint64_t>(limits.volume_max, 1);
  out.chunks_max = std::max<std::uint64_t>(limits.touched_chunks_max, 1);
  return out;
}

}  // namespace runstone
