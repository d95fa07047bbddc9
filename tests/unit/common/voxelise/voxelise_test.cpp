#include "common/voxelise/voxelise.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <set>
#include <thread>

#include "common/voxelise/voxel_build.hpp"
#include "tests/support/voxelise/meshes.hpp"
#include "tests/support/voxelise/voxel_grid.hpp"
#include "tests/support/voxelise/voxel_oracle.hpp"

namespace runstone::test {
namespace {

VoxeliseOptions solid_options(double voxels_per_unit = 1) {
  VoxeliseOptions out;
  out.scale.voxels_per_unit = voxels_per_unit;
  return out;
}

VoxeliseOptions surface_options(SurfaceMode mode, double voxels_per_unit = 1) {
  VoxeliseOptions out = solid_options(voxels_per_unit);
  out.is_solid = false;
  out.surface = mode;
  return out;
}

std::uint64_t voxels_of(const Model& mesh, const VoxeliseOptions& options) {
  const auto grid = voxel_grid(mesh, options);
  REQUIRE(grid.has_value());
  return grid->result.voxels;
}

bool equals_oracle(const Model& mesh) {
  const VoxelOracle oracle(mesh, 1);
  const auto grid = voxel_grid(mesh, solid_options());
  REQUIRE(grid.has_value());
  bool equal = grid->result.sides == oracle.sides();
  grid->for_each([&](VoxelPos p, Material material) {
    equal = equal && (material != kEmpty) == oracle.is_inside(p);
  });
  return equal;
}

/// A box cut into pyramids from a point inside, so that edges and a vertex lie where the caller
/// wants.
Model fan_box(Place low, Place high, Place apex) {
  Model out = box_mesh(low, high);
  // The top is a fan around the apex.
  std::erase_if(out.triangles, [](const auto& t) {
    return std::all_of(t.begin(), t.end(), [](std::uint32_t v) { return (v & 2) != 0; });
  });
  out.positions.push_back(apex);
  for (const auto& [a, b] : {std::pair{2U, 6U}, {6U, 7U}, {7U, 3U}, {3U, 2U}})
    out.triangles.push_back({a, b, 8});
  return out;
}

Model material_mesh(Model mesh, ModelColour colour) {
  mesh.materials.push_back({"paint", colour, std::nullopt});
  mesh.material_of.assign(mesh.triangles.size(), 0);
  return mesh;
}

}  // namespace

TEST_CASE("a box is solid where the centres of voxels are inside", "[voxelise]") {
  CHECK(voxels_of(box_mesh({3, 4, 5}, {13, 9, 8}), solid_options()) == 10 * 5 * 3);
  // Faces on centres: the lower ones count, the upper ones do not.
  Model on_centres =
      joined({box_mesh({0, 0, 0}, {1, 1, 1}), box_mesh({2.5, 2.5, 2.5}, {5.5, 5.5, 5.5})});
  CHECK(voxels_of(on_centres, solid_options()) == 1 + 3 * 3 * 3);
  CHECK(equals_oracle(on_centres));
}

TEST_CASE("vertices and shared edges on centres neither leak nor count twice", "[voxelise]") {
  // The apex lies on a centre, and its edges run through centres.
  for (const float y : {10.0F, 8.5F, 12.25F, 14.0F}) {
    CAPTURE(y);
    CHECK(equals_oracle(fan_box({0, 0, 0}, {9, 10, 9}, {4.5F, y, 4.5F})));
    CHECK(equals_oracle(fan_box({0, 0, 0}, {10, 10, 10}, {5, y, 5})));
  }
  CHECK(equals_oracle(snapped_to(icosphere({8, 8, 8}, 8, 1), 2)));
}

TEST_CASE("slivers, faces in the plane of the rows and triangles without area are no trouble",
          "[voxelise]") {
  const Model sliver = box_mesh({0, 0, 0}, {30, 0.01F, 20});
  CHECK(voxels_of(sliver, solid_options()) == 0);
  // Solid and surface together keep the thin wall.
  VoxeliseOptions both = solid_options();
  both.surface = SurfaceMode::conservative;
  CHECK(voxels_of(sliver, both) == 30 * 20);
  CHECK(equals_oracle(
      joined({box_mesh({0, 0, 0}, {12, 12, 12}), box_mesh({3, 0.5F, 3}, {9, 4.5F, 9})})));
  Model flat = box_mesh({0, 0, 0}, {8, 8, 8});
  flat.triangles.push_back({0, 0, 1});
  CHECK(voxels_of(flat, solid_options()) == 512);
  Model line;
  line.positions = {{0, 0, 0}, {4, 4, 4}, {8, 8, 8}};
  line.triangles = {{0, 1, 2}};
  CHECK(voxels_of(line, surface_options(SurfaceMode::conservative)) ==
        8 + 7 * 6);  // at each corner that it passes, all eight voxels
}

TEST_CASE("a mesh is closed by the places of its vertices", "[voxelise]") {
  const Model sphere = icosphere({10, 10, 10}, 10, 3);
  const auto indexed = voxel_grid(sphere, solid_options());
  const auto soup = voxel_grid(as_soup(sphere), solid_options());
  REQUIRE(indexed.has_value());
  REQUIRE(soup.has_value());
  CHECK(indexed->result.closure == MeshClosure::closed);
  CHECK(indexed->result.rule == SolidRule::parity);
  CHECK(soup->result.closure == MeshClosure::closed);
  CHECK(indexed->cells == soup->cells);
}

TEST_CASE("inverted triangles do not change a solid", "[voxelise]") {
  Model mesh = icosphere({10, 10, 10}, 10, 2);
  const auto right = voxel_grid(mesh, solid_options());
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3)
    std::swap(mesh.triangles[i][0], mesh.triangles[i][1]);
  const auto inverted = voxel_grid(mesh, solid_options());
  REQUIRE(right.has_value());
  REQUIRE(inverted.has_value());
  CHECK(inverted->result.closure == MeshClosure::inverted);
  CHECK(inverted->result.rule == SolidRule::parity);
  CHECK(inverted->cells == right->cells);
}

