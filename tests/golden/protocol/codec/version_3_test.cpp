#include <catch2/catch.hpp>

#include "protocol/limits.hpp"

// The additions of version 3 of the protocol. They may change until version 3 is released.
namespace runstone::test {

TEST_CASE("the features of version 3 have their numbers", "[protocol][golden]") {
  CHECK(kFeatureTimeCorrections == 1 << 14);
  CHECK(kFeatureLibrary == 1 << 16);
}

}  // namespace runstone::test
