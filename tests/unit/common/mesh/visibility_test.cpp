#include "common/mesh/visibility.hpp"

#include <catch2/catch.hpp>

#include "tests/support/mesh/mesh_scene.hpp"

namespace runstone::test {
namespace {

TEST_CASE("a face is drawn towards everything that is neither opaque nor the same", "[mesh]") {
  const VisibilityTable& v = mesh_visibility();
  CHECK(v.face_drawn(kStone, kEmpty));
  CHECK(v.face_drawn(kStone, kWater));
  CHECK(v.face_drawn(kWater, kEmpty));
  CHECK(v.face_drawn(kWater, kGlass));
  CHECK(v.face_drawn(kGlass, kWater));
  CHECK(v.face_drawn(kStone, kBarrier));
  CHECK_FALSE(v.face_drawn(kStone, kStone));
  CHECK_FALSE(v.face_drawn(kStone, kDirt));
  CHECK_FALSE(v.face_drawn(kWater, kWater));
  CHECK_FALSE(v.face_drawn(kWater, kStone));
  CHECK_FALSE(v.face_drawn(kEmpty, kEmpty));
  CHECK_FALSE(v.face_drawn(kEmpty, kWater));
  CHECK_FALSE(v.face_drawn(kBarrier, kEmpty));
  CHECK_FALSE(v.face_drawn(kEmpty, kBarrier));
}

TEST_CASE("materials beyond the table count as opaque and air as empty", "[mesh]") {
  CHECK(mesh_visibility()[kMeshMaterialCount] == Visibility::opaque);
  CHECK(mesh_visibility()[65535] == Visibility::opaque);
  CHECK(mesh_visibility()[kEmpty] == Visibility::empty);
}

}  // namespace
}  // namespace runstone::test
