#include <catch2/catch.hpp>

#include "protocol/limits.hpp"

// What version 3 of the protocol adds. It may change until the release.
namespace runstone::test {

TEST_CASE("the features of version 3 have their numbers", "[protocol][golden]") {
  CHECK(kFeatureTimeCorrections == 1 << 14);
}

}  // namespace runstone::test
