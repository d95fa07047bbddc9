#include "server/map/map_drawer.hpp"

#include <algorithm>
#include <functional>
#include <span>
#include <utility>

#include "common/map/map_painter.hpp"
#include "server/map/map_png.hpp"

namespace runstone {
namespace {

/// The columns of chunks or tiles of a map tile.
struct Columns {
  std::int32_t per_side = 0;
  std::int32_t first_x = 0, first_z = 0;
};

Columns columns_of(const MapPlace& place, std::int32_t edge) {
  const std::int32_t per_side = kMapTileSide / edge;
  return {per_side, place.x * per_side, place.z * per_side};
}

}  // namespace

Version MapDrawer::version(const MapMoment& moment, const MapPlace& place) {
  const Columns all = columns_of(place, moment.meta().chunk_edge);
  Version out;
  for (std::int32_t z = -1; z < all.per_side; ++z) {
    for (std::int32_t x = -1; x < all.per_side; ++x) {
      out = std::max(
          out, moment.ground().column_version({place.zoom, all.first_x + x, all.first_z + z}));
    }
  }
  return out;
}

std::vector<std::int32_t> MapDrawer::heights(const MapMoment& moment, const ColumnKey& key) const {
  std::vector<std::int32_t> out = moment.ground().heights(key);
  const std::int32_t width = static_cast<std::int32_t>(moment.meta().chunk_edge) << key.level;
  if (generator_.y_max() > generator_.y_min()) {
    // Below its range the ground of a generator is uniform: one chunk of it shows what is there.
    const std::int32_t low = floor_div(generator_.y_min(), width) - 1;
    for (std::int32_t y = floor_div(generator_.y_max() - 1, width); y >= low; --y) out.push_back(y);
    std::sort(out.begin(), out.end(), std::greater<>());
    out.erase(std::unique(out.begin(), out.end()), out.end());
  }
  // A tile of the lowest or highest level never crosses the border of the world.
  const std::int32_t limit = kWorldLimit / width;
  std::erase_if(out, [&](std::int32_t y) { return y < -limit || y >= limit; });
  return out;
}

StoreResult<std::shared_ptr<const MapTops>> MapDrawer::tops(const MapMoment& moment,
                                                            const ColumnKey& key) {
  const std::pair<ColumnKey, Version> kept_as{key, moment.ground().column_version(key)};
  if (auto kept = caches_.tops.find(kept_as)) return kept;
  const std::int32_t edge = moment.meta().chunk_edge;
  MapTopsFinder finder(edge, materials_);
  for (const std::int32_t y : heights(moment, key)) {
    if (finder.is_complete()) break;
    const auto voxels = voxels_.at(moment, {key.level, {key.x, y, key.z}});
    if (!voxels) return failure(voxels.error());
    finder.visit({voxels->get(), y * edge});
  }
  auto made = std::make_shared<const MapTops>(finder.take());
  caches_.tops.put(kept_as, made, made->bytes());
  return std::shared_ptr<const MapTops>(std::move(made));
}

StoreResult<std::shared_ptr<const std::string>> MapDrawer::draw(const MapMoment& moment,
                                                                const MapPlace& place) {
  const std::int32_t edge = moment.meta().chunk_edge;
  const Columns all = columns_of(place, edge);
  const std::int32_t limit = kWorldLimit / (edge << place.zoom);
  MapPainter painter(materials_, 1 << place.zoom);
  constexpr auto kSide = static_cast<std::size_t>(kMapTileSide);
  std::vector<std::uint32_t> pixels(kSide * kSide);
  // The columns of the row to the north, and the one to the west. Null: beyond the world.
  using Tops = std::shared_ptr<const MapTops>;
  std::vector<Tops> north(static_cast<std::size_t>(all.per_side));
  Tops west;
  for (std::int32_t z = -1; z < all.per_side; ++z) {
    for (std::int32_t x = z < 0 ? 0 : -1; x < all.per_side; ++x) {
      const ColumnKey key{place.zoom, all.first_x + x, all.first_z + z};
      Tops here;
      if (key.x >= -limit && key.z >= -limit) {
        auto found = tops(moment, key);
        if (!found) return failure(found.error());
        here = *std::move(found);
      }
      if (x >= 0) {
        Tops& before = north[static_cast<std::size_t>(x)];
        if (z >= 0) {
          const std::size_t first =
              static_cast<std::size_t>(z * edge) * kSide + static_cast<std::size_t>(x * edge);
          painter.paint(*here, west == nullptr ? std::vector<ColumnTop>() : west->last_x(),
                        before == nullptr ? std::span<const ColumnTop>() : before->last_z(),
                        std::span(pixels).subspan(first), kSide);
        }
        before = here;
      }
      west = std::move(here);
    }
  }
  return std::make_shared<const std::string>(png_of(pixels, kMapTileSide));
}

}  // namespace runstone
