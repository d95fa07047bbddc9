#include "common/generate/landscape/land_columns.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "common/core/coords.hpp"
#include "common/core/hash.hpp"
#include "common/core/integer_root.hpp"

namespace runstone {
namespace {

constexpr std::int32_t kShoreWidth = 40 * 16;  // within it columns measure their way to the water
constexpr std::int32_t kDry = std::numeric_limits<std::int32_t>::min() / 2;

std::int32_t floor_to(std::int32_t value, std::int32_t step) {
  return floor_div(value, step) * step;
}

/// The nearest river or lake of a column.
struct Shore {
  std::int32_t away = std::numeric_limits<std::int32_t>::max();  // sixteenths; below 0: inside
  std::int32_t level = 0, half_width = 0;
  bool is_lake = false;
};

/// A column before plants: with the numbers that decide about its plants and trees.
struct GroundColumn {
  std::int32_t ground, water;  // water: kDry where there is none
  std::int32_t surface;        // of the lattice: the ground without its grain
  std::int32_t shore;          // sixteenths of a voxel to a river or lake
  LandPlace place;
  std::int32_t patch;  // noise of a wide grain, for patches of plants
  bool is_sill;        // a step of a river, which holds the water above it
};

class Ground {
 public:
  /// Covers the columns of the rectangle.
  Ground(const LandForm& form, std::uint64_t seed, std::int32_t x, std::int32_t z,
         std::uint32_t width, std::uint32_t depth)
      : form_(form),
        fine_5_(mix64(seed + 21), 5),
        fine_4_(mix64(seed + 22), 4),
        x_(floor_to(x, kLandStep) - kLandStep),
        z_(floor_to(z, kLandStep) - kLandStep),
        side_x_((x + static_cast<std::int32_t>(width) - x_ + kLandStep - 1) / kLandStep + 2),
        side_z_((z + static_cast<std::int32_t>(depth) - z_ + kLandStep - 1) / kLandStep + 2),
        places_(static_cast<std::size_t>(side_x_) * static_cast<std::size_t>(side_z_)) {
    for (std::int32_t k = 0; k < side_z_;) {
      const std::int32_t patch_z = floor_to(z_ + k * kLandStep, kPatchWidth);
      const std::int32_t end_k = std::min(side_z_, (patch_z + kPatchWidth - z_) / kLandStep);
      for (std::int32_t i = 0; i < side_x_;) {
        const std::int32_t patch_x = floor_to(x_ + i * kLandStep, kPatchWidth);
        const std::int32_t end_i = std::min(side_x_, (patch_x + kPatchWidth - x_) / kLandStep);
        copy(*form_.patch(patch_x / kPatchWidth, patch_z / kPatchWidth), patch_x, patch_z, i, end_i,
             k, end_k);
        i = end_i;
      }
      k = end_k;
    }
  }

  /// The columns of a square of the lattice, which share the work for their corners.
  class Block {
   public:
    Block(const Ground& ground, std::int32_t x, std::int32_t z)
        : ground_(ground),
          x_(floor_to(x, kLandStep)),
          z_(floor_to(z, kLandStep)),
          fine_5_(ground.fine_5_.cell_of(x_, z_)),
          fine_4_(ground.fine_4_.cell_of(x_, z_)) {
      const std::int32_t i = (x_ - ground.x_) / kLandStep, k = (z_ - ground.z_) / kLandStep;
      std::int32_t shore = std::numeric_limits<std::int32_t>::max();
      for (std::int32_t corner = 0; corner < 4; ++corner) {
        const std::int32_t ci = i + (corner & 1), ck = k + (corner >> 1);
        const auto c = static_cast<std::size_t>(corner);
        corners_[c] = &ground.place(ci, ck);
        slope_x_[c] = (ground.place(ci + 1, ck).height - ground.place(ci - 1, ck).height) / 16;
        slope_z_[c] = (ground.place(ci, ck + 1).height - ground.place(ci, ck - 1).height) / 16;
        shore = std::min(shore, corners_[c]->shore);
      }
      is_near_water_ = shore < kShoreWidth;
      if (is_near_water_) find_water();
    }

    bool contains(std::int32_t x, std::int32_t z) const {
      return x >= x_ && z >= z_ && x < x_ + kLandStep && z < z_ + kLandStep;
    }

