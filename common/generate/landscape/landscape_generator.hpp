// LandscapeGenerator: continents, valleys with rivers and lakes, ranges of mountains, forests and
// meadows (docs/worlds.md). It computes in integers, and makes each chunk from its own columns.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "common/generate/generator.hpp"
#include "common/generate/generator_parameters.hpp"
#include "common/generate/landscape/land_columns.hpp"
#include "common/generate/landscape/land_form.hpp"
#include "common/generate/landscape/land_materials.hpp"
#include "common/generate/landscape/recent.hpp"
#include "common/generate/landscape/square_key.hpp"

namespace runstone {

class LandscapeGenerator final : public Generator {
 public:
  /// Fails with not_found if the table lacks a material of a landscape, and with bad_value if y_min
  /// is above the deepest ground.
  static Result<std::unique_ptr<Generator>> make(std::uint64_t seed,
                                                 const LandscapeParameters& parameters,
                                                 const MaterialTable& materials);

  RunChunk generate(VoxelPos origin, Extent extent) const override;
  std::optional<RunChunk> coarse(VoxelPos origin, std::int32_t edge,
                                 std::uint8_t level) const override;
  std::int32_t y_min() const override { return y_min_; }
  std::int32_t y_max() const override;
  std::int32_t surface_y(std::int32_t x, std::int32_t z) const override;
  std::optional<VoxelPos> spawn() const override;

 private:
  LandscapeGenerator(std::uint64_t seed, const LandscapeParameters& parameters,
                     const LandMaterials& materials);

  struct RectangleKey {
    std::int32_t x = 0, z = 0;
    std::uint32_t width = 0, depth = 0;
    friend bool operator==(const RectangleKey&, const RectangleKey&) = default;
    friend std::uint64_t hash_of(const RectangleKey& key) {
      return hash_of(SquareKey{key.x, key.z}) ^ (key.width | (std::uint64_t{key.depth} << 32));
    }
  };
  /// The corners of the cells of a tile, side by side along x.
  using FarPlaces = std::vector<LandSample>;
  struct TileKey {
    std::int32_t x = 0, z = 0, edge = 0;
    std::uint8_t level = 0;
    friend bool operator==(const TileKey&, const TileKey&) = default;
    friend std::uint64_t hash_of(const TileKey& key) {
      return hash_of(SquareKey{key.x, key.z}) ^ (static_cast<std::uint32_t>(key.edge) << 8) ^
             key.level;
    }
  };
  std::shared_ptr<const LandColumns> columns(std::int32_t x, std::int32_t z, std::uint32_t width,
                                             std::uint32_t depth) const;

  std::uint64_t seed_;
  std::int32_t sea_level_, y_min_;
  LandChoices choices_;
  LandMaterials materials_;
  LandForm form_;
  // Chunks above each other have the same columns.
  mutable Recent<RectangleKey, LandColumns> columns_;
  mutable Recent<TileKey, FarPlaces> far_places_;
};

}  // namespace runstone
