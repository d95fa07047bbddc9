#include "server/map/map_png.hpp"

#include <catch2/catch.hpp>
#include <vector>

#include "common/core/hash.hpp"
#include "tests/unit/server/map/png_pixels.hpp"

using namespace runstone;

TEST_CASE("pictures of few and of many colours come back as they were", "[map]") {
  SplitMix64 rng{Catch::rngSeed()};
  for (const std::uint32_t colours : {1U, 2U, 255U, 256U, 257U, 4'000U}) {
    constexpr std::int32_t kPictureSide = 80;
    std::vector<std::uint32_t> palette;
    for (std::uint32_t i = 0; i < colours; ++i)
      palette.push_back(static_cast<std::uint32_t>(rng.next()) | 0xFF000000U);
    palette[0] = 0;
    std::vector<std::uint32_t> pixels;
    for (std::int32_t i = 0; i < kPictureSide * kPictureSide; ++i)
      pixels.push_back(palette[static_cast<std::size_t>(i) % colours]);
    CAPTURE(Catch::rngSeed(), colours);
    const std::string png = png_of(pixels, kPictureSide);
    REQUIRE(test::pixels_of(png) == pixels);
    CHECK((png.find("PLTE") != std::string::npos) == (colours <= 256));
  }
}
