// ViewOrder: in which order the chunks of a view come: what surrounds the viewer first, then what lies in the cone of
// sight, then the rest; each nearest first, ties by key. Pure.
#pragma once
#include <cstdint>

#include "common/core/coords.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

class ViewOrder {
 public:
  explicit ViewOrder(const View& view);
  /// Whether `a` comes before `b`. A strict weak order of chunk keys.
  bool operator()(const ChunkKey& a, const ChunkKey& b) const;

  /// Whoever turns round sees these at once: up to this squared distance, in chunks.
  static constexpr std::int64_t kNear2 = 4;

 private:
  enum class Ring { near, seen, rest };
  Ring ring(ChunkCoord at, std::int64_t distance2) const;

  View view_;
  double x_ = 0, y_ = 0, z_ = 0;  // the direction of sight, of length 1
  double cosine_ = -1;            // of half the cone's angle
};

}  // namespace runstone