TEST_CASE("a mesh that is there twice is solid, and so are parts that touch along an edge",
          "[voxelise]") {
  const Model box = box_mesh({0, 0, 0}, {6, 6, 6});
  const auto twice = voxel_grid(joined({box, box}), solid_options());
  REQUIRE(twice.has_value());
  CHECK(twice->result.closure == MeshClosure::open);
  CHECK(twice->result.rule == SolidRule::winding);
  CHECK(twice->result.voxels == 216);
  CHECK(voxels_of(joined({box, box_mesh({6, 6, 0}, {12, 12, 6})}), solid_options()) == 432);
}

TEST_CASE("overlapping parts are hollow by parity and full on request", "[voxelise]") {
  const Model boxes = joined({box_mesh({0, 0, 0}, {6, 6, 6}), box_mesh({4, 0, 0}, {10, 6, 6})});
  CHECK(voxels_of(boxes, solid_options()) == 2 * 216 - 2 * 72);
  VoxeliseOptions filled = solid_options();
  filled.fills_overlaps = true;
  CHECK(voxels_of(boxes, filled) == 2 * 216 - 72);
}

TEST_CASE("an open hemisphere is solid below its rim", "[voxelise]") {
  Model half = icosphere({20, 20, 20}, 16, 3);
  std::erase_if(half.triangles, [&](const auto& t) {
    return std::any_of(t.begin(), t.end(), [&](auto v) { return half.positions[v][1] > 20.01F; });
  });
  const auto grid = voxel_grid(half, solid_options());
  REQUIRE(grid.has_value());
  CHECK(grid->result.closure == MeshClosure::open);
  CHECK(grid->result.rule == SolidRule::winding);
  // The winding number is a half at a slightly curved lid.
  const double volume = 2.0 / 3 * 3.14159265 * 16 * 16 * 16;
  CHECK(static_cast<double>(grid->result.voxels) > 0.8 * volume);
  CHECK(static_cast<double>(grid->result.voxels) < 1.05 * volume);
  CHECK(grid->at({16, 3, 16}) != kEmpty);
}

TEST_CASE("a T-junction closes the solid although the mesh is open", "[voxelise]") {
  Model mesh = box_mesh({0, 0, 0}, {8, 8, 8});
  // The edge between two faces gets a vertex on one side only.
  mesh.positions.push_back({8, 4, 8});
  mesh.triangles.back() = {1, 8, 5};  // was {1, 7, 5}
  mesh.triangles.push_back({1, 7, 8});
  const auto grid = voxel_grid(mesh, solid_options());
  REQUIRE(grid.has_value());
  CHECK(grid->result.rule == SolidRule::winding);
  CHECK(grid->result.voxels == 512);
}

