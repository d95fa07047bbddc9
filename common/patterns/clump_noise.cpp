#include "common/patterns/clump_noise.hpp"

namespace runstone {
namespace {

/// The parts of a voxel in which places of points are measured.
constexpr std::int64_t kPointUnit = 512;

}  // namespace

std::uint32_t ClumpNoise::at(VoxelPos voxel) {
  if (size_ == 1) return static_cast<std::uint32_t>(voxel_hash(key_, voxel) >> 32);
  // The two cells along an axis are those whose middles are nearest.
  const auto lower_cell = [&](std::int32_t v) { return floor_div(2 * v + 1 - size_, 2 * size_); };
  const VoxelPos cell{lower_cell(voxel.x), lower_cell(voxel.y), lower_cell(voxel.z)};
  if (cell_ != cell) read_points(cell);
  const std::int64_t x = voxel.x * kPointUnit + kPointUnit / 2,
                     y = voxel.y * kPointUnit + kPointUnit / 2,
                     z = voxel.z * kPointUnit + kPointUnit / 2;
  std::uint32_t nearest = 0;
  std::int64_t least = INT64_MAX;
  for (const Point& point : points_) {
    const std::int64_t dx = point.x - x, dy = point.y - y, dz = point.z - z;
    const std::int64_t square = dx * dx + dy * dy + dz * dz;
    if (square >= least) continue;
    least = square;
    nearest = point.number;
  }
  return nearest;
}

void ClumpNoise::read_points(VoxelPos cell) {
  cell_ = cell;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const auto bit = [&](unsigned axis) { return static_cast<std::int32_t>((i >> axis) & 1U); };
    const VoxelPos at{cell.x + bit(0), cell.y + bit(1), cell.z + bit(2)};
    const std::uint64_t hash = voxel_hash(key_, at);
    // A byte of the hash chooses one of 256 places in the middle half of the cell.
    const auto place = [&](std::int32_t of, unsigned shift) {
      const auto byte = static_cast<std::int64_t>((hash >> shift) & 0xFF);
      return (std::int64_t{of} * kPointUnit + kPointUnit / 4 + byte) * size_;
    };
    points_[i] = {place(at.x, 0), place(at.y, 8), place(at.z, 16),
                  static_cast<std::uint32_t>(hash >> 32)};
  }
}

}  // namespace runstone
