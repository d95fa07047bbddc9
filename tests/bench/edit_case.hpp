// The edit case: a builder removes a voxel that shows, or puts one before it. Timed are the splice of the
// chunk's runs (apply_stack) and the remeshing of that chunk's dirty layers, next to a full mesh of it, which
// has to give the same quads. By the monotonic clock: each is too short for the one of the core.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/bench/voxel_world.hpp"

namespace runstone::bench {

struct EditTiming {
  std::size_t edits = 0;
  double apply_ns = 0, remesh_ns = 0, both_ns = 0, full_mesh_ns = 0;  // medians
};

/// Edits each volume that shows anything `per_volume` times, and takes every edit back, which is an edit as
/// well. Seeded.
EditTiming measure_edits(const std::vector<Volume>& volumes, const VisibilityTable& visibility,
                         unsigned per_volume, std::uint64_t seed);

}  // namespace runstone::bench
