#include "bench/storage/palette_store.hpp"

#include <catch2/catch.hpp>

using namespace runstone;
using bench::storage::PaletteStore;

TEST_CASE("a section keeps its voxels while its palette grows until it has none", "[storage]") {
  PaletteStore store(uniform_chunk(Extent::cube(16), 3));
  const auto place = [](unsigned i) {
    return LocalPos{static_cast<std::uint8_t>(i % 16), static_cast<std::uint8_t>(i / 16 % 16),
                    static_cast<std::uint8_t>(i / 256)};
  };
  const auto material = [](unsigned i) { return static_cast<Material>(65535 - 97 * i); };
  const auto bytes_at = [&](unsigned materials) {
    std::size_t bytes = 0;
    for (unsigned i = 0; i + 1 < materials; ++i) store.set(place(i), material(i));
    bytes = store.byte_size();
    for (unsigned i = 0; i < 4096; ++i)
      REQUIRE(store.at(place(i)) == (i + 1 < materials ? material(i) : 3));
    return bytes;
  };
  // Longs with 64 / bits numbers each, and a palette of some bytes.
  const std::size_t uniform = bytes_at(1);
  CHECK(uniform < 300);
  const auto grown = [&](unsigned materials) { return bytes_at(materials) - uniform; };
  CHECK(grown(2) / 8 == 4096 / 16 + 2);
  CHECK(grown(16) / 8 < 4096 / 16 + 10);
  CHECK(grown(17) / 8 > 4096 / 12);
  CHECK(grown(256) / 8 < 4096 / 8 + 80);
  // The palette is gone, with its block of 32 bytes.
  const std::size_t direct = 4096 / 4 - 2;
  CHECK(grown(257) / 8 == direct);
  CHECK(grown(600) / 8 == direct);
}
