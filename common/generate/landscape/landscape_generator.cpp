#include "common/generate/landscape/landscape_generator.hpp"

#include <algorithm>
#include <span>
#include <vector>

#include "common/runs/run_builder.hpp"

namespace runstone {
namespace {

constexpr std::size_t kRectanglesKept = 128;
constexpr std::size_t kFarKept = 64;
constexpr std::int32_t kCrownHeight = 6;   // of a forest from afar
constexpr std::int32_t kDeepest = 16;      // of a lake or river below the ground around it, at most
constexpr std::int32_t kForestFar = 1900;  // the share of trees from which far ground is a forest

/// Appends the voxels of a column from the lowest upwards. Cuts them to a range of heights, and
/// leaves its tunnels empty.
class ColumnWriter {
 public:
  using Hollows = std::span<const LandColumns::Hollow>;
  ColumnWriter(std::int32_t from, std::int32_t to, RunBuilder& out, Hollows hollows = {})
      : at_(from), to_(to), hollows_(hollows), out_(out) {}
  /// Appends up to height `end`.
  void until(std::int32_t end, Material material) {
    while (!hollows_.empty() && hollows_.front().tunnel.from < end) {
      const Tunnel tunnel = hollows_.front().tunnel;
      hollows_ = hollows_.subspan(1);
      append(tunnel.from, material);
      append(tunnel.to, kEmpty);
    }
    append(end, material);
  }
  void finish() { until(to_, kEmpty); }

 private:
  void append(std::int32_t end, Material material) {
    end = std::min(end, to_);
    if (end <= at_) return;
    out_.append(static_cast<std::uint32_t>(end - at_), material);
    at_ = end;
  }

  std::int32_t at_, to_;
  Hollows hollows_;
  RunBuilder& out_;
};

/// Removes the parts of column `column` from the front of parts that ascend by column.
template <class Part>
std::span<const Part> take_column(std::span<const Part>& parts, std::uint32_t column) {
  std::size_t count = 0;
  while (count < parts.size() && parts[count].column == column) ++count;
  const auto out = parts.first(count);
  parts = parts.subspan(count);
  return out;
}

/// Appends the trees of a column, from height `from` upwards: in each height the last one counts.
void write_wood(std::span<const LandColumns::Wood> wood, std::int32_t from,
                std::vector<std::int32_t>& heights, ColumnWriter& writer) {
  heights.clear();
  for (const LandColumns::Wood& part : wood) {
    heights.push_back(std::max(part.from, from));
    heights.push_back(std::max(part.to, from));
  }
  std::sort(heights.begin(), heights.end());
  std::int32_t begin = from;
  for (const std::int32_t end : heights) {
    Material material = kEmpty;
    for (const LandColumns::Wood& part : wood) {
      if (part.from <= begin && begin < part.to) material = part.material;
    }
    writer.until(end, material);
    begin = std::max(begin, end);
  }
}

/// A column of a tile.
struct FarColumn {
  std::int32_t top;  // the first empty voxel
  std::int32_t ground, water;
  Material cover, crown;  // crown: kEmpty where no forest is
};

}  // namespace

LandscapeGenerator::LandscapeGenerator(std::uint64_t seed, const LandscapeParameters& parameters,
                                       const LandMaterials& materials)
    : seed_(seed),
      sea_level_(parameters.sea_level),
      y_min_(parameters.y_min),
      choices_{parameters.trees, parameters.plants, parameters.caves != 0},
      materials_(materials),
      form_(seed),
      columns_(kRectanglesKept),
      far_places_(kFarKept) {}

Result<std::unique_ptr<Generator>> LandscapeGenerator::make(std::uint64_t seed,
                                                            const LandscapeParameters& parameters,
                                                            const MaterialTable& materials) {
  const auto found = LandMaterials::find(materials);
  if (!found) return failure(found.error());
  if (parameters.y_min > parameters.sea_level + kLandHeightMin) {
    return fail(ErrorCode::bad_value,
                "landscape parameter y_min must be at least 96 below sea_level");
  }
  return std::unique_ptr<Generator>(new LandscapeGenerator(seed, parameters, *found));
}

std::int32_t LandscapeGenerator::y_max() const {
  return sea_level_ + kLandHeightMax + kTreeHeightMax;
}

std::shared_ptr<const LandColumns> LandscapeGenerator::columns(std::int32_t x, std::int32_t z,
                                                               std::uint32_t width,
                                                               std::uint32_t depth) const {
  return columns_.get({x, z, width, depth}, [&] {
    return LandColumns(form_, materials_, choices_, seed_, x, z, width, depth);
  });
}

RunChunk LandscapeGenerator::generate(VoxelPos origin, Extent extent) const {
  const std::int32_t end = origin.y + extent.y;
  if (end <= y_min_ || origin.y >= y_max()) return uniform_chunk(extent, kEmpty);
  if (origin.y >= y_min_ && end <= sea_level_ + kLandHeightMin)
    return uniform_chunk(extent, materials_.stone);

  const auto land = columns(origin.x, origin.z, extent.x, extent.z);
  if (origin.y >= sea_level_ + land->high()) return uniform_chunk(extent, kEmpty);
  if (origin.y >= y_min_ && end <= sea_level_ + land->low())
    return uniform_chunk(extent, materials_.stone);

  RunBuilder out(extent, AxisOrder::yxz);
  std::vector<std::int32_t> heights;
  std::span<const LandColumns::Wood> wood = land->wood();
  ColumnWriter::Hollows hollows = land->hollows();
  const std::vector<LandColumn>& all = land->columns();
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    const LandColumn& column = all[i];
    const auto here = take_column(wood, i);
    ColumnWriter writer(origin.y - sea_level_, end - sea_level_, out, take_column(hollows, i));
    writer.until(y_min_ - sea_level_, kEmpty);
    writer.until(column.ground - 1 - column.filling_depth, materials_.stone);
    writer.until(column.ground - 1, column.filling);
    writer.until(column.ground, column.top);
    writer.until(column.water, materials_.water);
    std::int32_t from = column.water;
    const bool is_in_wood = std::any_of(here.begin(), here.end(), [&](const auto& part) {
      return part.from <= column.ground && column.ground < part.to;
    });
    if (column.plant != kEmpty && !is_in_wood) writer.until(from = column.ground + 1, column.plant);
    write_wood(here, from, heights, writer);
    writer.finish();
  }
  return out.finish();
}

