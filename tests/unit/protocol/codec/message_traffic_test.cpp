#include "protocol/codec/message_traffic.hpp"

#include <catch2/catch.hpp>

namespace runstone::test {

TEST_CASE("the traffic of a class is the sum over its kinds of messages", "[protocol]") {
  Traffic traffic{};
  traffic[Message(Commit{}).index()] = {2, 300, 3};
  traffic[Message(Durable{}).index()] = {1, 20, 1};
  traffic[Message(Ping{}).index()] = {5, 50, 5};
  CHECK(of_class(traffic, FrameClass::edits) == KindTraffic{3, 320, 4});
  CHECK(of_class(traffic, FrameClass::control) == KindTraffic{5, 50, 5});
  CHECK(of_class(traffic, FrameClass::chunks) == KindTraffic{});
}

}  // namespace runstone::test
