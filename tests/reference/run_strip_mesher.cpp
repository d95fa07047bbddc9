#include "tests/reference/run_strip_mesher.hpp"

#include <array>
#include <cstddef>

#include "tests/reference/voxel_faces.hpp"

namespace runstone::reference {
namespace {

/// The traversal of the faces of one direction.
struct Way {
  Direction direction;
  Axis run;
  std::ptrdiff_t beside;    // from a voxel to the one that its face touches
  std::ptrdiff_t next;      // to the next voxel of a run
  std::size_t next_marked;  // the same step among the marks
};

std::array<Way, kDirectionCount> ways_through(const DenseGrid& grid) {
  std::array<Way, kDirectionCount> ways{};
  for (unsigned d = 0; d < kDirectionCount; ++d) {
    const auto direction = static_cast<Direction>(d);
    const Axis across = axis_of(direction);
    const Axis run = across == Axis::y ? Axis::x : Axis::y;
    const std::ptrdiff_t beside =
        is_positive(direction) ? grid.stride(across) : -grid.stride(across);
    ways[d] = {direction, run, beside, grid.stride(run), run == Axis::y ? 1u : grid.extent().y};
  }
  return ways;
}

/// Marks the faces of a run from `voxel` on, of at most `most` voxels. Returns their number.
std::uint32_t cover_run(const VisibilityTable& visibility, HiddenFaces hidden, const Way& way,
                        const Material* voxel, std::uint8_t* covered, std::uint32_t most) {
  const Material material = *voxel;
  const auto mark = static_cast<std::uint8_t>(1u << static_cast<unsigned>(way.direction));
  std::uint32_t length = 0;
  do {
    *covered = static_cast<std::uint8_t>(*covered | mark);
    covered += way.next_marked;
    voxel += way.next;
    ++length;
  } while (length < most && *voxel == material &&
           (hidden == HiddenFaces::run_on || visibility.face_drawn(material, voxel[way.beside])));
  return length;
}

}  // namespace

void mesh_run_strips(const DenseGrid& grid, const VisibilityTable& visibility, HiddenFaces hidden,
                     RunStripScratch& scratch, std::vector<Quad>& out) {
  out.clear();
  const Extent extent = grid.extent();
  const std::array<Way, kDirectionCount> ways = ways_through(grid);
  scratch.covered.assign(extent.volume(), 0);
  std::uint8_t* covered = scratch.covered.data();
  for (std::uint8_t z = 0; z < extent.z; ++z) {
    for (std::uint8_t x = 0; x < extent.x; ++x) {
      const Material* voxel = grid.origin() + z * grid.stride(Axis::z) + x * grid.stride(Axis::x);
      for (std::uint8_t y = 0; y < extent.y; ++y, voxel += grid.stride(Axis::y), ++covered) {
        if (visibility[*voxel] == Visibility::empty) continue;
        for (const Way& way : ways) {
          const bool done = (*covered >> static_cast<unsigned>(way.direction) & 1) != 0;
          if (done || !visibility.face_drawn(*voxel, voxel[way.beside])) continue;
          const auto most =
              static_cast<std::uint32_t>(way.run == Axis::y ? extent.y - y : extent.x - x);
          const std::uint32_t length = cover_run(visibility, hidden, way, voxel, covered, most);
          out.push_back(strip_quad({x, y, z}, way.direction, *voxel, way.run, length));
        }
      }
    }
  }
}

}  // namespace runstone::reference