    /// Requires contains(x, z).
    GroundColumn column(std::int32_t x, std::int32_t z) const {
      const std::int32_t tx = x - x_, tz = z - z_;
      const auto blend = [&](auto&& value) {
        return ((value(0) * (8 - tx) + value(1) * tx) * (8 - tz) +
                (value(2) * (8 - tx) + value(3) * tx) * tz) >>
               6;
      };
      const auto field = [&](std::int32_t LandSample::* what) {
        return blend([&](std::size_t corner) { return corners_[corner]->*what; });
      };
      GroundColumn out;
      const std::int32_t wide = ground_.fine_5_.in(fine_5_, x, z);
      const std::int32_t fine = ground_.fine_4_.in(fine_4_, x, z);
      out.patch = wide;
      out.place.grain = (wide + fine) / 2;
      out.place.roughness = field(&LandSample::roughness);
      out.place.forest = field(&LandSample::forest);
      out.place.cold = field(&LandSample::cold);
      const std::int32_t slope_x =
          std::abs(blend([&](std::size_t corner) { return slope_x_[corner]; }));
      const std::int32_t slope_z =
          std::abs(blend([&](std::size_t corner) { return slope_z_[corner]; }));
      out.place.slope = std::max(slope_x, slope_z) + std::min(slope_x, slope_z) / 2;
      Shore shore;
      if (is_near_water_)
        measure_shore(x, z, field(&LandSample::warp_x), field(&LandSample::warp_z), shore);
      out.shore = shore.away;
      const std::int32_t off_water = ramp(out.shore >> 4, 2, 34);
      const std::int32_t swing = 200 + times(out.place.roughness, 620);  // 256ths
      std::int32_t height = field(&LandSample::height);
      height += times(times(swing, off_water), wide + fine / 2);
      out.ground = (height + 128) >> 8;
      out.surface = field(&LandSample::height) >> 8;
      out.water = kDry;
      out.is_sill = false;
      if (shore.away < 0 && shore.level > 0) {
        const std::int32_t deepest = shore.is_lake ? 14 : 2 + shore.half_width / 48;
        const std::int32_t inside = -shore.away / (shore.is_lake ? 64 : 24);
        out.ground = shore.level - 1 - std::min(deepest, inside);
        out.water = shore.level;
      } else if (shore.away < 48 && shore.level > 0) {
        out.ground = std::max(out.ground, shore.level);
      }
      if (out.ground < 0 && out.water == kDry) out.water = 0;
      out.place.height = out.ground;
      return out;
    }

   private:
    /// Collects the rivers and lakes near the block. Distances of the lattice alone would cut
    /// narrow rivers into pieces.
    void find_water() {
      const auto middle = [&](std::int32_t LandSample::* what) {
        return (corners_[0]->*what + corners_[3]->*what) / 2;
      };
      const LandForm::DrainagePlace place =
          LandForm::drainage_place(x_ + kLandStep / 2, z_ + kLandStep / 2,
                                   middle(&LandSample::warp_x), middle(&LandSample::warp_z));
      square_x_ = place.square_x;
      square_z_ = place.square_z;
      for (const Watercourse& course : *ground_.form_.drainage().square(square_x_, square_z_)) {
        if (!course.is_wet) continue;
        const WatercoursePoint point = nearest_point(course, place.x, place.z);
        const std::int64_t most = 2 * kShoreWidth + point.half_width;
        if (point.distance_squared < most * most) water_.push_back(course);
      }
    }

    /// Measures the way from a column to the nearest river or lake.
    void measure_shore(std::int32_t x, std::int32_t z, std::int32_t warp_x, std::int32_t warp_z,
                       Shore& out) const {
      LandForm::DrainagePlace place = LandForm::drainage_place(x, z, warp_x, warp_z);
      place.x += (place.square_x - square_x_) * kDrainageWidth * 16;
      place.z += (place.square_z - square_z_) * kDrainageWidth * 16;
      for (const Watercourse& course : water_) {
        const WatercoursePoint point = nearest_point(course, place.x, place.z);
        const std::int64_t most =
            std::int64_t{std::min(out.away, kShoreWidth * 2)} + point.half_width;
        if (most <= 0 || point.distance_squared >= most * most) continue;
        out = {static_cast<std::int32_t>(integer_root(point.distance_squared)) - point.half_width,
               point.level >> 8, point.half_width, course.is_lake};
      }
    }