TEST_CASE("a thin surface beside a closed solid adds walls and no thickness", "[voxelise]") {
  VoxeliseOptions both = solid_options();
  both.surface = SurfaceMode::separating_6;
  // The far sides end before centres, and behind them.
  for (const float side : {9.0F, 9.3F, 9.5F, 9.7F}) {
    CAPTURE(side);
    const Model box = box_mesh({0, 0, 0}, {side, side, side});
    CHECK(voxels_of(box, both) == voxels_of(box, solid_options()));
  }
  // Walls without a centre inside stay, also at the borders of beams.
  for (const float at : {3.1F, 63.6F, 64.1F, 64.4F}) {
    CAPTURE(at);
    for (unsigned axis = 0; axis < 3; ++axis) {
      Place low{0, 0, 0}, high{70, 66, 66};
      low[axis] = at;
      high[axis] = at + 0.05F;
      const Model corners =
          joined({box_mesh({0, 0, 0}, {1, 1, 1}), box_mesh({69, 65, 65}, {70, 66, 66})});
      const Model wall = joined({corners, box_mesh(low, high)});
      const std::uint64_t area = axis == 0 ? 66 * 66 : 70 * 66;
      const std::uint64_t voxels = voxels_of(wall, both);
      CHECK(voxels >= area);
      CHECK(voxels <= area + 2);
    }
  }
  SplitMix64 rng{4820};
  int closed = 0;
  for (int round = 0; round < 40; ++round) {
    CAPTURE(round);
    const Model mesh = random_closed_mesh(rng, 10 + static_cast<int>(rng.below(14)));
    const VoxelOracle oracle(mesh, 1);
    const auto grid = voxel_grid(mesh, both);
    REQUIRE(grid.has_value());
    if (grid->result.closure == MeshClosure::open) continue;  // vertices fell together
    ++closed;
    std::size_t faults = 0;
    grid->for_each([&](VoxelPos p, Material material) {
      const bool wanted = oracle.is_inside(p) || oracle.is_wall(p);
      faults += (material != kEmpty) != wanted;
    });
    CHECK(faults == 0);
  }
  CHECK(closed >= 30);
}

TEST_CASE("surfaces are as thick as their mode says", "[voxelise]") {
  const Model box = box_mesh({0, 0, 0}, {10, 10, 10});
  const std::uint64_t shell = 1000 - 512;
  for (const SurfaceMode mode :
       {SurfaceMode::conservative, SurfaceMode::separating_26, SurfaceMode::separating_6}) {
    CAPTURE(static_cast<int>(mode));
    CHECK(voxels_of(box, surface_options(mode)) == shell);
  }
  // A face between voxels, in the middle of the box.
  const Model wall = joined({box_mesh({0, 0, 0}, {1, 1, 1}), box_mesh({4, 0, 0}, {4, 9, 9}),
                             box_mesh({8, 8, 8}, {9, 9, 9})});
  const auto conservative = voxel_grid(wall, surface_options(SurfaceMode::conservative));
  const auto thin = voxel_grid(wall, surface_options(SurfaceMode::separating_6));
  REQUIRE(conservative.has_value());
  REQUIRE(thin.has_value());
  CHECK(conservative->at({3, 5, 5}) != kEmpty);
  CHECK(conservative->at({4, 5, 5}) != kEmpty);
  CHECK(thin->at({3, 5, 5}) == kEmpty);
  CHECK(thin->at({4, 5, 5}) != kEmpty);
}

