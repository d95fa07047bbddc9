// InspectionControl: the modes of inspection that frames show, and the layers that were meshed
// again a moment ago. It costs nothing while no mode is on. Pure: times are arguments. One thread.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>

#include "client/render/inspection.hpp"
#include "client/replica/replica.hpp"
#include "client/schedule/mesh_pool.hpp"
#include "common/core/ids.hpp"

namespace runstone {

class InspectionControl {
 public:
  /// The time in which layers that were meshed again fade.
  static constexpr TimeUs kFlashUs = 400'000;
  /// The ends of runs are shown up to this many chunks from the eye, along each axis.
  static constexpr std::int32_t kRunsRadius = 3;

  const InspectionModes& modes() const { return modes_; }
  void set(const InspectionModes& modes);
  void set(InspectionMode mode, bool is_on);

  /// Call it for each mesh that will be drawn.
  void meshed(const MeshResult& result, TimeUs now_us);
  /// Returns true if a later frame differs from one of now although nothing else changes.
  bool is_fading(TimeUs now_us) const;
  /// Returns what a frame shows that is seen from the chunk `eye`. With `exact`, layers do not
  /// fade: the picture shows those that were meshed in the last kFlashUs before the newest mesh.
  /// Cost: O(chunks in view) if runs or orders are shown.
  Inspection inspection(const Replica& replica, ChunkCoord eye, bool exact, TimeUs now_us) const;

 private:
  struct Flash {
    ChunkKey key;
    DirtyLayers layers;
    TimeUs at_us = 0;
  };
  void add_chunks(const Replica& replica, ChunkCoord eye, Inspection& to) const;
  void add_flashes(bool exact, TimeUs now_us, Inspection& to) const;

  InspectionModes modes_;
  std::deque<Flash> flashes_;  // the oldest one first
};

}  // namespace runstone