std::optional<RunChunk> LandscapeGenerator::coarse(VoxelPos origin, std::int32_t edge,
                                                   std::uint8_t level) const {
  const Extent extent = Extent::cube(static_cast<unsigned>(edge));
  const std::int32_t end = origin.y + (edge << level);
  if (end <= y_min_ || origin.y >= y_max()) return uniform_chunk(extent, kEmpty);
  if (origin.y >= y_min_ && end <= sea_level_ + kLandHeightMin)
    return uniform_chunk(extent, materials_.stone);

  // The places are a lattice of the corners of the cells, as in terrain: the highest corner stands
  // for a cell, except that a river passes through it.
  const std::int32_t side = edge + 1, stride = 1 << level;
  const auto places = far_places_.get({origin.x, origin.z, edge, level}, [&] {
    FarPlaces out;
    out.reserve(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    for (std::int32_t k = 0; k < side; ++k) {
      for (std::int32_t i = 0; i < side; ++i)
        out.push_back(form_.at(origin.x + i * stride, origin.z + k * stride));
    }
    return out;
  });
  std::int32_t lowest = kLandHeightMax, highest = 0;  // 0: the sea
  for (const LandSample& at : *places) {
    lowest = std::min(lowest, at.height >> 8);
    highest = std::max({highest, (at.height >> 8) + 1, at.shore < 0 ? at.water : 0});
  }
  if (origin.y >= sea_level_ + highest + kCrownHeight) return uniform_chunk(extent, kEmpty);
  if (origin.y >= y_min_ && end <= sea_level_ + lowest - kDeepest - stride)
    return uniform_chunk(extent, materials_.stone);
  const auto place = [&](std::int32_t i, std::int32_t k) -> const LandSample& {
    return (*places)[static_cast<std::size_t>(i + side * k)];
  };
  const auto far_column = [&](std::int32_t i, std::int32_t k) {
    const LandSample& at = place(i, k);
    const std::int32_t beside_x = place(i < edge ? i + 1 : i - 1, k).height;
    const std::int32_t beside_z = place(i, k < edge ? k + 1 : k - 1).height;
    const std::int32_t slope_x = std::abs(at.height - beside_x) >> level;
    const std::int32_t slope_z = std::abs(at.height - beside_z) >> level;
    const LandPlace where{(at.height + 128) >> 8,
                          std::max(slope_x, slope_z) + std::min(slope_x, slope_z) / 2,
                          at.roughness,
                          at.forest,
                          at.cold,
                          0};
    const LandCover cover = cover_of(where);
    FarColumn out{0, where.height, where.height, kEmpty, kEmpty};
    switch (cover) {
      case LandCover::grass:
        out.cover = materials_.grass;
        break;
      case LandCover::forest_floor:
        out.cover = materials_.forest_floor;
        break;
      case LandCover::rock:
        out.cover = materials_.stone;
        break;
      case LandCover::scree:
        out.cover = materials_.gravel;
        break;
      case LandCover::snow:
        out.cover = materials_.snow;
        break;
      case LandCover::beach:
        out.cover = materials_.sand;
        break;
    }
    if (at.shore < 0 && at.water > 0) {
      out.water = at.water;
      out.ground = at.water - 2;
      out.cover = materials_.sand;
    } else if (out.ground < 0) {
      out.water = 0;
    } else if (choices_.trees >= 50 && tree_share(where, cover) > kForestFar) {
      out.crown = pine_share(where) > kOne / 2 ? materials_.pine_leaves : materials_.leaves;
    }
    out.top = std::max(out.ground, out.water) + (out.crown != kEmpty ? kCrownHeight : 0);
    return out;
  };
  std::vector<FarColumn> near_row, far_row;
  const auto fill_row = [&](std::int32_t k) {
    far_row.clear();
    for (std::int32_t i = 0; i < side; ++i) far_row.push_back(far_column(i, k));
  };
  RunBuilder out(extent, AxisOrder::yxz);
  fill_row(0);
  const std::int32_t from = origin.y - sea_level_;
  const auto row_of = [&](std::int32_t y) { return (y - from) >> level; };
  for (std::int32_t k = 0; k < edge; ++k) {
    near_row.swap(far_row);
    fill_row(k + 1);
    for (std::int32_t i = 0; i < edge; ++i) {
      const auto n = static_cast<std::size_t>(i);
      const FarColumn* best = &near_row[n];
      for (const FarColumn* corner : {&far_row[n], &near_row[n + 1], &far_row[n + 1]}) {
        const bool is_river = corner->water > std::max(corner->ground, 0);
        const bool has_river = best->water > std::max(best->ground, 0);
        if (is_river != has_river ? is_river : corner->top > best->top) best = corner;
      }
      ColumnWriter writer(0, edge, out);
      writer.until(row_of(y_min_ - sea_level_), kEmpty);
      const bool is_wet = best->water > best->ground;
      // The water has a row of its own, and the ground begins below it.
      std::int32_t ground = row_of(best->ground - 1) + 1;
      if (is_wet) ground = std::min(ground, row_of(best->water - 1));
      writer.until(ground - 1, materials_.stone);
      // From far away the crowns of a forest share the row of its ground.
      writer.until(ground, best->crown != kEmpty ? best->crown : best->cover);
      if (is_wet) writer.until(row_of(best->water - 1) + 1, materials_.water);
      if (best->crown != kEmpty) writer.until(row_of(best->top - 1) + 1, best->crown);
      writer.finish();
    }
  }
  return out.finish();
}

std::int32_t LandscapeGenerator::surface_y(std::int32_t x, std::int32_t z) const {
  return sea_level_ + LandColumns(form_, materials_, choices_, seed_, x, z, 1, 1).high();
}

}  // namespace runstone
