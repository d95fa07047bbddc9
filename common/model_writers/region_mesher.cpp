#include "common/model_writers/region_mesher.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

/// Returns the layer of cells that touches a box from outside.
VoxelBox layer_beside(VoxelBox box, Direction direction) {
  const bool is_high = is_positive(direction);
  const auto move = [&](std::int32_t& low, std::int32_t& high) {
    low = is_high ? high : low - 1;
    high = low + 1;
  };
  switch (axis_of(direction)) {
    case Axis::x:
      move(box.min.x, box.max.x);
      break;
    case Axis::y:
      move(box.min.y, box.max.y);
      break;
    case Axis::z:
      move(box.min.z, box.max.z);
      break;
  }
  return box;
}

/// Returns a number that ascends by material, direction and layer.
std::uint64_t plane_of(Quad quad) {
  const QuadFields q = unpack(quad);
  const std::array<std::uint8_t, 3> at = {q.x, q.y, q.z};
  return std::uint64_t{q.material} << 16 |
         std::uint64_t{static_cast<std::uint8_t>(q.direction)} << 8 |
         at[static_cast<std::size_t>(axis_of(q.direction))];
}

}  // namespace

VisibilityTable visibility_of_cells(const WrittenBuild& source) {
  RUNSTONE_ASSERT(source.materials.size() == source.build.palette().size());
  std::vector<Visibility> out = {Visibility::empty};  // untouched cells
  for (const WrittenMaterial& material : source.materials) out.push_back(material.visibility);
  return VisibilityTable(out);
}

ModelRegionPos region_counts(const Build& build) {
  const VoxelPos sides = build.sides();
  const auto count = [](std::int32_t side) {
    return (side + kModelRegionEdge - 1) / kModelRegionEdge;
  };
  return {count(sides.x), count(sides.y), count(sides.z)};
}

VoxelBox region_box(const Build& build, ModelRegionPos at) {
  return intersect(build.box(), box_of(ChunkCoord{at.x, at.y, at.z}, kModelRegionEdge));
}

RegionMesher::RegionMesher(const WrittenBuild& source)
    : build_(source.build), visibility_(visibility_of_cells(source)) {}

bool RegionMesher::is_empty(const RunChunk& cells) const {
  return cells.is_uniform() && visibility_[cells.runs.material(0)] == Visibility::empty;
}

const std::vector<Quad>& RegionMesher::quads_of(ModelRegionPos at) {
  quads_.clear();
  const VoxelBox box = region_box(build_, at);
  const RunChunk cells = cells_in(build_, box);
  if (is_empty(cells)) return quads_;
  std::array<std::optional<RunChunk>, kDirectionCount> beside;
  MeshNeighbours neighbours{};
  for (std::size_t i = 0; i < beside.size(); ++i) {
    const VoxelBox layer = layer_beside(box, static_cast<Direction>(i));
    if (intersect(build_.box(), layer) != layer) continue;  // outside of the build
    beside[i] = cells_in(build_, layer);
    neighbours[i] = &*beside[i];
  }
  mesh_rdm(cells, neighbours, visibility_, scratch_, mesh_);
  quads_.reserve(mesh_.quad_count());
  const auto append = [&](const std::vector<Quad>& pass) {
    const auto first = static_cast<std::ptrdiff_t>(quads_.size());
    quads_.insert(quads_.end(), pass.begin(), pass.end());
    std::sort(quads_.begin() + first, quads_.end(), [](Quad a, Quad b) {
      const std::uint64_t of_a = plane_of(a), of_b = plane_of(b);
      return of_a != of_b ? of_a < of_b : a < b;
    });
  };
  append(mesh_.opaque.quads);
  append(mesh_.transparent.quads);
  return quads_;
}

}  // namespace runstone
