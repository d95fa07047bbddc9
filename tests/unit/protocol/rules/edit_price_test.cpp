#include "protocol/rules/edit_price.hpp"

#include <catch2/catch.hpp>

#include "protocol/limits.hpp"

namespace runstone {
namespace {

std::uint64_t price(const EditShape& shape, const EditBudget& budget = {}) {
  return edit_price({shape, {}, std::holds_alternative<Paste>(shape) ? kEmpty : Material{1}}, 16,
                    budget);
}

TEST_CASE("an edit costs a unit for each chunk that its box touches", "[rules]") {
  CHECK(price(SetVoxel{{1, 1, 1}}) == 1);
  CHECK(price(FillSphere{{0, 0, 0}, 3}) == 8);
  CHECK(price(FillSphere{{8, 8, 8}, 60}) == 9 * 9 * 9);
  FillStroke scribble;  // many points, all in one chunk
  scribble.radius = 1;
  for (std::int32_t i = 0; i < 100; ++i) scribble.points.push_back({4 + i % 2, 4 + i % 3, 4});
  CHECK(price(scribble) == 1);
  CHECK(price(FillBox{{{0, 0, 0}, {4096, 4096, 4096}}}) == kTouchedChunksMax);
}

TEST_CASE("a paste costs more for each started 512 bytes of its clipboard", "[rules]") {
  const auto paste = [](std::uint32_t runs) {
    ClipboardBuilder cells({128, 1, 128});
    for (std::uint32_t i = 0; i < runs; ++i) cells.append(1, static_cast<Material>(1 + i % 2));
    cells.append(128 * 128 - runs, std::nullopt);
    return Paste{{0, 0, 0}, *cells.finish(), {}};
  };
  for (const std::uint32_t runs : {1u, 100u, 3'000u}) {
    const Paste shape = paste(runs);
    const EditDescriptor edit{shape, {}, kEmpty};
    const std::uint64_t chunks = edit_price({FillBox{{{0, 0, 0}, {128, 1, 128}}}, {}, 1}, 16, {});
    const std::size_t bytes = shape.clipboard->byte_size();
    CHECK(price(shape) <= chunks + (bytes + 511) / 512);
    CHECK(price(shape) > (bytes - 1) / 512);
    const std::uint64_t before = edit_price(edit, 16, {}, EditPrices::kClipboardBytesBefore);
    CHECK(before - price(shape) == (bytes + 63) / 64 - (bytes + 511) / 512);
  }
}

TEST_CASE("the normal budget carries a town of 200 x 100 x 200 voxels in a minute", "[rules]") {
  // Eight KB a chunk is twice what dense ground of real worlds takes.
  constexpr std::uint64_t kChunks = 8 * 5 * 8, kBytes = 8 * 1024;
  constexpr std::uint64_t kPrice =
      kChunks * (EditPrices::kChunk + kBytes / EditPrices::kClipboardBytes);
  constexpr std::uint64_t kPerSecond = 100, kBurst = 4'000;
  STATIC_REQUIRE(kPrice <= kBurst + 60 * kPerSecond);
}

TEST_CASE("an edit costs at most the whole budget", "[rules]") {
  CHECK(price(FillSphere{{8, 8, 8}, 60}, {10, 100}) == 100);
  CHECK(price(SetVoxel{{1, 1, 1}}, {10, 100}) == 1);
}

}  // namespace
}  // namespace runstone
