// JoinRecorder: records how soon a joining client has meshed which share of its first view. Chunks
// that the server cannot send count as done, because no mesh will come of them. Pure. One thread.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// A part of the first view around its centre. Times are counted from the start of the connection
/// attempt.
struct JoinedPart {
  std::size_t chunks = 0, done = 0;
  std::optional<TimeUs> first_us, most_us, all_us;  // the first chunk; kJoinMost of them; all
};

inline constexpr double kJoinMost = 0.8;
inline constexpr std::uint8_t kJoinNearRadius = 3;  // chunks, horizontally and vertically

struct JoinReport {
  JoinedPart near, view;  // near: the part of the view within kJoinNearRadius
};

class JoinRecorder {
 public:
  /// Sets the first view of the world. Later calls change nothing.
  void begin(const View& view, TimeUs began_us);
  /// Returns true if the first view is known and not all of it is done.
  bool is_open() const { return view_ && report_.view.done != report_.view.chunks; }
  /// Records that the chunk has a mesh, or will never have one. Each chunk counts once. Cost: O(log
  /// chunks).
  void done(const ChunkKey& key, TimeUs at_us);
  const JoinReport& report() const { return report_; }

 private:
  std::optional<View> view_;
  View near_;
  TimeUs began_us_ = 0;
  std::set<ChunkCoord> seen_;  // cleared when all are done
  JoinReport report_;
};

}  // namespace runstone