    const Ground& ground_;
    std::int32_t x_, z_;
    LatticeNoise::Cell fine_5_, fine_4_;
    std::array<const LandSample*, 4> corners_;
    std::array<std::int32_t, 4> slope_x_, slope_z_;
    bool is_near_water_;
    std::vector<Watercourse> water_;  // relative to the square below
    std::int32_t square_x_ = 0, square_z_ = 0;
  };

 private:
  const LandSample& place(std::int32_t i, std::int32_t k) const {
    return places_[static_cast<std::size_t>(i + side_x_ * k)];
  }
  void copy(const LandForm::Patch& patch, std::int32_t patch_x, std::int32_t patch_z,
            std::int32_t from_i, std::int32_t end_i, std::int32_t from_k, std::int32_t end_k) {
    for (std::int32_t k = from_k; k < end_k; ++k) {
      for (std::int32_t i = from_i; i < end_i; ++i) {
        const std::int32_t pi = (x_ + i * kLandStep - patch_x) / kLandStep;
        const std::int32_t pk = (z_ + k * kLandStep - patch_z) / kLandStep;
        places_[static_cast<std::size_t>(i + side_x_ * k)] =
            patch.places[static_cast<std::size_t>(pi) +
                         LandForm::kPatchSide * static_cast<std::size_t>(pk)];
      }
    }
  }

