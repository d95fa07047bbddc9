// TerrainGenerator: layered noise in the manner of the thesis (7.4, 7.5). Every material with a
// generation rule fills its columns up to its surface and, if it has a reversed surface, only above
// that one. Where rules overlap, the last in the table wins. Then beaches, rock and peaks change
// the cover, and the sea fills the empty voxels below its level.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "common/generate/column.hpp"
#include "common/generate/generator.hpp"
#include "common/generate/generator_parameters.hpp"
#include "common/generate/value_noise.hpp"

namespace runstone {

inline constexpr std::size_t kTerrainRuleCountMax = 64;

class TerrainGenerator final : public Generator {
 public:
  /// Fails with not_found if a parameter names no material of the table or the table has no
  /// generation rule, with limit_exceeded above kTerrainRuleCountMax rules, and with bad_value if
  /// y_min is above all terrain.
  static Result<std::unique_ptr<Generator>> make(std::uint64_t seed,
                                                 const TerrainParameters& parameters,
                                                 const MaterialTable& materials);

  RunChunk generate(VoxelPos origin, Extent extent) const override;
  std::optional<RunChunk> coarse(VoxelPos origin, std::int32_t edge,
                                 std::uint8_t level) const override;
  std::int32_t y_min() const override { return y_min_; }
  std::int32_t y_max() const override { return y_max_; }
  std::int32_t surface_y(std::int32_t x, std::int32_t z) const override;

 private:
  struct Surface {
    SurfaceRule rule;
    ValueNoise noise;
  };
  struct Layer {
    Material material;
    Surface surface;
    std::optional<Surface> reversed;
  };

  TerrainGenerator() = default;
  template <class Height>
  void paint_column(Column& column, Height&& height) const;
  /// Returns a plane of heights for each surface, in layer order. Its columns are those of
  /// ValueNoise::fill().
  std::vector<double> heights_of(std::int32_t x, std::int32_t z, std::uint32_t width,
                                 std::uint32_t depth, std::int32_t stride) const;

  std::vector<Layer> layers_;
  std::int32_t y_min_ = 0, y_max_ = 0;
  std::int32_t solid_below_ = 0;  // below it every voxel from y_min up is the last layer's material
  std::int32_t sea_level_ = 0;
  std::int32_t beach_below_ = 0;  // columns that end at or below it get the beach cover
  std::int32_t rock_level_ = 0, peak_level_ = 0;
  std::optional<Material> water_, beach_, rock_, peak_;
};

}  // namespace runstone
