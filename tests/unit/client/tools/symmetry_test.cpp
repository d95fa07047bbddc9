#include "client/tools/symmetry.hpp"

#include <catch2/catch.hpp>

#include "client/tools/merge_edits.hpp"
#include "tests/unit/client/tools/tool_bench.hpp"

namespace runstone::test {
namespace {

constexpr std::int32_t kHalf = 24;  // voxels that are read on each side of the origin

/// Returns the edits that stay within 12 voxels around the origin, one of each kind.
std::vector<EditDescriptor> edits_of_each_kind(ToolBench& bench) {
  bench.box.select(VoxelBox{{-3, -2, -5}, {4, 3, 6}});
  REQUIRE(bench.box.copy(bench.replica, true));
  const auto clipboard = bench.box.clipboard().whole;
  const Orientation turned = Orientation{}.rotated_about_y(1);
  return {{SetVoxel{{3, 1, 2}}, {}, 2},
          {FillBox{{{1, 0, -4}, {6, 3, 2}}}, {}, 3},
          {FillSphere{{5, 1, 2}, 4}, {}, 2},
          {FillStroke{{{2, 0, 1}, {7, 4, 3}, {1, 2, 9}}, 2}, {}, kEmpty},
          {Paste{{2, -1, 1}, clipboard, turned}, {}, kEmpty}};
}

}  // namespace

TEST_CASE("a mirrored edit changes the mirrored voxels", "[tools][property]") {
  ToolBench shapes;
  shapes.show_random();
  for (const EditDescriptor& edit : edits_of_each_kind(shapes)) {
    for (const Axis axis : {Axis::x, Axis::z}) {
      for (const std::int32_t centre2 : {0, 5, -3}) {
        CAPTURE(edit.shape.index(), static_cast<int>(axis), centre2);
        ToolBench plain, other;
        plain.show_flat();
        other.show_flat();
        plain.predict({edit});
        other.predict({mirrored(edit, axis, centre2, {})});
        for (VoxelPos p{-kHalf, 0, 0}; p.x < kHalf; ++p.x) {
          for (p.y = -6; p.y < 8; ++p.y) {
            for (p.z = -kHalf; p.z < kHalf; ++p.z) {
              VoxelPos q = p;
              (axis == Axis::x ? q.x : q.z) = centre2 - (axis == Axis::x ? p.x : p.z);
              if (plain.at(p) != other.at(q))
                FAIL_CHECK("voxel " << p.x << ' ' << p.y << ' ' << p.z);
            }
          }
        }
      }
    }
  }
}

TEST_CASE("symmetric copies become one edit, and a copy onto itself counts once", "[tools]") {
  const std::vector<EditDescriptor> edits = {{FillSphere{{9, 0, 0}, 3}, {}, 2}};
  CHECK(with_copies(edits, {SymmetryKind::none, 0, 0}, {}) == edits);
  CHECK(with_copies({{SetVoxel{{0, 0, 0}}, {}, 2}}, {SymmetryKind::x, 0, 0}, {}) ==
        std::vector<EditDescriptor>{{SetVoxel{{0, 0, 0}}, {}, 2}});
  const auto both = with_copies(edits, {SymmetryKind::both, 0, 11}, {});
  REQUIRE(both.size() == 1);
  CHECK(bounding_box(both[0]) == VoxelBox{{-12, -3, -3}, {13, 4, 15}});
  // The plane is too far away for one paste.
  CHECK(with_copies(edits, {SymmetryKind::point, 400, 0}, {}).size() == 2);
}

TEST_CASE("merged edits have the effect of the edits one after another", "[tools][property]") {
  ToolBench shapes;
  shapes.show_random();
  for (const std::vector<EditDescriptor>& edits :
       {edits_of_each_kind(shapes), {{SetVoxel{{1, 1, 1}}, {}, 3}, {SetVoxel{{2, 2, 2}}, {}, 2}}}) {
    ToolBench plain, merged;
    plain.show_flat();
    merged.show_flat();
    plain.predict(edits);
    const auto one = merge_edits(edits);
    REQUIRE(one.size() == 1);
    merged.predict(one);
    for (VoxelPos p{-kHalf, 0, 0}; p.x < kHalf; ++p.x) {
      for (p.y = -8; p.y < 12; ++p.y) {
        for (p.z = -kHalf; p.z < kHalf; ++p.z) {
          if (plain.at(p) != merged.at(p)) FAIL_CHECK("voxel " << p.x << ' ' << p.y << ' ' << p.z);
        }
      }
    }
  }
}

TEST_CASE("edits with different masks are not merged", "[tools]") {
  const std::vector<EditDescriptor> edits = {{SetVoxel{{0, 0, 0}}, {}, 2},
                                             {SetVoxel{{1, 0, 0}}, {MaskKind::only_empty, 0}, 2}};
  CHECK(merge_edits(edits) == edits);
}

}  // namespace runstone::test
