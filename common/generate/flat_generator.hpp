// FlatGenerator: the same few layers everywhere, or no layer at all. Its worlds are for builders
// who want an empty place.
#pragma once
#include "common/generate/column.hpp"
#include "common/generate/generator.hpp"
#include "common/generate/generator_parameters.hpp"

namespace runstone {

class FlatGenerator final : public Generator {
 public:
  /// Fails with not_found if a parameter names no material of the table.
  static Result<std::unique_ptr<Generator>> make(const FlatParameters& parameters,
                                                 const MaterialTable& materials);
  /// Makes the generator "empty".
  static std::unique_ptr<Generator> make_empty();

  RunChunk generate(VoxelPos origin, Extent extent) const override;
  std::optional<RunChunk> coarse(VoxelPos origin, std::int32_t edge,
                                 std::uint8_t level) const override;
  std::int32_t y_min() const override { return y_min_; }
  std::int32_t y_max() const override { return y_max_; }
  std::int32_t surface_y(std::int32_t, std::int32_t) const override { return y_max_; }

 private:
  FlatGenerator() = default;
  std::int32_t y_min_ = 0, y_max_ = 0;
  Column column_;  // meaningful while y_min_ < y_max_
};

}  // namespace runstone
