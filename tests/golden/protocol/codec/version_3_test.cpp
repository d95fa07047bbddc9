#include <catch2/catch.hpp>

#include "protocol/codec/messages.hpp"
#include "protocol/limits.hpp"

// The additions of version 3 of the protocol. They may change until version 3 is released.
namespace runstone::test {

TEST_CASE("the features of version 3 have their numbers", "[protocol][golden]") {
  CHECK(kFeatureTimeCorrections == 1 << 14);
  CHECK(kFeatureLargeActions == 1 << 15);
}

TEST_CASE("the reasons of version 3 have their numbers", "[protocol][golden]") {
  CHECK(static_cast<int>(RejectReason::unknown_action) == 10);
  CHECK(static_cast<int>(RejectReason::action_ended) == 11);
}

}  // namespace runstone::test
