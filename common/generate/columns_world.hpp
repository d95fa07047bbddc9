// ColumnsWorld: a small world that is given as columns of runs. Everything outside of it is empty.
// It holds the voxels of the thesis' noise scenario (number 5), whose noise no generator of this
// project makes. The text, as in the thesis data, is a header line and then one line per column:
//   x,y,runs                  x, y: the thesis' horizontal axes, here x and z
//   -32,-32,3:41|0:44|-1:11   runs id:length upwards from the thesis' z = -32, here y; ids are
//                             one less than here
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "common/generate/column.hpp"
#include "common/generate/generator.hpp"

namespace runstone {

class ColumnsWorld final : public Generator {
 public:
  static constexpr std::int32_t kBottom = -32;  // y of every column's first voxel

  /// Reads the text. The columns must fill a rectangle and end at one height. Fails with bad_value,
  /// bad_version (another header), truncated or limit_exceeded (above 1024 columns a side or 4096
  /// voxels a column). The offset is the line.
  static Result<std::unique_ptr<ColumnsWorld>> parse(std::string_view csv);

  RunChunk generate(VoxelPos origin, Extent extent) const override;
  std::optional<RunChunk> coarse(VoxelPos origin, std::int32_t edge,
                                 std::uint8_t level) const override {
    return coarse_outside(bounds(), origin, edge, level);
  }
  std::int32_t y_min() const override { return kBottom; }
  std::int32_t y_max() const override { return y_max_; }
  std::int32_t surface_y(std::int32_t x, std::int32_t z) const override;

  /// Returns the box of the voxels in the text.
  VoxelBox bounds() const { return {{x_, kBottom, z_}, {x_ + width_, y_max_, z_ + depth_}}; }

 private:
  ColumnsWorld() = default;
  const Column* column(std::int32_t x, std::int32_t z) const;

  std::int32_t x_ = 0, z_ = 0, width_ = 0, depth_ = 0, y_max_ = kBottom;
  std::vector<Column> columns_;  // x + width * z
};

}  // namespace runstone
