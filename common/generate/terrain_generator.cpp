#include "common/generate/terrain_generator.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/core/hash.hpp"

namespace runstone {
namespace {

constexpr std::int32_t kCoverDepth = 3;  // voxels of beach and rock

/// Returns the first integer not below `value`. The rounding functions of a maths library would
/// cost a call each.
std::int32_t ceiling(double value) {
  auto out = static_cast<std::int32_t>(value);
  out += static_cast<std::int32_t>(static_cast<double>(out) < value);
  return out;
}

Result<std::optional<Material>> named(const MaterialTable& materials, const std::string& name) {
  if (name.empty()) return std::optional<Material>{};
  const auto id = materials.find(name);
  if (!id) return fail(ErrorCode::not_found, "a terrain parameter names no material of the table");
  return id;
}

}  // namespace

Result<std::unique_ptr<Generator>> TerrainGenerator::make(std::uint64_t seed,
                                                          const TerrainParameters& parameters,
                                                          const MaterialTable& materials) {
  std::unique_ptr<TerrainGenerator> out(new TerrainGenerator);
  const auto water = named(materials, parameters.water);
  const auto beach = named(materials, parameters.beach);
  const auto rock = named(materials, parameters.rock);
  const auto peak = named(materials, parameters.peak);
  for (const auto* found : {&water, &beach, &rock, &peak}) {
    if (!*found) return failure(found->error());
  }
  out->water_ = *water;
  out->beach_ = *beach;
  out->rock_ = *rock;
  out->peak_ = *peak;
  out->y_min_ = parameters.y_min;
  out->sea_level_ = parameters.sea_level;
  out->beach_below_ = parameters.sea_level + parameters.beach_height;
  out->rock_level_ = parameters.rock_level;
  out->peak_level_ = parameters.peak_level;

  const auto surface = [seed](const SurfaceRule& rule) {
    const std::uint64_t key =
        mix64(seed) + static_cast<std::uint64_t>(static_cast<std::int64_t>(rule.seed));
    return Surface{rule, ValueNoise(mix64(key), rule.frequency)};
  };
  // Noise stays in [-1, 1] up to rounding; one voxel covers the rounding.
  std::int32_t y_max = out->water_ ? out->sea_level_ : kHeightMin;
  for (std::size_t id = 0; id < materials.size(); ++id) {
    const auto& rule = materials[static_cast<Material>(id)].generation;
    if (!rule) continue;
    if (out->layers_.size() == kTerrainRuleCountMax) {
      return fail(ErrorCode::limit_exceeded, "more than 64 materials have a generation rule");
    }
    Layer layer{static_cast<Material>(id), surface(rule->surface), std::nullopt};
    if (rule->reversed) layer.reversed = surface(*rule->reversed);
    const double reach = std::fabs(rule->surface.elevation);
    y_max = std::max(y_max, ceiling(rule->surface.distance + reach) + 1);
    // The last layer fills everything below its lowest surface, unless a cover or a reversed
    // surface replaces it.
    out->solid_below_ =
        rule->reversed ? kHeightMin : ceiling(rule->surface.distance - reach) - 1 - kCoverDepth;
    out->layers_.push_back(layer);
  }
  if (out->layers_.empty())
    return fail(ErrorCode::not_found, "no material of the table has a generation rule");
  if (out->y_min_ >= y_max)
    return fail(ErrorCode::bad_value, "terrain parameter y_min is above the terrain");
  out->y_max_ = y_max;
  return std::unique_ptr<Generator>(std::move(out));
}

/// `height(surface, index)` returns the surface's height in this column. `index` counts the
/// surfaces in layer order.
template <class Height>
void TerrainGenerator::paint_column(Column& column, Height&& height) const {
  column.reset(y_min_, y_max_);
  std::size_t index = 0;
  for (const Layer& layer : layers_) {
    // A voxel at y belongs to the layer if reversed < y < surface, both real numbers.
    const std::int32_t to = ceiling(height(layer.surface, index++));
    std::int32_t from = y_min_;
    if (layer.reversed) {
      const double low = height(*layer.reversed, index++);
      from = std::max(from, ceiling(low));
      if (static_cast<double>(from) <= low) ++from;
    }
    column.paint(from, to, layer.material);
  }
  const std::int32_t top = column.top();
  if (beach_ && top <= beach_below_) {
    column.paint(top - kCoverDepth, top, *beach_);
  } else {
    if (rock_ && top > rock_level_) column.paint(top - kCoverDepth, top, *rock_);
    if (peak_ && top > peak_level_) column.paint(top - 1, top, *peak_);
  }
  if (water_) column.flood(sea_level_, *water_);
}

std::vector<double> TerrainGenerator::heights_of(std::int32_t x, std::int32_t z,
                                                 std::uint32_t width, std::uint32_t depth,
                                                 std::int32_t stride) const {
  const std::size_t columns = std::size_t{width} * depth;
  std::vector<double> heights;
  heights.reserve(columns * layers_.size() * 2);
  for (const Layer& layer : layers_) {
    for (const Surface* surface : {&layer.surface, layer.reversed ? &*layer.reversed : nullptr}) {
      if (surface == nullptr) continue;
      const std::size_t at = heights.size();
      heights.resize(at + columns);
      const std::span<double> plane(heights.data() + at, columns);
      surface->noise.fill(x, z, width, depth, plane, stride);
      for (double& h : plane) h = surface->rule.distance + surface->rule.elevation * h;
    }
  }
  return heights;
}

RunChunk TerrainGenerator::generate(VoxelPos origin, Extent extent) const {
  const std::int32_t end = origin.y + extent.y;
  if (end <= y_min_ || origin.y >= y_max_) return uniform_chunk(extent, kEmpty);
  if (origin.y >= y_min_ && end <= solid_below_)
    return uniform_chunk(extent, layers_.back().material);

  const std::size_t columns = std::size_t{extent.x} * extent.z;
  const std::vector<double> heights = heights_of(origin.x, origin.z, extent.x, extent.z, 1);
  RunBuilder out(extent, AxisOrder::yxz);
  Column column;
  for (std::size_t i = 0; i < columns; ++i) {
    paint_column(column,
                 [&](const Surface&, std::size_t plane) { return heights[plane * columns + i]; });
    column.emit(origin.y, extent.y, out);
  }
  return out.finish();
}

std::optional<RunChunk> TerrainGenerator::coarse(VoxelPos origin, std::int32_t edge,
                                                 std::uint8_t level) const {
  const Extent extent = Extent::cube(static_cast<unsigned>(edge));
  const std::int32_t end = origin.y + (edge << level);
  if (end <= y_min_ || origin.y >= y_max_) return uniform_chunk(extent, kEmpty);
  if (origin.y >= y_min_ && end <= solid_below_)
    return uniform_chunk(extent, layers_.back().material);

  // A voxel of a tile is solid if any voxel below it is. So of the columns at the four corners of
  // its cell, the highest one stands for the cell. The sampled columns are a lattice of these
  // corners, one more than the cells a side.
  const auto side = static_cast<std::uint32_t>(edge) + 1;
  const std::vector<double> heights = heights_of(origin.x, origin.z, side, side, 1 << level);
  const std::size_t plane_size = std::size_t{side} * side;
  struct Sample {
    Column column;
    std::int32_t top = 0;
  };
  std::vector<Sample> near_row(side), far_row(side);
  const auto sample_row = [&](std::vector<Sample>& row, std::uint32_t z) {
    for (std::uint32_t x = 0; x < side; ++x) {
      const std::size_t at = x + std::size_t{side} * z;
      paint_column(row[x].column, [&](const Surface&, std::size_t plane) {
        return heights[plane * plane_size + at];
      });
      row[x].top = row[x].column.top();
    }
  };
  RunBuilder out(extent, AxisOrder::yxz);
  sample_row(far_row, 0);
  for (std::uint32_t z = 0; z + 1 < side; ++z) {
    near_row.swap(far_row);
    sample_row(far_row, z + 1);
    for (std::uint32_t x = 0; x + 1 < side; ++x) {
      const Sample* highest = &near_row[x];
      for (const Sample* corner : {&far_row[x], &near_row[x + 1], &far_row[x + 1]}) {
        if (corner->top > highest->top) highest = corner;
      }
      highest->column.emit_coarse(origin.y, extent.y, level, water_.value_or(kEmpty), out);
    }
  }
  return out.finish();
}

std::int32_t TerrainGenerator::surface_y(std::int32_t x, std::int32_t z) const {
  Column column;
  paint_column(column, [&](const Surface& surface, std::size_t) {
    return surface.rule.distance + surface.rule.elevation * surface.noise.at(x, z);
  });
  return column.top();
}

}  // namespace runstone
