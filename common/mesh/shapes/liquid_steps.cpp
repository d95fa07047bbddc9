#include "common/mesh/shapes/liquid_steps.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "common/mesh/quad.hpp"
#include "common/mesh/shapes/beyond_border.hpp"
#include "common/mesh/shapes/face_lists.hpp"

namespace runstone {
namespace {

constexpr std::array kSides = {Direction::neg_x, Direction::pos_x, Direction::neg_z,
                               Direction::pos_z};

/// A voxel of a chunk, or one beside it, by Axis.
using Place = std::array<int, 3>;

class StepFinder {
 public:
  StepFinder(const RunChunk& chunk, const MeshNeighbours& neighbours,
             const MeshMaterials& materials, std::vector<Quad>& out)
      : chunk_(chunk), neighbours_(neighbours), visibility_(materials.cubes), out_(out) {
    beyond_.begin(chunk, neighbours);
    for (std::size_t axis = 0; axis < 3; ++axis) sides_[axis] = chunk.extent.sides()[axis];
  }

  /// Adds the steps around an upper face: towards covered voxels of the same liquid.
  void add_around(const QuadFields& face) {
    // u and v are z and x for faces along y.
    for (const Direction d : kSides) {
      const bool is_along_x = axis_of(d) == Axis::x;
      Place first = {face.x, face.y, face.z};
      if (d == Direction::pos_x) first[0] += face.height - 1;
      if (d == Direction::pos_z) first[2] += face.width - 1;
      add_row(first, is_along_x ? face.width : face.height, d, face.material,
              [&](const Place& voxel) {
                const Place other = beside(voxel, d);
                return at(other) == std::optional<Material>(face.material) &&
                       is_covered(other, face.material);
              });
    }
  }

  /// Adds the steps at the upper edge of a lateral face.
  void add_above(const QuadFields& face) {
    // u and v are y and z for faces along x, and x and y for those along z.
    const Direction d = face.direction;
    const bool is_along_x = axis_of(d) == Axis::x;
    const auto axis = static_cast<std::size_t>(axis_of(d));
    const Place first = {face.x, face.y + (is_along_x ? face.width : face.height) - 1, face.z};
    const bool is_on_border = first[axis] == (is_positive(d) ? sides_[axis] - 1 : 0);
    if (is_on_border && neighbours_[static_cast<std::size_t>(d)] == nullptr) return;
    add_row(first, is_along_x ? face.height : face.width, d, face.material,
            [&](const Place& voxel) { return is_covered(voxel, face.material); });
  }

 private:
  static Place beside(Place voxel, Direction d) {
    voxel[static_cast<std::size_t>(axis_of(d))] += is_positive(d) ? 1 : -1;
    return voxel;
  }

  /// Returns a material, or nullopt if the voxel is in no neighbour.
  std::optional<Material> at(const Place& voxel) {
    std::optional<Direction> out_of;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (voxel[axis] >= 0 && voxel[axis] < sides_[axis]) continue;
      if (out_of) return std::nullopt;
      out_of = static_cast<Direction>(2 * axis + (voxel[axis] < 0 ? 0U : 1U));
    }
    const auto bits = [](int value) { return static_cast<std::uint8_t>(value); };
    if (!out_of) return material_at(chunk_, {bits(voxel[0]), bits(voxel[1]), bits(voxel[2])});
    std::uint64_t place = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (static_cast<Axis>(axis) != axis_of(*out_of))
        place |= std::uint64_t{bits(voxel[axis])}
                 << shape_mesh::place_shift(static_cast<Axis>(axis));
    }
    return beyond_.at(*out_of, place);
  }

  bool is_covered(const Place& voxel, Material liquid) {
    const auto above = at(beside(voxel, Direction::pos_y));
    return above && (*above == liquid || visibility_[*above] == Visibility::opaque);
  }

  /// Adds steps on side d of the voxels of a row that `shows` names. Equal ones that lie side by
  /// side are joined. The row lies across y and the axis of d.
  template <class F>
  void add_row(Place voxel, int count, Direction d, Material liquid, const F& shows) {
    const bool is_along_x = axis_of(d) == Axis::x;
    const std::size_t along = is_along_x ? 2 : 0;
    bool is_open = false;  // the last quad ends at this voxel
    for (int i = 0; i < count; ++i, ++voxel[along]) {
      if (!shows(voxel)) {
        is_open = false;
      } else if (is_open) {
        out_.back().bits += std::uint64_t{1} << shape_mesh::size_shift(d, static_cast<Axis>(along));
      } else {
        QuadFields step;
        step.x = static_cast<std::uint8_t>(voxel[0]);
        step.y = static_cast<std::uint8_t>(voxel[1]);
        step.z = static_cast<std::uint8_t>(voxel[2]);
        step.direction = d;
        step.material = liquid;
        step.face = kLiquidStepFace;
        out_.push_back(pack(step));
        is_open = true;
      }
    }
  }

  const RunChunk& chunk_;
  const MeshNeighbours& neighbours_;
  const VisibilityTable& visibility_;
  shape_mesh::BeyondBorder beyond_;
  std::vector<Quad>& out_;
  std::array<int, 3> sides_{};
};

}  // namespace

void add_liquid_steps(const RunChunk& chunk, const MeshNeighbours& neighbours,
                      const MeshMaterials& materials, ChunkMesh& mesh) {
  if (materials.liquids.empty() || mesh.transparent.quads.empty()) return;
  std::vector<Quad>& out = mesh.shapes.transparent;
  const std::size_t before = out.size();
  std::optional<StepFinder> finder;  // made for the first liquid
  for (const Quad quad : mesh.transparent.quads) {
    const QuadFields face = unpack(quad);
    if (!materials.is_liquid(face.material) || face.direction == Direction::neg_y) continue;
    if (!finder) finder.emplace(chunk, neighbours, materials, out);
    if (face.direction == Direction::pos_y) {
      finder->add_around(face);
    } else {
      finder->add_above(face);
    }
  }
  if (out.size() == before) return;
  // By direction, and in this order in a direction.
  std::vector<Quad> sorted;
  sorted.reserve(out.size());
  for (int d = 0; d < kDirectionCount; ++d) {
    for (const Quad quad : out) {
      if (unpack(quad).direction == static_cast<Direction>(d)) sorted.push_back(quad);
    }
  }
  out = std::move(sorted);
}

}  // namespace runstone
