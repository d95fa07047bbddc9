#include <catch2/catch.hpp>

#include "common/runs/run_chunk.hpp"

// The check values of docs/protocol.md, computed from its formulas by another program. Peers
// compare digests, so they are part of the protocol.
namespace runstone::test {

TEST_CASE("digests are those of the protocol page", "[protocol][golden]") {
  CHECK(to_hex(digest_of_box(5, {1, 2, 3}, {2, 3, 4})) == "0069dc56400ee14910daa3fdf341b709");
  const Digest uniform = digest_of(uniform_chunk(Extent::cube(32), 1));
  CHECK(to_hex(uniform) == "1d097e98f4fc282407cd14195a2e2b9a");
  CHECK(to_hex(world_digest_term({0, {1, -2, 3}}, uniform)) == "029aeff7a3421dd30cb9173b3bc84bcf");
}

}  // namespace runstone::test
