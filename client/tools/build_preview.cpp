#include "client/tools/build_preview.hpp"

#include <algorithm>
#include <utility>

#include "common/tiles/tile_rules.hpp"

namespace runstone {
namespace {

std::int32_t tiles_along(std::int32_t side, unsigned level) {
  const std::int64_t edge = std::int64_t{BuildPreview::kTileEdge} << level;
  return static_cast<std::int32_t>((side + edge - 1) / edge);
}

/// Returns the place of a cube among the 8^level cubes of a tile. Each three bits of the number
/// choose a child, the finest level last, in the order of TileChildren.
std::array<std::int32_t, 3> cube_place(std::uint64_t cube, unsigned level) {
  std::array<std::int32_t, 3> out{};
  for (unsigned bit = 0; bit < level; ++bit) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      out[axis] |= static_cast<std::int32_t>(cube >> (3 * bit + axis) & 1U) << bit;
  }
  return out;
}

RunChunk tile_of(std::vector<RunChunk>& children, const VisibilityTable& visibility,
                 TileScratch& scratch) {
  TileChildren all{};
  bool is_empty_tile = true;
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i] = &children[i];
    is_empty_tile = is_empty_tile && is_empty(children[i]);
  }
  if (is_empty_tile) {
    return uniform_chunk(Extent::cube(static_cast<unsigned>(BuildPreview::kTileEdge)), kEmpty,
                         kTileOrder);
  }
  return build_tile(all, static_cast<unsigned>(BuildPreview::kTileEdge), kTileOrder, visibility,
                    scratch);
}

}  // namespace

void BuildPreview::set(std::vector<ShownBuild> builds) {
  if (builds.size() > kBuildsMax) builds.resize(kBuildsMax);
  if (builds == shown_) return;
  shown_ = std::move(builds);
  std::vector<Model> models;
  for (const ShownBuild& shown : shown_) {
    const auto is_of = [&](const Model& model) { return model.build == shown.build; };
    if (std::any_of(models.begin(), models.end(), is_of)) continue;
    const auto known = std::find_if(models_.begin(), models_.end(), is_of);
    if (known != models_.end()) {
      models.push_back(std::move(*known));
      models_.erase(known);
      continue;
    }
    Model model;
    model.build = shown.build;
    begin(model);
    models.push_back(std::move(model));
  }
  models_ = std::move(models);
  is_changed_ = true;
  if (shown_.empty()) ghosts_.clear();
}

void BuildPreview::set_materials(MeshMaterialsPtr materials) {
  materials_ = std::move(materials);
  for (Model& model : models_) begin(model);
  is_changed_ = true;
}

void BuildPreview::begin(Model& model) const {
  const BuildPtr build = std::move(model.build);
  model = Model{};
  model.build = build;
  const VoxelPos s = build->sides();
  while (std::max({tiles_along(s.x, model.level), tiles_along(s.y, model.level),
                   tiles_along(s.z, model.level)}) > kTilesMax)
    ++model.level;
  model.counts = {tiles_along(s.x, model.level), tiles_along(s.y, model.level),
                  tiles_along(s.z, model.level)};
  model.halves.resize(model.level);
}

bool BuildPreview::is_complete() const {
  return !is_changed_ && std::all_of(models_.begin(), models_.end(), [](const Model& model) {
    return model.stage == Model::Stage::complete;
  });
}

bool BuildPreview::step(std::size_t tiles_max) {
  // A cube of one material has no lines to read.
  constexpr std::uint64_t kUnitsOfTile = 16;
  const std::uint64_t budget = std::uint64_t{tiles_max} > UINT64_MAX / kUnitsOfTile
                                   ? UINT64_MAX
                                   : std::uint64_t{tiles_max} * kUnitsOfTile;
  std::uint64_t used = 0;
  for (Model& model : models_) {
    while (used < budget && model.stage != Model::Stage::complete) {
      if (model.stage == Model::Stage::read) {
        used += read_cube(model) ? kUnitsOfTile : 1;
      } else {
        mesh_tile(model);
        used += kUnitsOfTile;
      }
    }
  }
  if (!is_changed_) return false;
  // The ghosts of the builds before stay until all of the new ones are made.
  if (std::any_of(models_.begin(), models_.end(),
                  [](const Model& model) { return model.stage != Model::Stage::complete; }))
    return false;
  collect();
  return true;
}

