// Palette decode: the shortest way from runs to the input of binary greedy meshing. One pass over
// the runs writes a palette id of one byte a voxel into a padded grid of the runs' own order, and
// the words of the occupancy mask. There are two entries: a chunk with its neighbours, as the
// product has them, and a list of runs that was made for this mesher and contains the border.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/mesh/visibility.hpp"
#include "common/runs/run_chunk.hpp"
#include "tests/reference/dense_grid.hpp"
#include "tests/reference/occupancy_mask.hpp"

namespace runstone::reference {

using PaletteId = std::uint8_t;
using PaletteGrid = PaddedGrid<PaletteId>;

/// Numbers for the materials of one volume, in the order in which they occur.
class BytePalette {
 public:
  static constexpr std::size_t kIdsMax = 256;

  BytePalette() : of_(kMaterialCountMax, kUnseen) {}
  /// Removes all ids. Cost: O(ids).
  void clear();
  /// Returns the id of a material, which the first call assigns, or kIdsMax if all ids are taken.
  std::uint16_t id_of(Material material, const VisibilityTable& visibility) {
    const std::uint16_t id = of_[material];
    return id != kUnseen ? id : enter(material, visibility[material]);
  }
  /// Returns the id, or nullopt if the volume does not have the material.
  std::optional<PaletteId> known(Material material) const;

  /// Return all bits or none: whether a material is opaque, or transparent.
  std::uint64_t opaque(std::uint16_t id) const { return opaque_[id]; }
  std::uint64_t transparent(std::uint16_t id) const { return transparent_[id]; }
  /// Returns the materials by id.
  const std::vector<Material>& materials() const { return materials_; }

 private:
  static constexpr std::uint16_t kUnseen = 0xffff;
  std::uint16_t enter(Material material, Visibility visibility);

  std::vector<std::uint16_t> of_;  // by material
  std::vector<Material> materials_;
  std::array<std::uint64_t, kIdsMax> opaque_{}, transparent_{};
};

struct PaletteVolume {
  BytePalette palette;
  /// The border is written only where transparent voxels have to be compared.
  PaletteGrid grid;
  OccupancyMask mask;
  std::vector<Material> layer;  // scratch: one border layer
};

/// Replaces `out` by a chunk with the adjoining layers of its neighbours. Counts a dense expansion.
/// Returns false, with `out` unspecified, if the chunk has more than BytePalette::kIdsMax
/// materials. Requires sides of at most kBinarySideMax. Cost: O(runs + lines).
bool decode_palette(const RunChunk& chunk, const GridNeighbours& neighbours,
                    const VisibilityTable& visibility, PaletteVolume& out);

/// The runs of a chunk and of the one voxel around it, as a world would keep them that meshes by
/// binary greedy only. Run i has the voxels [ends[i - 1], ends[i]) of the padded volume in the
/// order of the chunk, and the material materials[ids[i]].
struct PaddedRuns {
  Extent extent;  // without the border
  AxisOrder order = AxisOrder::xyz;
  std::vector<std::uint32_t> ends;
  std::vector<PaletteId> ids;
  std::vector<Material> materials;
};
inline constexpr unsigned kPaddedSideMax = kBinarySideMax - 2;

/// Returns nullopt if there are more than BytePalette::kIdsMax materials. The twelve edges of the
/// border are like the voxel before them.
std::optional<PaddedRuns> padded_runs(const RunChunk& chunk, const GridNeighbours& neighbours);

/// Replaces `out`, the border of its grid included. Counts a dense expansion. Requires sides of at
/// most kPaddedSideMax. Cost: O(runs + lines).
void decode_palette(const PaddedRuns& runs, const VisibilityTable& visibility, PaletteVolume& out);

}  // namespace runstone::reference
