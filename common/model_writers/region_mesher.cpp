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

/// Returns the properties of the cell numbers.
MeshMaterials materials_of_cells(const WrittenBuild& source) {
  RUNSTONE_ASSERT(source.materials.size() == source.build.palette().size());
  std::vector<Visibility> rows = {Visibility::empty}, cubes = rows;  // untouched cells
  std::vector<Shape> shapes(1);
  for (const WrittenMaterial& material : source.materials) {
    rows.push_back(material.visibility);
    cubes.push_back(material.shape.is_cube() ? material.visibility : Visibility::empty);
    shapes.push_back(material.shape);
  }
  MeshMaterials out{VisibilityTable(rows)};
  out.cubes = VisibilityTable(cubes);
  out.shapes = ShapeTable(shapes);
  return out;
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

VisibilityTable visibility_as_cubes(const WrittenBuild& source) {
  RUNSTONE_ASSERT(source.materials.size() == source.build.palette().size());
  std::vector<Visibility> out = {Visibility::empty};  // untouched cells
  for (const WrittenMaterial& material : source.materials) out.push_back(material.as_cube);
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

RegionMesher::RegionMesher(const WrittenBuild& source, PlaneSides sides)
    : build_(source.build), materials_(materials_of_cells(source)), sides_(sides) {}

bool RegionMesher::is_empty(const RunChunk& cells) const {
  return cells.is_uniform() && materials_.rows[cells.runs.material(0)] == Visibility::empty;
}

/// Returns true for the quad of a plane that another one shows from the other side.
bool RegionMesher::is_second_side(Quad quad) const {
  const QuadFields q = unpack(quad);
  return q.face != 0 && q.direction == Direction::neg_x &&
         materials_.shapes[q.material].shape.form == ShapeForm::crossed;
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
  mesh_rdm(cells, neighbours, materials_.cubes, scratch_, mesh_);
  is_complete_ = mesh_shapes(cells, neighbours, materials_.rows, materials_.shapes, shape_scratch_,
                             mesh_.shapes) &&
                 is_complete_;
  quads_.reserve(mesh_.quad_count());
  const auto append = [&](const std::vector<Quad>& cubes, const std::vector<Quad>& shapes) {
    const auto first = static_cast<std::ptrdiff_t>(quads_.size());
    quads_.insert(quads_.end(), cubes.begin(), cubes.end());
    for (const Quad quad : shapes) {
      if (sides_ == PlaneSides::both || !is_second_side(quad)) quads_.push_back(quad);
    }
    std::sort(quads_.begin() + first, quads_.end(), [](Quad a, Quad b) {
      const std::uint64_t of_a = plane_of(a), of_b = plane_of(b);
      return of_a != of_b ? of_a < of_b : a < b;
    });
  };
  append(mesh_.opaque.quads, mesh_.shapes.opaque);
  append(mesh_.transparent.quads, mesh_.shapes.transparent);
  return quads_;
}

}  // namespace runstone
