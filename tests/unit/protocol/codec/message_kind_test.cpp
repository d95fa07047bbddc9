#include "protocol/codec/message_kind.hpp"

#include <catch2/catch.hpp>
#include <set>
#include <string>

#include "tests/support/random_message.hpp"

namespace runstone::test {
namespace {

TEST_CASE("bytes of every message tell its kind, and the kind its class", "[protocol]") {
  SplitMix64 rng{Catch::rngSeed()};
  std::set<std::string> names;
  for (MessageKind kind = 0; kind < kMessageKindCount; ++kind) {
    const Message message = random_message(rng, kind);
    CAPTURE(kind);
    CHECK(kind_of(*encode_message(message).bytes) == kind);
    CHECK(class_of_kind(kind) == frame_class_of(message));
    names.insert(name_of_kind(kind));
  }
  CHECK(names.size() == kMessageKindCount);
  CHECK(std::string(name_of_kind(Message(std::in_place_type<Commit>).index())) == "Commit");
  CHECK(std::string(name_of_kind(Message(std::in_place_type<ChunkSnapshot>).index())) == "Chunk");
}

TEST_CASE("traffic of a class is that of its kinds", "[protocol]") {
  Traffic traffic{};
  traffic[Message(Commit{}).index()] = {2, 300, 3};
  traffic[Message(Durable{}).index()] = {1, 20, 1};
  traffic[Message(Ping{}).index()] = {5, 50, 5};
  CHECK(of_class(traffic, FrameClass::edits) == KindTraffic{3, 320, 4});
  CHECK(of_class(traffic, FrameClass::control) == KindTraffic{5, 50, 5});
  CHECK(of_class(traffic, FrameClass::chunks) == KindTraffic{});
}

}  // namespace
}  // namespace runstone::test