  const LandForm& form_;
  LatticeNoise fine_5_, fine_4_;
  std::int32_t x_, z_;  // the first place of the lattice
  std::int32_t side_x_, side_z_;
  std::vector<LandSample> places_;
};

/// Tunnels keep away from water, so that none of it stands beside an empty voxel.
bool may_have_tunnels(const GroundColumn& at) {
  return at.ground >= 8 && at.shore >= 24 * 16 && at.water == kDry;
}

struct Cover {
  Material top, filling;
  std::uint8_t depth;
};

Cover materials_of(LandCover cover, const GroundColumn& at, const LandMaterials& m) {
  switch (cover) {
    case LandCover::grass:
      return {m.grass, m.dirt, 3};
    case LandCover::forest_floor:
      return {m.forest_floor, m.dirt, 3};
    case LandCover::rock:
      return {m.stone, m.stone, 0};
    case LandCover::scree:
      return {m.gravel, m.stone, 0};
    case LandCover::snow:
      return {m.snow, m.snow, static_cast<std::uint8_t>(at.place.slope < 160 ? 1 : 0)};
    case LandCover::beach:
      break;
  }
  return {m.sand, m.sand, 3};
}

/// The floor below water, and the rim of rivers and lakes.
Cover bed_of(const GroundColumn& at, const LandMaterials& m) {
  if (at.place.slope > 250) return {m.stone, m.stone, 0};
  const bool is_deep = at.water - at.ground > 14;
  if (is_deep ? at.patch > 300 : at.patch > 1500) return {m.gravel, m.gravel, 1};
  if (!is_deep && at.patch < -1700) return {m.clay, m.clay, 1};
  return {m.sand, m.sand, 2};
}

Material plant_of(const GroundColumn& at, LandCover cover, std::uint64_t random, std::int32_t share,
                  const LandMaterials& m) {
  const auto dice = static_cast<std::int32_t>(random & (kOne - 1)) * 100;
  const auto second = static_cast<std::int32_t>((random >> 12) & (kOne - 1));
  if (at.shore >= 0 && at.shore < 28 && cover != LandCover::rock)
    return dice < 1300 * share ? m.reeds : kEmpty;
  if (at.place.slope > 210) return kEmpty;
  if (cover == LandCover::forest_floor) {
    if (dice < 260 * share) return second < 3000 ? m.fern : m.tall_grass;
    return kEmpty;
  }
  if (cover != LandCover::grass) return kEmpty;
  // Grass grows in patches, and flowers in other ones, where one kind is the most frequent.
  const std::int32_t meadow = 90 + ramp(at.patch, -400, 2000) / 6;
  if (dice < meadow * share) return m.tall_grass;
  if (dice > (kOne - 10) * 100 && at.patch < 0 && share > 0) return m.bush;
  if (at.patch < -600 && dice < (meadow + ramp(-at.patch, 600, 1900) / 14) * share) {
    const std::int32_t kind = at.place.cold > 6 ? 0 : at.place.cold < -6 ? 1 : 2;
    const std::int32_t chosen = second < 3000 ? kind : second % 3;
    return chosen == 0 ? m.cornflower : chosen == 1 ? m.poppy : m.dandelion;
  }
  return kEmpty;
}

}  // namespace

LandColumns::LandColumns(const LandForm& form, const LandMaterials& materials,
                         const LandChoices& choices, std::uint64_t seed, std::int32_t x,
                         std::int32_t z, std::uint32_t width, std::uint32_t depth) {
  const Caves caves(seed);
  const std::uint64_t tree_key = mix64(seed + 31), plant_key = mix64(seed + 32);
  const auto w = static_cast<std::int32_t>(width), d = static_cast<std::int32_t>(depth);
  const Ground ground(form, seed, x - kTreeReach, z - kTreeReach, width + 2 * kTreeReach,
                      depth + 2 * kTreeReach);
  // One column more on each side, because a column of water depends on its neighbours.
  const std::int32_t side = w + 2;
  std::vector<GroundColumn> raw(static_cast<std::size_t>(side) * static_cast<std::size_t>(d + 2));
  const auto raw_at = [&](std::int32_t i, std::int32_t k) -> GroundColumn& {
    return raw[static_cast<std::size_t>(i + 1 + side * (k + 1))];
  };
  for (std::int32_t block_z = floor_to(z - 1, kLandStep); block_z <= z + d; block_z += kLandStep) {
    for (std::int32_t block_x = floor_to(x - 1, kLandStep); block_x <= x + w;
         block_x += kLandStep) {
      Ground::Block block(ground, block_x, block_z);
      for (std::int32_t k = std::max(block_z, z - 1); k < std::min(block_z + kLandStep, z + d + 1);
           ++k) {
        for (std::int32_t i = std::max(block_x, x - 1);
             i < std::min(block_x + kLandStep, x + w + 1); ++i)
          raw_at(i - x, k - z) = block.column(i, k);
      }
    }
  }

  high_ = std::numeric_limits<std::int32_t>::min();
  low_ = std::numeric_limits<std::int32_t>::max();
  columns_.reserve(std::size_t{width} * depth);
  for (std::int32_t k = 0; k < d; ++k) {
    for (std::int32_t i = 0; i < w; ++i) {
      GroundColumn at = raw_at(i, k);
      // Water that would stand beside a lower surface is a sill of stones instead. So rivers fall
      // from step to step, and no side of water is open.
      if (at.water > 0) {
        for (const auto& [di, dk] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
          const GroundColumn& beside = raw_at(i + di, k + dk);
          at.is_sill = at.is_sill || std::max(beside.ground, beside.water) < at.water;
        }
        if (at.is_sill) {
          at.ground = at.water;
          at.water = kDry;
        }
      }
      const bool is_wet = at.water > at.ground;
      const LandCover land_cover = cover_of(at.place);
      Cover cover = materials_of(land_cover, at, materials);
      if (at.is_sill) {
        cover = {materials.stone, materials.stone, 0};
      } else if (is_wet || (at.shore < 20 && at.patch < 900 && land_cover != LandCover::snow)) {
        cover = bed_of(at, materials);
      }
      LandColumn out{
          at.ground, is_wet ? at.water : at.ground, cover.top, cover.filling, cover.depth, kEmpty};
      if (!is_wet && !at.is_sill && choices.plants > 0) {
        out.plant = plant_of(at, land_cover, place_hash(plant_key, x + i, z + k), choices.plants,
                             materials);
        if (out.plant != kEmpty && out.plant != materials.reeds && cover.top != materials.grass &&
            cover.top != materials.forest_floor)
          out.plant = kEmpty;
      }
      low_ = std::min(low_, out.ground - 1 - out.filling_depth);
      std::int32_t high = out.water + (out.plant != kEmpty ? 1 : 0);
      if (choices.has_caves && may_have_tunnels(at)) {
        for (Tunnel tunnel : caves.at(x + i, z + k, at.surface)) {
          tunnel.to = std::min(tunnel.to, out.ground);
          if (tunnel.from >= tunnel.to) continue;
          if (tunnel.to == out.ground) {
            out.plant = kEmpty;
            high = tunnel.from;
          }
          low_ = std::min(low_, tunnel.from);
          hollows_.push_back({static_cast<std::uint32_t>(columns_.size()), tunnel});
        }
      }
      high_ = std::max(high_, high);
      columns_.push_back(out);
    }
  }

  const auto has_tunnel_at_ground = [&](const GroundColumn& at, std::int32_t column_x,
                                        std::int32_t column_z) {
    if (!choices.has_caves || !may_have_tunnels(at)) return false;
    const auto tunnels = caves.at(column_x, column_z, at.surface);
    return std::any_of(tunnels.begin(), tunnels.end(),
                       [&](const Tunnel& t) { return t.from < at.ground && t.to >= at.ground; });
  };
  if (choices.trees <= 0) return;
  std::vector<Wood> trunks;
  const std::int32_t first_z = floor_to(z - kTreeReach, kTreeSpacing);
  const std::int32_t first_x = floor_to(x - kTreeReach, kTreeSpacing);
  for (std::int32_t tree_z = first_z; tree_z < z + d + kTreeReach; tree_z += kTreeSpacing) {
    for (std::int32_t tree_x = first_x; tree_x < x + w + kTreeReach; tree_x += kTreeSpacing) {
      const std::uint64_t random = place_hash(tree_key, tree_x, tree_z);
      const std::int32_t at_x = tree_x + static_cast<std::int32_t>((random >> 32) % kTreeSpacing);
      const std::int32_t at_z = tree_z + static_cast<std::int32_t>((random >> 40) % kTreeSpacing);
      if (at_x < x - kTreeReach || at_z < z - kTreeReach || at_x >= x + w + kTreeReach ||
          at_z >= z + d + kTreeReach)
        continue;
      const bool is_inside = at_x >= x - 1 && at_z >= z - 1 && at_x <= x + w && at_z <= z + d;
      const GroundColumn at = is_inside ? raw_at(at_x - x, at_z - z)
                                        : Ground::Block(ground, at_x, at_z).column(at_x, at_z);
      if (at.water > at.ground || at.shore < 40 || has_tunnel_at_ground(at, at_x, at_z)) continue;
      const LandCover cover = cover_of(at.place);
      const std::int32_t share = tree_share(at.place, cover);
      const auto dice = static_cast<std::int32_t>(random & (kOne - 1));
      if (dice * 100 >= share * choices.trees) continue;
      Tree tree{TreeKind::oak, mix64(random)};
      const auto kind = static_cast<std::int32_t>(tree.random & (kOne - 1));
      if (kind < pine_share(at.place)) {
        tree.kind = TreeKind::pine;
      } else if (at.patch + kind / 4 > 2300) {
        tree.kind = TreeKind::birch;
      } else if (kind % 8 == 0) {
        tree.kind = TreeKind::shrub;
      }
      const Material leaves = leaves_of(tree.kind, materials);
      for (std::int32_t dz = -kTreeReach; dz <= kTreeReach; ++dz) {
        for (std::int32_t dx = -kTreeReach; dx <= kTreeReach; ++dx) {
          const std::int32_t i = at_x + dx - x, k = at_z + dz - z;
          if (i < 0 || k < 0 || i >= w || k >= d) continue;
          const auto crown = crown_at(tree, dx, dz);
          if (!crown) continue;
          wood_.push_back({static_cast<std::uint32_t>(i + w * k), at.ground + crown->from,
                           at.ground + crown->to, leaves});
        }
      }
      if (at_x >= x && at_z >= z && at_x < x + w && at_z < z + d) {
        trunks.push_back({static_cast<std::uint32_t>(at_x - x + w * (at_z - z)), at.ground,
                          at.ground + trunk_height(tree), trunk_of(tree.kind, materials)});
      }
    }
  }
  wood_.insert(wood_.end(), trunks.begin(), trunks.end());
  // By column, and in this order in a column: a counting sort.
  std::vector<std::size_t> place(columns_.size() + 1);
  for (const Wood& wood : wood_) ++place[wood.column + 1];
  for (std::size_t i = 1; i < place.size(); ++i) place[i] += place[i - 1];
  std::vector<Wood> sorted(wood_.size());
  for (const Wood& wood : wood_) sorted[place[wood.column]++] = wood;
  wood_ = std::move(sorted);
  for (const Wood& wood : wood_) high_ = std::max(high_, wood.to);
}

}  // namespace runstone
