// GroundHeight: the height of the world, for behaviours that build on it.
#pragma once
#include <cstdint>
#include <optional>

#include "client/replica/surface.hpp"

namespace runstone {

class GroundHeight {
 public:
  virtual ~GroundHeight() = default;
  /// Returns y of the highest voxel of the column that is not empty, or nullopt if it is unknown.
  virtual std::optional<std::int32_t> surface(std::int32_t x, std::int32_t z) const = 0;
};

/// The ground that a replica shows now.
class ReplicaGround final : public GroundHeight {
 public:
  explicit ReplicaGround(const Replica& replica) : replica_(replica) {}
  std::optional<std::int32_t> surface(std::int32_t x, std::int32_t z) const override {
    return surface_of(replica_, x, z);
  }

 private:
  const Replica& replica_;
};

}  // namespace runstone
