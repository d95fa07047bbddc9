// ScenarioWorld: a scenario as the thesis ran it: 3 x 3 x 3 chunks with the same model in each,
// from -edge to 2 edge on every axis. Everything outside is empty.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>

#include "common/core/ids.hpp"
#include "common/generate/generator.hpp"
#include "common/generate/generator_parameters.hpp"
#include "common/generate/scenarios/scenario_model.hpp"

namespace runstone {

/// Returns a model as one chunk of solid `material`, in order yzx, that of its columns. Cost:
/// O(edge^2 + runs); Waves and Random: O(edge^3).
RunChunk scenario_chunk(const ScenarioModel& model, Material material);

class ScenarioWorld final : public Generator {
 public:
  /// Fails as scenario_model() does, and with not_found if the table lacks the material.
  static Result<std::unique_ptr<Generator>> make(const ScenarioParameters& parameters,
                                                 const MaterialTable& materials);
  ScenarioWorld(const ScenarioModel& model, Material material)
      : model_(model), material_(material) {}

  /// Takes any place and extent, not only whole models. The order is yzx.
  RunChunk generate(VoxelPos origin, Extent extent) const override;
  std::optional<RunChunk> coarse(VoxelPos origin, std::int32_t edge,
                                 std::uint8_t level) const override {
    return coarse_outside(bounds(), origin, edge, level);
  }
  std::int32_t y_min() const override { return -edge(); }
  std::int32_t y_max() const override { return 2 * edge(); }
  std::int32_t surface_y(std::int32_t x, std::int32_t z) const override;

  VoxelBox bounds() const {
    return {{-edge(), -edge(), -edge()}, {2 * edge(), 2 * edge(), 2 * edge()}};
  }

 private:
  std::int32_t edge() const { return static_cast<std::int32_t>(model_.edge()); }
  ColumnBits column(std::int32_t x, std::int32_t z) const;

  ScenarioModel model_;
  Material material_;
};

}  // namespace runstone
