#include "protocol/codec/commit_encoder.hpp"

#include <catch2/catch.hpp>

#include "tests/support/codec/random_message.hpp"

namespace runstone::test {

TEST_CASE("a message with some edits of a commit is the message of a commit with those edits",
          "[protocol][property]") {
  SplitMix64 rng{Catch::rngSeed() + 24};
  for (int step = 0; step < 300; ++step) {
    CAPTURE(Catch::rngSeed(), step);
    const Commit whole = random_message<Commit>(rng);
    Commit part{whole.epoch, {}};
    std::vector<std::uint32_t> edits;
    for (std::uint32_t i = 0; i < whole.edits.size(); ++i) {
      if (rng.below(2) == 0 && !(edits.empty() && i + 1 == whole.edits.size())) continue;
      edits.push_back(i);
      part.edits.push_back(whole.edits[i]);
    }
    const EncodedMessage message = encode_message(CommitEncoder(whole), edits);
    CHECK(*message.bytes == *encode_message(part).bytes);
    const auto decoded =
        decode_message(Sender::server, kKindOf<Commit>, *message.bytes, kMessageEdge);
    REQUIRE(decoded.has_value());
    CHECK(std::get<Commit>(*decoded) == part);
  }
}

}  // namespace runstone::test
