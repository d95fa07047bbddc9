// JoinRecorder: how soon a client that comes to a world has a picture: when which share of its first view was meshed.
// Chunks that the server says it cannot send count as done: nothing more comes of them. Pure; one thread.
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

/// A part of the first view around its centre. Times are since the client began to connect.
struct JoinedPart {
  std::size_t chunks = 0, done = 0;
  std::optional<TimeUs> first_us, most_us, all_us;  // first chunk; kJoinMost of them; all
};

inline constexpr double kJoinMost = 0.8;
inline constexpr std::uint8_t kJoinNearRadius = 3;  // chunks, both ways

struct JoinReport {
  JoinedPart near, view;  // near: what of the view lies within kJoinNearRadius
};

class JoinRecorder {
 public:
  /// The first view of the world. Later ones change nothing.
  void begin(const View& view, TimeUs began_us);
  /// Whether the first view is known and not all of it is done.
  bool is_open() const { return view_ && report_.view.done != report_.view.chunks; }
  /// The chunk has a mesh, or will never have one. Each chunk counts once. O(log chunks).
  void done(const ChunkKey& key, TimeUs at_us);
  const JoinReport& report() const { return report_; }

 private:
  std::optional<View> view_;
  View near_;
  TimeUs began_us_ = 0;
  std::set<ChunkCoord> seen_;  // until all are done
  JoinReport report_;
};

}  // namespace runstone
