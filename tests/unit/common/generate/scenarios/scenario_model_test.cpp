#include "common/generate/scenarios/scenario_model.hpp"

#include <catch2/catch.hpp>

#include "common/generate/scenarios/scenario_world.hpp"
#include "common/runs/dense.hpp"
#include "tests/support/scenarios/scenario_oracle.hpp"

namespace runstone::test {
namespace {

TEST_CASE("every scenario at every edge is its formula, voxel by voxel", "[generate][scenarios]") {
  for (const unsigned edge : {8u, 16u, 32u, 64u, 128u}) {
    for (unsigned number = 1; number <= kScenarioCount; ++number) {
      if (number == 5) continue;
      const auto model = scenario_model(number, edge);
      REQUIRE(model.has_value());
      const RunChunk chunk = scenario_chunk(*model, 1);
      CAPTURE(number, edge);
      REQUIRE(validate(chunk).has_value());
      const auto difference = first_difference(DenseChunk::of(chunk), scenario_dense(number, edge));
      if (difference) {
        CAPTURE(difference->x, difference->y, difference->z);
        FAIL("another voxel than the formula's");
      }
    }
  }
}

TEST_CASE("a model is made as runs, never through a grid", "[generate][scenarios]") {
  const std::uint64_t before = dense_expansions();
  for (unsigned number = 1; number <= kScenarioCount; ++number) {
    if (const auto model = scenario_model(number, 32)) scenario_chunk(*model, 1);
  }
  CHECK(dense_expansions() == before);
}

TEST_CASE(
    "the sums of sines differ from zero by enough that every maths library makes the same world",
    "[generate][scenarios]") {
  CHECK(smallest_wave_sum() > 1e-9);
}

TEST_CASE("scenarios without a formula and edges without a scenario are rejected",
          "[generate][scenarios]") {
  for (const unsigned number : {0u, 5u, 38u, 1000u}) {
    const auto model = scenario_model(number, 32);
    REQUIRE_FALSE(model.has_value());
    CHECK(model.error().code == ErrorCode::not_found);
  }
  for (const unsigned edge : {0u, 4u, 12u, 31u, 33u, 256u}) {
    const auto model = scenario_model(1, edge);
    REQUIRE_FALSE(model.has_value());
    CHECK(model.error().code == ErrorCode::bad_value);
  }
}

}  // namespace
}  // namespace runstone::test
