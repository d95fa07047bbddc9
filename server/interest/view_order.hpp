// ViewOrder: the order in which the chunks of a view are sent: first the chunks around the viewer,
// then the chunks in the cone of sight, then the rest. Within each group the nearest chunk comes
// first; ties are ordered by key. It is pure.
#pragma once
#include <cstdint>

#include "common/core/coords.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

class ViewOrder {
 public:
  explicit ViewOrder(const View& view);
  /// Returns true if `a` comes before `b`. This is a strict weak order of chunk keys.
  bool operator()(const ChunkKey& a, const ChunkKey& b) const;

  /// The squared distance, in chunks, up to which chunks surround the viewer. A viewer who turns
  /// sees them at once.
  static constexpr std::int64_t kNear2 = 4;

 private:
  enum class Ring { near, seen, rest };
  Ring ring(ChunkCoord at, std::int64_t distance2) const;

  View view_;
  double x_ = 0, y_ = 0, z_ = 0;  // the direction of sight, of length 1
  double cosine_ = -1;            // of View::cone, the angle between the cone's axis and its side
};

}  // namespace runstone
