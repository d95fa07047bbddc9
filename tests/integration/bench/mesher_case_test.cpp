// A mesher case returns the mesh that it made.
#include "bench/meshing/mesher_case.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "bench/worlds/measured_worlds.hpp"
#include "bench/worlds/seeded_worlds.hpp"
#include "tests/reference/culled_mesher.hpp"
#include "tests/support/mesh/polygon_checks.hpp"
#include "tests/support/mesh/triangle_oracle.hpp"

using namespace runstone;
using namespace runstone::bench;

TEST_CASE("every mesher case replaces a surface by its last mesh", "[bench]") {
  for (const VoxelWorld& world : seeded_worlds()) {
    for (const Volume& volume : volumes_of(world, 16)) {
      const auto owed = test::expected_faces(volume.scene, seeded_materials());
      reference::Surface surface;
      for (const std::string_view name : mesher_case_names()) {
        CAPTURE(world.name, name);
        const auto mesher_case = make_mesher_case(name, volume, *world.visibility);
        REQUIRE(mesher_case.has_value());
        PhaseTimes phases{};
        mesher_case->mesh(phases);
        surface.quads.emplace_back();  // the remains of another mesh
        surface.triangles.vertices.emplace_back();
        mesher_case->surface(surface);
        CHECK(surface.quads.size() == mesher_case->quads());
        CHECK(surface.triangles.vertices.empty() ==
              (owed.empty() || (name != "monotone" && name != "poly2tri")));
        // They show hidden faces, too.
        if (name == "simple" || name == "rle_rdm" || name == "run_strips_hidden") continue;
        CHECK(test::surface_difference(surface, volume.scene.chunk.extent, seeded_materials(), owed)
                  .value_or("") == "");
      }
    }
  }
}

TEST_CASE("in a real world polygons show the faces that culling shows", "[bench]") {
  const auto worlds =
      MeasuredWorlds::open({"luanti"}, RUNSTONE_SOURCE_DIR "/tests/data/luanti_v7_small");
  REQUIRE(worlds.has_value());
  const MeasuredWorld world = worlds->at_edge(0, 32);
  test::PolygonChecks checks;
  std::vector<Quad> culled;
  std::size_t faces = 0;
  for (std::size_t v = 0; v < world.volumes.size(); ++v) {
    const test::MeshScene& scene = world.volumes[v].scene;
    reference::mesh_culled(test::grid_of(scene), *world.visibility, culled);
    std::vector<test::UnitFace> owed;
    for (const Quad quad : culled) {
      const QuadFields q = unpack(quad);
      owed.push_back({q.x, q.y, q.z, q.direction, q.material});
    }
    faces += owed.size();
    CAPTURE(world.parts[v]);
    // The world's materials have no table here. Materials beyond a table count as opaque, and the
    // faces say which are drawn.
    CHECK(checks.fault(scene, *world.visibility, MaterialTable{}, owed) == "");
  }
  CHECK(faces > 10'000);
}
