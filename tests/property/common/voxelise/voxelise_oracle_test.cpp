// Random meshes against an oracle in exact arithmetic. The hidden case [.long] is larger:
// property_common_voxelise "[.long]".
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "common/core/hash.hpp"
#include "common/voxelise/voxelise.hpp"
#include "tests/support/voxelise/meshes.hpp"
#include "tests/support/voxelise/voxel_grid.hpp"
#include "tests/support/voxelise/voxel_oracle.hpp"

namespace runstone::test {
namespace {

VoxeliseOptions options_of(bool is_solid, SurfaceMode surface) {
  VoxeliseOptions out;
  out.scale.voxels_per_unit = 1;
  out.is_solid = is_solid;
  out.surface = surface;
  return out;
}

constexpr std::array<SurfaceMode, 3> kSurfaces{
    SurfaceMode::conservative, SurfaceMode::separating_26, SurfaceMode::separating_6};

/// Compares every voxel of a grid with a rule. Returns the first that differs, or an empty text.
template <class F>
std::string first_difference(const VoxelGrid& grid, F&& rule) {
  std::string out;
  grid.for_each([&](VoxelPos p, Material material) {
    if (out.empty() && (material != kEmpty) != rule(p))
      out = std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) +
            (material != kEmpty ? " is set" : " is not set");
  });
  return out;
}

/// Returns the first two free voxels that share a face and lie on either side of a surface.
std::string first_leak(const VoxelGrid& solid, const VoxelGrid& surface) {
  std::string out;
  const VoxelPos s = solid.result.sides;
  surface.for_each([&](VoxelPos p, Material material) {
    if (material != kEmpty) return;
    for (const VoxelPos q :
         {VoxelPos{p.x + 1, p.y, p.z}, VoxelPos{p.x, p.y + 1, p.z}, VoxelPos{p.x, p.y, p.z + 1}}) {
      if (q.x < s.x && q.y < s.y && q.z < s.z && surface.at(q) == kEmpty &&
          solid.at(q) != solid.at(p) && out.empty())
        out = std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z);
    }
  });
  return out;
}

void compare_closed(const Model& mesh) {
  const VoxelOracle oracle(mesh, 1);
  const auto solid = voxel_grid(mesh, options_of(true, SurfaceMode::none));
  REQUIRE(solid.has_value());
  REQUIRE(solid->result.sides == oracle.sides());
  if (solid->result.rule == SolidRule::parity) {
    REQUIRE(first_difference(*solid, [&](VoxelPos p) { return oracle.is_inside(p); }) == "");
  } else {
    // Snapping joined edges, so that the mesh touches itself.
    REQUIRE(first_difference(*solid, [&](VoxelPos p) { return oracle.crossings(p) != 0; }) == "");
  }
  VoxeliseOptions filled = options_of(true, SurfaceMode::none);
  filled.fills_overlaps = true;
  const auto full = voxel_grid(mesh, filled);
  REQUIRE(full.has_value());
  if (full->result.rule == SolidRule::winding)
    REQUIRE(first_difference(*full, [&](VoxelPos p) { return oracle.crossings(p) != 0; }) == "");
  for (const SurfaceMode mode : kSurfaces) {
    CAPTURE(static_cast<int>(mode));
    const auto surface = voxel_grid(mesh, options_of(false, mode));
    REQUIRE(surface.has_value());
    REQUIRE(first_difference(*surface, [&](VoxelPos p) { return oracle.is_surface(p, mode); }) ==
            "");
    const auto both = voxel_grid(mesh, options_of(true, mode));
    REQUIRE(both.has_value());
    // A thin surface does not make what is closed thicker.
    const bool is_wall =
        mode == SurfaceMode::separating_6 && both->result.rule == SolidRule::parity;
    REQUIRE(first_difference(*both, [&](VoxelPos p) {
              if (solid->at(p) != kEmpty) return true;
              return is_wall ? oracle.is_wall(p) : surface->at(p) != kEmpty;
            }) == "");
    if (mode == SurfaceMode::separating_6) CHECK(first_leak(*solid, *surface) == "");
  }
}

/// Compares the winding rule. Voxels whose number is next to a half are left out.
void compare_open(const Model& mesh) {
  const VoxelOracle oracle(mesh, 1);
  const auto solid = voxel_grid(mesh, options_of(true, SurfaceMode::none));
  REQUIRE(solid.has_value());
  // The triangle that is missing or twice there may be one without area.
  if (solid->result.rule == SolidRule::parity) return;
  REQUIRE(solid->result.closure == MeshClosure::open);
  REQUIRE(first_difference(*solid, [&](VoxelPos p) {
            const auto winding = oracle.winding(p);
            if (!winding || std::abs(std::abs(*winding) - 0.5) < 1e-7)
              return solid->at(p) != kEmpty;
            return std::abs(*winding) > 0.5;
          }) == "");
}

Model with_holes(Model mesh, SplitMix64& rng) {
  const std::uint32_t kind = rng.below(3);
  if (kind == 0) {
    mesh.triangles.erase(
        mesh.triangles.begin(),
        mesh.triangles.begin() + static_cast<std::ptrdiff_t>(1 + mesh.triangles.size() / 3));
  } else if (kind == 1) {
    for (int i = 0; i < 3; ++i)
      mesh.triangles.erase(mesh.triangles.begin() +
                           rng.below(static_cast<std::uint32_t>(mesh.triangles.size())));
  } else {
    mesh.triangles.push_back(mesh.triangles.front());
  }
  return mesh;
}

}  // namespace

TEST_CASE("solids and surfaces of random closed meshes equal an exact oracle",
          "[voxelise][property]") {
  SplitMix64 rng{11 + Catch::rngSeed()};
  for (int round = 0; round < 60; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    compare_closed(random_closed_mesh(rng, 20));
  }
}

TEST_CASE("open meshes are solid where the winding number of all triangles says so",
          "[voxelise][property]") {
  SplitMix64 rng{12 + Catch::rngSeed()};
  for (int round = 0; round < 60; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    compare_open(with_holes(random_closed_mesh(rng, 20), rng));
  }
}

TEST_CASE("a wrong mesh does not equal the oracle", "[voxelise][property]") {
  const Model mesh = icosphere({10, 10, 10}, 9, 2);
  Model wrong = mesh;
  for (Place& p : wrong.positions) p[0] = p[0] > 15 ? p[0] - 0.6F : p[0];
  const VoxelOracle oracle(mesh, 1);
  const auto solid = voxel_grid(wrong, options_of(true, SurfaceMode::none));
  REQUIRE(solid.has_value());
  CHECK(first_difference(*solid, [&](VoxelPos p) { return oracle.is_inside(p); }) != "");
  for (const SurfaceMode mode : kSurfaces) {
    const auto surface = voxel_grid(wrong, options_of(false, mode));
    REQUIRE(surface.has_value());
    CHECK(first_difference(*surface, [&](VoxelPos p) { return oracle.is_surface(p, mode); }) != "");
  }
}

TEST_CASE("200 random meshes of 128 voxels equal an exact oracle", "[.long]") {
  SplitMix64 rng{13 + Catch::rngSeed()};
  for (int round = 0; round < 200; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    const Model mesh = random_closed_mesh(rng, 128);
    compare_closed(mesh);
    if (round % 10 == 0) compare_open(with_holes(mesh, rng));
  }
}

}  // namespace runstone::test
