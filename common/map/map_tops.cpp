#include "common/map/map_tops.hpp"

namespace runstone {
namespace {

/// Returns true if a chunk of one material shows nothing from above.
bool is_invisible(const RunChunk& chunk, const MapMaterials& materials) {
  if (!chunk.is_uniform()) return false;
  const std::size_t material = chunk.runs.material(0);
  return material < materials.showing.size() && !materials.showing[material] &&
         material < materials.ground.size() && !materials.ground[material];
}

/// Returns true if a voxel of the chunk shows and is no ground.
bool has_transparent(const RunChunk& chunk, const MapMaterials& materials) {
  const auto is_in = [](const ShowingMaterials& set, Material id) {
    return id >= set.size() || set[id];
  };
  return chunk.runs.visit([&](const auto& runs) {
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const Material id = runs.material(i);
      if (is_in(materials.showing, id) && !is_in(materials.ground, id)) return true;
    }
    return false;
  });
}

}  // namespace

std::vector<ColumnTop> MapTops::last_x() const {
  std::vector<ColumnTop> out;
  out.reserve(static_cast<std::size_t>(edge));
  for (std::int32_t z = 0; z < edge; ++z) out.push_back(at(edge - 1, z));
  return out;
}

MapTopsFinder::MapTopsFinder(std::int32_t edge, const MapMaterials& materials)
    : materials_(materials),
      tops_(edge),
      surface_open_(tops_.surface.size()),
      ground_open_(surface_open_) {}

std::size_t MapTopsFinder::visit(const StackedChunk& chunk) {
  if (is_invisible(*chunk.voxels, materials_)) return 1;
  if (tops_.ground.empty() && has_transparent(*chunk.voxels, materials_))
    tops_.ground = tops_.surface;
  if (surface_open_ != 0) {
    surface_open_ -=
        find_column_tops(*chunk.voxels, chunk.base_y, materials_.showing, tops_.surface);
  }
  if (tops_.ground.empty()) {
    ground_open_ = surface_open_;
  } else {
    ground_open_ -= find_column_tops(*chunk.voxels, chunk.base_y, materials_.ground, tops_.ground);
  }
  return chunk.voxels->runs.size() + tops_.surface.size();
}

MapTops find_map_tops(std::span<const StackedChunk> chunks, std::int32_t edge,
                      const MapMaterials& materials, std::size_t& work) {
  MapTopsFinder finder(edge, materials);
  for (const StackedChunk& chunk : chunks) {
    if (finder.is_complete()) break;
    work += finder.visit(chunk);
  }
  return finder.take();
}

}  // namespace runstone
