#include <catch2/catch.hpp>
#include <vector>

#include "protocol/codec/chunk_entries.hpp"
#include "protocol/codec/message_table.hpp"

namespace runstone {
namespace {

ChunkEntry plain_entry(std::int32_t x, std::size_t bytes, std::size_t runs = 1) {
  return {{0, {x, 0, 0}}, std::make_shared<const Bytes>(bytes, std::uint8_t{1}), runs};
}

}  // namespace

TEST_CASE("chunks join one message until it is long, or they are the same chunk", "[protocol]") {
  ChunksBuilder builder;
  CHECK(builder.empty());
  const ChunkEntry huge = plain_entry(0, 100'000, 1'000'000);
  CHECK(builder.fits(huge));  // alone, any chunk fits
  SECTION("bytes") {
    builder.add(plain_entry(0, 4'000));
    CHECK(builder.fits(plain_entry(1, 96)));
    CHECK_FALSE(builder.fits(plain_entry(1, 97)));
  }
  SECTION("runs") {
    builder.add(plain_entry(0, 10, kRunsPerMessageMax - 5));
    CHECK(builder.fits(plain_entry(1, 10, 5)));
    CHECK_FALSE(builder.fits(plain_entry(1, 10, 6)));
  }
  SECTION("a huge chunk has no company") {
    builder.add(huge);
    CHECK_FALSE(builder.fits(plain_entry(1, 1, 0)));
  }
  SECTION("count") {
    for (std::int32_t x = 0; x < static_cast<std::int32_t>(kChunksPerMessageMax); ++x) {
      REQUIRE(builder.fits(plain_entry(x, 1, 0)));
      builder.add(plain_entry(x, 1, 0));
    }
    CHECK_FALSE(builder.fits(plain_entry(-1, 1, 0)));
  }
  SECTION("the same chunk") {
    builder.add(plain_entry(3, 10));
    builder.add(plain_entry(2, 10));
    CHECK_FALSE(builder.fits(plain_entry(3, 10)));
    CHECK(builder.fits(plain_entry(4, 10)));
  }
}

TEST_CASE("a message ascends by key however its chunks were added, and the next one is empty",
          "[protocol]") {
  ChunksBuilder builder;
  std::vector<ChunkEntry> sorted;
  for (const std::int32_t x : {-9, -1, 4, 70}) sorted.push_back(plain_entry(x, 20));
  for (const std::size_t i : {2u, 0u, 3u, 1u}) builder.add(sorted[i]);
  const EncodedMessage message = builder.take(8);
  CHECK(message.kind == kKindOf<Chunks>);
  CHECK(*message.bytes == *join_entries(8, sorted).bytes);
  CHECK(builder.empty());
  CHECK(builder.fits(sorted[0]));
}

}  // namespace runstone
