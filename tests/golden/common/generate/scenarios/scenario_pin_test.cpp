// The scenarios as worlds that a server can host: equal pins give equal voxels.
#include <catch2/catch.hpp>
#include <string>

#include "common/generate/generator.hpp"

namespace runstone::test {
namespace {

/// Returns one digest over the models of all scenarios at one edge.
std::string digest_at(std::int32_t edge) {
  Digest sum;
  for (std::int32_t number = 1; number <= 37; ++number) {
    if (number == 5) continue;
    const std::string parameters =
        "number = " + std::to_string(number) + "\nedge = " + std::to_string(edge) + "\n";
    const auto world = make_generator({"scenario", 1, 0, parameters}, default_material_table());
    REQUIRE(world.has_value());
    const RunChunk chunk = (*world)->generate({0, 0, 0}, Extent::cube(static_cast<unsigned>(edge)));
    sum = sum + world_digest_term({0, {number, edge, 0}}, digest_of(chunk));
  }
  return to_hex(sum);
}

TEST_CASE("scenario version 1 gives the pinned voxels", "[generate][scenarios][golden]") {
  CHECK(digest_at(8) == "0226287d0f8bb4ca00d9c9ff8e431c59");
  CHECK(digest_at(32) == "101d016ca93acdb305cf90dc85bd0e6b");
  CHECK(digest_at(128) == "1ebb28f1ac5f92640a801d871496fa82");
}

}  // namespace
}  // namespace runstone::test
