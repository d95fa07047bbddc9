#include "tests/reference/grid_rdm.hpp"

#include <array>

#include "tests/reference/voxel_faces.hpp"

namespace runstone::reference {
namespace {

using Strip = GridRdmScratch::Strip;

struct Traversal {
  Axis layer, row, run;
};
/// The run and row axes, by axis of the faces. The thesis' axes are x, y, z with z up; here they
/// are x, z, y.
constexpr std::array<Traversal, 3> kTraversals = {
    {{Axis::x, Axis::y, Axis::z}, {Axis::y, Axis::x, Axis::z}, {Axis::z, Axis::y, Axis::x}}};

/// First phase: makes the run strips of one direction.
void make_strips(const DenseGrid& grid, const VisibilityTable& visibility, Direction direction,
                 std::vector<Strip>& strips) {
  const Traversal t = kTraversals[static_cast<std::size_t>(axis_of(direction))];
  const auto sides = grid.extent().sides();
  const std::ptrdiff_t beside =
      is_positive(direction) ? grid.stride(t.layer) : -grid.stride(t.layer);
  const std::ptrdiff_t step = grid.stride(t.run);
  strips.clear();
  for (std::uint8_t layer = 0; layer < sides[static_cast<std::size_t>(t.layer)]; ++layer) {
    for (std::uint8_t row = 0; row < sides[static_cast<std::size_t>(t.row)]; ++row) {
      const Material* voxel =
          grid.origin() + layer * grid.stride(t.layer) + row * grid.stride(t.row);
      bool open = false;  // the last strip ends at this voxel
      for (std::uint8_t at = 0; at < sides[static_cast<std::size_t>(t.run)]; ++at, voxel += step) {
        const bool drawn = visibility.face_drawn(*voxel, voxel[beside]);
        if (drawn && open && strips.back().material == *voxel) {
          ++strips.back().end;
        } else if (drawn) {
          strips.push_back({layer, row, static_cast<std::uint8_t>(row + 1), at,
                            static_cast<std::uint8_t>(at + 1), *voxel});
        }
        open = drawn;
      }
    }
  }
}

/// Second phase: joins strips with equal strips in the row before. A joined strip keeps the place
/// of its first row.
void join_rows(GridRdmScratch& scratch) {
  std::vector<std::uint32_t>& row = scratch.row;
  std::vector<std::uint32_t>& before = scratch.row_before;
  row.clear();
  before.clear();
  std::vector<Strip>& strips = scratch.strips;
  std::uint32_t kept = 0;
  std::uint8_t layer = 0;
  std::uint8_t row_at = 0;
  for (const Strip strip : strips) {  // by value: joined strips are overwritten
    if (strip.layer != layer || strip.row_first != row_at) {
      before.swap(row);
      row.clear();
      if (strip.layer != layer || strip.row_first != row_at + 1) before.clear();
      layer = strip.layer;
      row_at = strip.row_first;
    }
    std::uint32_t joined = kept;
    for (const std::uint32_t candidate : before) {
      const Strip& other = strips[candidate];
      if (other.begin == strip.begin && other.end == strip.end && other.material == strip.material)
        joined = candidate;
    }
    if (joined == kept) {
      strips[kept++] = strip;
    } else {
      strips[joined].row_end = strip.row_end;
    }
    row.push_back(joined);
  }
  strips.resize(kept);
}

Quad quad_of(const Strip& strip, Direction direction) {
  const Traversal t = kTraversals[static_cast<std::size_t>(axis_of(direction))];
  std::array<std::uint8_t, 3> at{};
  at[static_cast<std::size_t>(t.layer)] = strip.layer;
  at[static_cast<std::size_t>(t.row)] = strip.row_first;
  at[static_cast<std::size_t>(t.run)] = strip.begin;
  const auto rows = static_cast<std::uint32_t>(strip.row_end - strip.row_first);
  const auto length = static_cast<std::uint32_t>(strip.end - strip.begin);
  const bool run_is_u = u_axis_of(t.layer) == t.run;
  return face_quad({at[0], at[1], at[2]}, direction, strip.material, run_is_u ? length : rows,
                   run_is_u ? rows : length);
}

}  // namespace

void mesh_grid_rdm(const DenseGrid& grid, const VisibilityTable& visibility,
                   GridRdmScratch& scratch, std::vector<Quad>& out) {
  out.clear();
  for (unsigned d = 0; d < kDirectionCount; ++d) {
    const auto direction = static_cast<Direction>(d);
    make_strips(grid, visibility, direction, scratch.strips);
    join_rows(scratch);
    for (const Strip& strip : scratch.strips) out.push_back(quad_of(strip, direction));
  }
}

}  // namespace runstone::reference
