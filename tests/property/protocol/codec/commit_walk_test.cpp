// Compares the walk over a commit with the decoder that makes a struct: both must have the same
// result on every input.
#include "protocol/codec/commit_walk.hpp"

#include <catch2/catch.hpp>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "tests/support/codec/random_message.hpp"

namespace runstone::test {
namespace {

/// Walks the bytes and collects the edits.
Result<Message> walked(ByteView bytes) {
  CommitWalk walk;
  Commit commit;
  const auto is_valid = walk.read(bytes, kMessageEdge, [&](const WalkedEdit& edit) -> Result<void> {
    if (commit.edits.empty()) commit.epoch = edit.version.epoch;
    CHECK(edit.version == Version{commit.epoch, edit.ordered.seq});
    CHECK(std::vector<ChunkCoord>(edit.chunks.begin(), edit.chunks.end()) ==
          touched_chunks(edit.ordered.edit, kMessageEdge));
    commit.edits.push_back(edit.ordered);
    return {};
  });
  if (!is_valid) return failure(is_valid.error());
  return Message{std::move(commit)};
}

}  // namespace

TEST_CASE("a walk delivers the edits that the decoder finds", "[protocol][property]") {
  SplitMix64 rng{Catch::rngSeed() + 20};
  for (int step = 0; step < 100; ++step) {
    CAPTURE(Catch::rngSeed(), step);
    const Message message = random_message<Commit>(rng);
    const auto got = walked(*encode_message(message).bytes);
    REQUIRE(got.has_value());
    CHECK(*got == message);
  }
}

TEST_CASE("a walk refuses what the decoder refuses", "[protocol][property]") {
  SplitMix64 rng{Catch::rngSeed() + 21};
  int refused = 0;
  for (int step = 0; step < 3'000; ++step) {
    CAPTURE(Catch::rngSeed(), step);
    Bytes bytes = *encode_message(random_message<Commit>(rng)).bytes;
    const std::uint32_t flips = 1 + rng.below(3);
    for (std::uint32_t i = 0; i < flips; ++i) {
      bytes[rng.below(static_cast<std::uint32_t>(bytes.size()))] ^=
          static_cast<std::uint8_t>(1 + rng.below(255));
    }
    const auto decoded = decode_message(Sender::server, kKindOf<Commit>, bytes, kMessageEdge);
    const auto got = walked(bytes);
    REQUIRE(got.has_value() == decoded.has_value());
    if (decoded) CHECK(*got == *decoded);
    if (!decoded) {
      CHECK(std::string_view(got.error().what) == decoded.error().what);
      ++refused;
    }
  }
  CHECK(refused > 100);
}

TEST_CASE("a commit that is read with the chunk edge is read without it too, with the same edits",
          "[protocol][property]") {
  SplitMix64 rng{Catch::rngSeed() + 23};
  int contradictions = 0;
  for (int step = 0; step < 3'000; ++step) {
    CAPTURE(Catch::rngSeed(), step);
    Bytes bytes = *encode_message(random_message<Commit>(rng)).bytes;
    if (step % 10 != 0) {
      bytes[rng.below(static_cast<std::uint32_t>(bytes.size()))] ^=
          static_cast<std::uint8_t>(1 + rng.below(255));
    }
    const auto with_edge = decode_message(Sender::server, kKindOf<Commit>, bytes, kMessageEdge);
    const auto without = decode_message(Sender::server, kKindOf<Commit>, bytes, 0);
    if (with_edge) {
      REQUIRE(without.has_value());
      REQUIRE(*without == *with_edge);
    } else if (without) {
      ++contradictions;  // only the edge shows that the touched chunks are others
    }
    if (step % 10 == 0) REQUIRE(with_edge.has_value());
  }
  CHECK(contradictions > 10);
}

TEST_CASE("a walk returns an error of its handler", "[protocol][property]") {
  CommitWalk walk;
  SplitMix64 rng{Catch::rngSeed() + 22};
  const auto stopped = walk.read(
      *encode_message(random_message<Commit>(rng)).bytes, kMessageEdge,
      [](const WalkedEdit&) -> Result<void> { return fail(ErrorCode::bad_value, "enough"); });
  REQUIRE_FALSE(stopped.has_value());
  CHECK(std::string_view(stopped.error().what) == "enough");
}

}  // namespace runstone::test
