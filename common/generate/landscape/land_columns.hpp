// LandColumns: the columns of a rectangle of a landscape: their ground, water, cover and plants,
// and the trees that stand in it or reach into it. Heights are voxels above the level of the sea.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/generate/landscape/caves.hpp"
#include "common/generate/landscape/land_form.hpp"
#include "common/generate/landscape/land_materials.hpp"
#include "common/generate/landscape/trees.hpp"

namespace runstone {

/// The shares of landscape that a world chooses, in percent.
struct LandChoices {
  std::int32_t trees = 100;
  std::int32_t plants = 100;
  bool has_caves = false;
};

/// How high a place lies and how steep it is, and what follows from that for its cover.
struct LandPlace {
  std::int32_t height;                   // voxels
  std::int32_t slope;                    // 256ths: voxels up for each voxel aside
  std::int32_t roughness, forest, cold;  // as in LandSample
  std::int32_t grain;                    // noise within -kOne .. kOne, or 0 from afar
};
enum class LandCover : std::uint8_t { grass, forest_floor, rock, scree, snow, beach };
LandCover cover_of(const LandPlace& place);
/// Returns the share of the squares of kTreeSpacing that have a tree, 0 .. kOne.
std::int32_t tree_share(const LandPlace& place, LandCover cover);
/// Returns the share of trees that are pines.
std::int32_t pine_share(const LandPlace& place);

struct LandColumn {
  std::int32_t ground;  // the first voxel above the ground
  std::int32_t water;   // the first voxel above the water; `ground` where it is dry
  Material top, filling;
  std::uint8_t filling_depth;  // voxels of filling below the topmost; stone below them
  Material plant;              // one voxel above the ground, or kEmpty
};

class LandColumns {
 public:
  /// A stretch of a tree in a column.
  struct Wood {
    std::uint32_t column;
    std::int32_t from, to;
    Material material;
  };
  /// A tunnel through a column. Its voxels are empty.
  struct Hollow {
    std::uint32_t column;
    Tunnel tunnel;
  };

  /// Makes the columns of x .. x + width and z .. z + depth. Thread: any. Cost: O(columns), about
  /// 0.1 us a column.
  LandColumns(const LandForm& form, const LandMaterials& materials, const LandChoices& choices,
              std::uint64_t seed, std::int32_t x, std::int32_t z, std::uint32_t width,
              std::uint32_t depth);

  /// Column x + width * z.
  const std::vector<LandColumn>& columns() const { return columns_; }
  /// Ascending by column; where two overlap, the later one counts.
  const std::vector<Wood>& wood() const { return wood_; }
  /// Ascending by column, then by height.
  const std::vector<Hollow>& hollows() const { return hollows_; }
  /// From high() up every voxel is empty. Below low() every voxel is stone.
  std::int32_t high() const { return high_; }
  std::int32_t low() const { return low_; }

 private:
  std::vector<LandColumn> columns_;
  std::vector<Wood> wood_;
  std::vector<Hollow> hollows_;
  std::int32_t high_ = 0, low_ = 0;
};

}  // namespace runstone
