// Audiences: groups of sessions that get the same edits of a commit. One message serves a group, so
// bytes are shared wherever sessions see the same chunks.
#pragma once
#include <cstdint>
#include <vector>

#include "common/core/ids.hpp"

namespace runstone {

struct Audience {
  std::vector<SessionId> sessions;   // ascending
  std::vector<std::uint32_t> edits;  // indices in the commit, ascending
  friend bool operator==(const Audience&, const Audience&) = default;
};

/// Groups the receivers of a commit. `receivers[i]` are the sessions that edit i concerns,
/// ascending. Returns the groups ordered by their first session; an edit without receivers is in
/// none. Cost: O(edits + receivers) if every edit has the same receivers; otherwise O(distinct
/// lists of receivers * sessions) and the sum of the groups' edits.
std::vector<Audience> audiences_of(const std::vector<std::vector<SessionId>>& receivers);

}  // namespace runstone
