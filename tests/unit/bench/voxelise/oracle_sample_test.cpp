#include "bench/voxelise/oracle_sample.hpp"

#include <catch2/catch.hpp>

#include "tests/support/voxelise/meshes.hpp"

using namespace runstone;
using namespace runstone::bench;

namespace {

constexpr std::uint32_t kSampledSide = 70;

std::size_t differing(OracleSample& sample, const Model& mesh, OracleShape shape,
                      const VoxeliseOptions& options) {
  sample.begin();
  REQUIRE(voxelise(mesh, options, [&](VoxelPiece&& piece) -> Result<void> {
            sample.take(piece);
            return {};
          }).has_value());
  return sample.differing(shape);
}

VoxeliseOptions sampled_options(OracleShape shape) {
  VoxeliseOptions out;
  out.scale.longest_side = kSampledSide;
  out.is_solid = shape == OracleShape::none;
  out.surface = shape;
  return out;
}

}  // namespace

TEST_CASE("sampled voxels of solids and surfaces equal the oracle", "[bench][voxelise]") {
  const Model mesh = test::statue_mesh(500);
  OracleSample sample(mesh, kSampledSide, 2'000);
  CHECK(sample.count() == 2'000);
  for (const OracleShape shape : {OracleShape::none, OracleShape::conservative,
                                  OracleShape::separating_26, OracleShape::separating_6}) {
    CAPTURE(static_cast<int>(shape));
    CHECK(differing(sample, mesh, shape, sampled_options(shape)) == 0);
  }
}

TEST_CASE("a sample finds voxels that are missing, too many, or of another shape",
          "[bench][voxelise]") {
  const Model mesh = test::statue_mesh(500);
  OracleSample sample(mesh, kSampledSide, 2'000);
  sample.begin();
  CHECK(sample.differing(OracleShape::none) > 100);  // no piece came
  const auto solid = sampled_options(OracleShape::none);
  const auto all = sampled_options(OracleShape::conservative);
  CHECK(differing(sample, mesh, OracleShape::conservative, solid) > 100);
  CHECK(differing(sample, mesh, OracleShape::none, all) > 100);
  CHECK(differing(sample, mesh, OracleShape::separating_6, all) > 10);
  Model moved = mesh;
  for (auto& position : moved.positions) position[0] *= 0.97F;
  CHECK(differing(sample, moved, OracleShape::none, solid) > 1);
}
