// The players of a world as a whole; the parts of People have tests of their own.
#include "server/world/people/people.hpp"

#include <catch2/catch.hpp>

#include "tests/unit/server/world/world_bench.hpp"

namespace runstone::test {
namespace {

TEST_CASE("kick closes the sessions of a key or of a range of addresses", "[world]") {
  constexpr AddressBlock home = address_block_v4(0x0a000001),
                         elsewhere = address_block_v4(0x0a000101);
  const PublicKey key = key_pair_of(seed_of(1)).public_key;
  WorldBench bench;
  bench.join(1, 1, 1, home);
  bench.join(2, 1, 2, elsewhere);
  bench.join(3, 2, 1, home);
  CHECK(bench.server.people().kick(key, "go home") == 2);
  CHECK(bench.environment.closed.back().text == "you were kicked: go home");
  CHECK(bench.server.people().kick(AddressRange{home, 64}, "") == 1);
  CHECK(bench.server.session_count() == 0);
}

}  // namespace
}  // namespace runstone::test
