// Brush: a tool of a builder and its size. It makes edit descriptors at given places.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "common/core/ids.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone::bench {

enum class BrushKind : std::uint8_t { sphere, box, stroke, paste };

struct Brush {
  BrushKind kind = BrushKind::sphere;
  std::uint32_t size = 0;  // radius of a sphere; else a side of a box, or the length of a stroke
  std::string name() const;
};

/// Returns spheres of radius 0 to 12, boxes, strokes of radius 1, and a paste of a hollow house.
std::vector<Brush> brushes();

/// Returns the edit of a brush at a voxel of a chunk. A sphere of radius 0 sets one voxel.
EditDescriptor brush_edit(const Brush& brush, VoxelPos at, Material material);

}  // namespace runstone::bench