bool BuildPreview::read_cube(Model& model) {
  const auto per_layer =
      static_cast<std::uint64_t>(model.counts.x) * static_cast<std::uint64_t>(model.counts.y);
  const auto x_side = static_cast<std::uint64_t>(model.counts.x);
  const TilePos at{static_cast<std::int32_t>(model.next % x_side),
                   static_cast<std::int32_t>(model.next % per_layer / x_side),
                   static_cast<std::int32_t>(model.next / per_layer)};
  const auto place = cube_place(model.cube, model.level);
  const std::int64_t cubes = std::int64_t{1} << model.level;
  const auto low = [&](std::int32_t tile, std::size_t axis) {
    return (tile * cubes + place[axis]) * kTileEdge;
  };
  const std::array<std::int64_t, 3> corner = {low(at.x, 0), low(at.y, 1), low(at.z, 2)};
  const VoxelPos s = model.build->sides();
  const bool is_inside = corner[0] < s.x && corner[1] < s.y && corner[2] < s.z;
  RunChunk tile = uniform_chunk(Extent::cube(static_cast<unsigned>(kTileEdge)), kEmpty, kTileOrder);
  unsigned depth = 0;
  if (is_inside) {
    const VoxelPos min{static_cast<std::int32_t>(corner[0]), static_cast<std::int32_t>(corner[1]),
                       static_cast<std::int32_t>(corner[2])};
    tile = materials_in(*model.build,
                        {min, {min.x + kTileEdge, min.y + kTileEdge, min.z + kTileEdge}});
  } else {
    // All cubes of a group lie outside if its first one does. They are passed at once.
    while (depth < model.level && model.cube % (std::uint64_t{8} << 3 * depth) == 0) ++depth;
  }
  const bool has_lines = !tile.is_uniform();
  model.cube += std::uint64_t{1} << 3 * depth;
  for (; depth < model.level; ++depth) {
    model.halves[depth].push_back(std::move(tile));
    if (model.halves[depth].size() < 8) break;
    tile = tile_of(model.halves[depth], materials_->tiles, tiler_);
    model.halves[depth].clear();
  }
  if (depth < model.level) return has_lines;
  if (!is_empty(tile)) model.tiles.emplace(at, std::move(tile));
  model.cube = 0;
  if (++model.next == per_layer * static_cast<std::uint64_t>(model.counts.z)) {
    model.stage = Model::Stage::mesh;
    model.next = 0;
  }
  return has_lines;
}

void BuildPreview::mesh_tile(Model& model) {
  if (model.next == model.tiles.size()) {
    model.stage = Model::Stage::complete;
    model.tiles.clear();
    return;
  }
  const auto it = std::next(model.tiles.begin(), static_cast<std::ptrdiff_t>(model.next++));
  const TilePos at = it->first;
  MeshNeighbours neighbours{};
  for (int i = 0; i < kDirectionCount; ++i) {
    const ChunkCoord beside = neighbour({at.x, at.y, at.z}, static_cast<Direction>(i));
    const auto found = model.tiles.find({beside.x, beside.y, beside.z});
    if (found != model.tiles.end()) neighbours[static_cast<std::size_t>(i)] = &found->second;
  }
  auto mesh = std::make_shared<ChunkMesh>();
  if (model.level == 0) {
    mesh_chunk(it->second, neighbours, MeshBorders{}, *materials_, mesher_, *mesh);
  } else {
    mesh_rdm(it->second, neighbours, materials_->tiles, mesher_.cubes, *mesh);
  }
  model.quads += mesh->quad_count();
  if (model.quads > kQuadsMax) return coarsen(model);
  if (!mesh->empty()) model.meshed.push_back({at, std::move(mesh)});
}

void BuildPreview::coarsen(Model& model) {
  std::map<TilePos, RunChunk> coarse;
  const auto half = [](std::int32_t count) { return (count + 1) / 2; };
  model.counts = {half(model.counts.x), half(model.counts.y), half(model.counts.z)};
  for (TilePos at; at.z < model.counts.z; ++at.z) {
    for (at.y = 0; at.y < model.counts.y; ++at.y) {
      for (at.x = 0; at.x < model.counts.x; ++at.x) {
        std::vector<RunChunk> children;
        for (std::int32_t i = 0; i < 8; ++i) {
          const auto found =
              model.tiles.find({2 * at.x + (i & 1), 2 * at.y + (i >> 1 & 1), 2 * at.z + (i >> 2)});
          children.push_back(found != model.tiles.end()
                                 ? std::move(found->second)
                                 : uniform_chunk(Extent::cube(static_cast<unsigned>(kTileEdge)),
                                                 kEmpty, kTileOrder));
        }
        RunChunk tile = tile_of(children, materials_->tiles, tiler_);
        if (!is_empty(tile)) coarse.emplace(at, std::move(tile));
      }
    }
  }
  ++model.level;
  model.tiles = std::move(coarse);
  model.next = 0;
  model.quads = 0;
  model.meshed.clear();
}

void BuildPreview::collect() {
  ghosts_.clear();
  for (const ShownBuild& shown : shown_) {
    const auto model = std::find_if(models_.begin(), models_.end(),
                                    [&](const Model& m) { return m.build == shown.build; });
    for (const MeshedTile& tile : model->meshed) {
      GhostChunk ghost{{static_cast<std::uint8_t>(model->level), {tile.at.x, tile.at.y, tile.at.z}},
                       kTileEdge << model->level,
                       shown.is_removed ? nullptr : tile.mesh,
                       shown.is_removed ? tile.mesh : nullptr};
      ghost.shift = shown.at;
      ghosts_.push_back(std::move(ghost));
    }
  }
  is_changed_ = false;
}

std::uint64_t BuildPreview::placed_voxels() const {
  std::uint64_t out = 0;
  for (const ShownBuild& shown : shown_) {
    if (!shown.is_removed) out += shown.build->solid();
  }
  return out;
}

std::uint64_t BuildPreview::removed_voxels() const {
  std::uint64_t out = 0;
  for (const ShownBuild& shown : shown_) {
    if (shown.is_removed) {
      out += shown.build->solid();
    } else if (shown.is_difference) {
      out += shown.build->touched() - shown.build->solid();
    }
  }
  return out;
}

bool BuildPreview::is_exact() const {
  return std::all_of(shown_.begin(), shown_.end(),
                     [](const ShownBuild& shown) { return shown.is_difference; });
}

std::int32_t BuildPreview::cell_voxels() const {
  std::int32_t out = 0;
  for (const Model& model : models_) {
    if (model.stage == Model::Stage::complete) out = std::max(out, 1 << model.level);
  }
  return out;
}

}  // namespace runstone