TEST_CASE("no path by corners leaves a 26-separating sphere", "[voxelise]") {
  const Model sphere = icosphere({12, 12, 12}, 11.3F, 3);
  const auto grid = voxel_grid(sphere, surface_options(SurfaceMode::separating_26));
  REQUIRE(grid.has_value());
  std::set<VoxelPos> seen{{11, 11, 11}};
  std::vector<VoxelPos> open(seen.begin(), seen.end());
  const VoxelPos s = grid->result.sides;
  bool is_out = false;
  while (!open.empty()) {
    const VoxelPos p = open.back();
    open.pop_back();
    for (int step = 0; step < 27; ++step) {
      const VoxelPos q{p.x + step % 3 - 1, p.y + step / 3 % 3 - 1, p.z + step / 9 - 1};
      if (q.x < 0 || q.y < 0 || q.z < 0 || q.x >= s.x || q.y >= s.y || q.z >= s.z) {
        is_out = true;
      } else if (grid->at(q) == kEmpty && seen.insert(q).second) {
        open.push_back(q);
      }
    }
  }
  CHECK_FALSE(is_out);
  CHECK(seen.size() > 2'000);
}

TEST_CASE("the longest side and the turn decide the box", "[voxelise]") {
  Model box = box_mesh({-1, 2, 3}, {1, 3, 8});
  VoxeliseOptions options;
  options.scale.longest_side = 100;
  auto grid = voxel_grid(box, options);
  REQUIRE(grid.has_value());
  CHECK(grid->result.sides == VoxelPos{40, 20, 100});
  CHECK(grid->result.voxels == 40 * 20 * 100);
  options.turn = Orientation{}.rotated_about_y(1);
  // A corner is cut off, so that the turn can be seen.
  box.positions[7] = {0, 3, 8};
  grid = voxel_grid(box, options);
  REQUIRE(grid.has_value());
  CHECK(grid->result.sides == VoxelPos{100, 20, 40});
  options.turn = {};
  const auto plain = voxel_grid(box, options);
  REQUIRE(plain.has_value());
  // +z turns to +x, and +x to -z.
  bool equal = true;
  std::size_t differ = 0;
  grid->for_each([&](VoxelPos p, Material material) {
    if (material != plain->at({39 - p.z, p.y, p.x})) ++differ;
    equal = equal && material == grid->at(p);
  });
  // Centres on the cut are moved in another direction.
  CHECK(equal);
  CHECK(differ <= 100 * 20);
  CHECK(plain->result.voxels < 40 * 20 * 100);
}

TEST_CASE("several threads make the same pieces", "[voxelise]") {
  const Model mesh = material_mesh(statue_mesh(5'000), {10, 20, 30, 255});
  VoxeliseOptions options;
  options.scale.longest_side = 150;
  const auto one = voxel_grid(mesh, options);
  const ParallelFor threads = [](std::size_t count, const std::function<void(std::size_t)>& f) {
    std::vector<std::thread> all;
    for (std::size_t i = 0; i < count; ++i) all.emplace_back(f, i);
    for (std::thread& thread : all) thread.join();
  };
  const auto many = voxel_grid(mesh, options, threads);
  REQUIRE(one.has_value());
  REQUIRE(many.has_value());
  CHECK(one->cells == many->cells);
  Model open = mesh;
  open.triangles.resize(open.triangles.size() / 2);
  open.material_of.resize(open.triangles.size());
  const auto one_open = voxel_grid(open, options);
  const auto many_open = voxel_grid(open, options, threads);
  REQUIRE(one_open.has_value());
  REQUIRE(many_open.has_value());
  CHECK(one_open->cells == many_open->cells);
}

TEST_CASE("bad options and models are refused with the limit", "[voxelise]") {
  const Model box = box_mesh({0, 0, 0}, {1, 1, 1});
  const auto sink = [](VoxelPiece&&) -> Result<void> { return {}; };
  const auto error_of = [&](const Model& model, auto&& change) {
    VoxeliseOptions options = solid_options();
    change(options);
    const auto done = voxelise(model, options, sink);
    REQUIRE_FALSE(done.has_value());
    return done.error();
  };
  const auto nothing = [](VoxeliseOptions&) {};
  CHECK(error_of(box, [](auto& o) { o.scale = {}; }).code == ErrorCode::bad_value);
  CHECK(error_of(box, [](auto& o) { o.scale = {10, 1}; }).code == ErrorCode::bad_value);
  CHECK(error_of(box, [](auto& o) { o.scale = {4097, 0}; }).code == ErrorCode::limit_exceeded);
  CHECK(error_of(box, [](auto& o) { o.scale = {0, 4097}; }).code == ErrorCode::limit_exceeded);
  CHECK(error_of(box, [](auto& o) { o.scale = {0, -1}; }).code == ErrorCode::bad_value);
  CHECK(error_of(box, [](auto& o) {
          o.scale = {0, std::numeric_limits<double>::infinity()};
        }).code == ErrorCode::bad_value);
  CHECK(error_of(box, [](auto& o) { o.colours_max = 0; }).code == ErrorCode::bad_value);
  CHECK(error_of(box, [](auto& o) { o.colours_max = 1025; }).code == ErrorCode::bad_value);
  CHECK(error_of(box, [](auto& o) { o.point_radius = std::nan(""); }).code == ErrorCode::bad_value);
  CHECK(error_of(box, [](auto& o) { o.is_solid = false; }).code == ErrorCode::bad_value);
  CHECK(error_of(box, [](auto& o) { o.turn.flips = 9; }).code == ErrorCode::bad_value);
  Model bad = box;
  bad.positions[3][1] = std::numeric_limits<float>::quiet_NaN();
  CHECK(error_of(bad, nothing).code == ErrorCode::bad_value);
  CHECK(error_of(Model{}, nothing).code == ErrorCode::bad_value);
  // The error of the sink ends it.
  const auto stopped = voxelise(box, solid_options(), [](VoxelPiece&&) -> Result<void> {
    return fail(ErrorCode::io_failed, "full");
  });
  REQUIRE_FALSE(stopped.has_value());
  CHECK(stopped.error().code == ErrorCode::io_failed);
}

TEST_CASE("extreme coordinates and models without a length are voxels, too", "[voxelise]") {
  VoxeliseOptions options;
  options.scale.longest_side = 16;
  const float huge = std::numeric_limits<float>::max();
  CHECK(voxels_of(box_mesh({-huge, -huge, -huge}, {huge, huge, huge}), options) == 4096);
  const float tiny = std::numeric_limits<float>::denorm_min();
  CHECK(voxels_of(box_mesh({0, 0, 0}, {tiny, tiny, tiny}), options) == 4096);
  Model point;
  point.positions = {{5, 5, 5}};
  point.triangles = {{0, 0, 0}};
  CHECK(voxels_of(point, options) == 0);
  options.surface = SurfaceMode::conservative;
  CHECK(voxels_of(point, options) == 1);
  // A vertex of no triangle does not count for the box.
  Model box = box_mesh({0, 0, 0}, {1, 1, 1});
  box.positions.push_back({1e30F, 0, 0});
  CHECK(voxels_of(as_soup(box), options) == 4096);
  box.triangles.pop_back();
  const auto open = voxel_grid(box, options);
  REQUIRE(open.has_value());
  CHECK(open->result.sides == VoxelPos{16, 16, 16});
}

TEST_CASE("the longest box has the largest coordinates", "[voxelise]") {
  VoxeliseOptions options;
  options.scale.longest_side = 4096;
  // Long and thin, so that the grid of the test stays small. The numbers are as large as they
  // become.
  Model tetrahedron;
  tetrahedron.positions = {{0, 0, 0}, {4096, 3, 1}, {4095, 0, 5}, {1, 5, 4}};
  tetrahedron.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  for (const AxisOrder axes : {AxisOrder::xyz, AxisOrder::yzx, AxisOrder::zxy}) {
    options.turn = {axes, 0};
    for (const SurfaceMode mode : {SurfaceMode::none, SurfaceMode::conservative}) {
      options.surface = mode;
      const auto grid = voxel_grid(tetrahedron, options);
      REQUIRE(grid.has_value());
      Model turned = tetrahedron;
      for (Place& p : turned.positions) {
        const Place from = p;
        for (std::size_t i = 0; i < 3; ++i)
          p[i] = from[static_cast<std::size_t>(options.turn.along(static_cast<Axis>(i)))];
      }
      const VoxelOracle oracle(turned, 1);
      REQUIRE(grid->result.sides == oracle.sides());
      std::size_t differ = 0;
      grid->for_each([&](VoxelPos p, Material material) {
        const bool wanted =
            oracle.is_inside(p) || (mode != SurfaceMode::none && oracle.is_surface(p, mode));
        if ((material != kEmpty) != wanted) ++differ;
      });
      CHECK(differ == 0);
    }
  }
}

TEST_CASE("very many triangles one behind another are refused before they take much memory",
          "[voxelise]") {
  // Each of them covers a half of the side of the beam.
  Model wall;
  wall.positions = {{0, 0, 0}, {0, 64, 0}, {0, 64, 64}, {0, 0, 64}, {64, 0, 0}};
  for (int i = 0; i < 20'000; ++i) {
    wall.triangles.push_back({0, 1, 2});
    wall.triangles.push_back({0, 2, 1});
  }
  wall.triangles.push_back({0, 1, 4});
  VoxeliseOptions options;
  options.scale.longest_side = 64;
  const auto build = voxel_build(wall, options);
  REQUIRE_FALSE(build.has_value());
  CHECK(build.error().code == ErrorCode::limit_exceeded);
  CHECK(std::string(build.error().what).find("one behind another") != std::string::npos);
}

TEST_CASE("the voxeliser ends when its result is not wanted any more", "[voxelise]") {
  VoxeliseOptions options;
  options.scale.longest_side = 64;
  options.should_continue = [] { return false; };
  const auto build = voxel_build(box_mesh({0, 0, 0}, {1, 1, 1}), options);
  REQUIRE_FALSE(build.has_value());
  CHECK(build.error().code == ErrorCode::io_failed);
}

}  // namespace runstone::test
