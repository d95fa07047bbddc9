// BoundMix: a mix with the materials of a world. It says which material each voxel gets. The answer
// depends on the place, the seed and the middle alone, so the same mix at the same place changes
// nothing the second time. One thread.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/materials/material_table.hpp"
#include "common/patterns/clump_noise.hpp"
#include "common/patterns/pattern.hpp"

namespace runstone {

/// The facts besides the text on which a pattern depends.
struct PatternFrame {
  std::uint64_t seed = 1;
  /// Twice the place from which `distance` is measured, so that it may lie between two voxels.
  VoxelPos middle2;
};

/// Returns the middle of a box, as PatternFrame has it.
inline VoxelPos middle2_of(const VoxelBox& box) {
  return {box.min.x + box.max.x - 1, box.min.y + box.max.y - 1, box.min.z + box.max.z - 1};
}

class BoundMix {
 public:
  /// Finds the materials by find_material(). Fails for one that the world lacks.
  static Result<BoundMix, PatternError> of(const Mix& mix, const MaterialTable& table,
                                           const PatternFrame& frame);
  /// Returns a mix of one material.
  static BoundMix of(Material material);

  /// Returns the material if all voxels get the same one.
  std::optional<Material> single() const;
  /// Returns the material of a voxel. Cost: O(depth * log parts).
  Material at(VoxelPos voxel);
  /// Sets `out` to the materials of the voxels from `low` upwards. Cost: that of at() for each voxel,
  /// or O(parts) for each voxel if the mix is a short list of materials.
  void read_column(VoxelPos low, std::span<Material> out);

 private:
  /// A part of a node: a material, or another node.
  struct Choice {
    std::uint64_t end = 0;  // the sum of the weights up to this part
    Material material = kEmpty;
    std::optional<std::size_t> node;
  };
  struct Node {
    MixKind kind = MixKind::list;
    std::int32_t low = 0, high = 0;
    std::uint64_t key = 0;
    ClumpNoise clumps{0, 1};
    std::vector<Choice> choices;
  };
  std::optional<PatternError> add(const Mix& mix, const MaterialTable& table, Choice& out);
  std::size_t choice_at(Node& node, VoxelPos voxel) const;
  /// Returns the number of parts of the whole if it is a list of few materials, otherwise 0.
  std::size_t short_list() const;

  PatternFrame frame_;
  Choice root_;
  std::vector<Node> nodes_;
};

}  // namespace runstone
