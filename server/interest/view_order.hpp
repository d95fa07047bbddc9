// ViewOrder: the order in which the chunks of a view are sent: first the chunks around the viewer,
// then the chunks in the cone of sight, then the rest. Within each group the nearest chunk comes
// first; ties are ordered by coordinates. It is pure.
#pragma once
#include <cstdint>

#include "common/core/coords.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

class ViewOrder {
 public:
  explicit ViewOrder(const View& view);

  /// The place of a chunk in the order: lower places come first. A place also identifies its chunk,
  /// so a queue of chunks needs nothing else, and comparing two chunks costs one comparison of
  /// integers.
  using Place = std::uint64_t;
  /// Requires a chunk of the view.
  Place place_of(ChunkCoord at) const;
  /// Returns the chunk whose place this is.
  ChunkCoord chunk_at(Place place) const;

  /// The squared distance, in chunks, up to which chunks surround the viewer. A viewer who turns
  /// sees them at once.
  static constexpr std::int64_t kNear2 = 4;

 private:
  enum class Ring : std::uint8_t { near, seen, rest };
  Ring ring(std::int64_t dx, std::int64_t dy, std::int64_t dz, std::int64_t distance2) const;

  ChunkCoord centre_;
  bool has_cone_ = false;
  double x_ = 0, y_ = 0, z_ = 0;  // the direction of sight, of length 1
  double cosine_ = -1;            // of View::cone, the angle between the cone's axis and its side
};

}  // namespace runstone
