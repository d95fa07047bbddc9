#include "client/render/inspection.hpp"

#include <catch2/catch.hpp>
#include <set>

using namespace runstone;

TEST_CASE("the starts of runs are bits in the axis order of the chunk", "[render]") {
  RunChunk chunk = uniform_chunk(Extent::cube(8), kEmpty, AxisOrder::zyx);
  CHECK(run_start_bits(chunk) == [] {
    std::vector<std::uint32_t> words(16);
    words[0] = 1;  // one run over the whole chunk
    return words;
  }());
  fill(chunk, 30, 5, 1);  // crosses lines and the word
  fill(chunk, 511, 1, 2);
  const std::vector<std::uint32_t> words = run_start_bits(chunk);
  std::set<std::uint32_t> starts;
  for (std::uint32_t i = 0; i < 512; ++i) {
    if ((words[i / 32] >> (i % 32) & 1U) != 0) starts.insert(i);
  }
  CHECK(starts == std::set<std::uint32_t>{0, 30, 35, 511});
}

TEST_CASE("modes of inspection have names", "[render]") {
  for (const InspectionMode mode : kInspectionModes)
    CHECK(parse_inspection_mode(to_string(mode)) == mode);
  CHECK_FALSE(parse_inspection_mode("quads").has_value());
  CHECK_FALSE(parse_inspection_mode("").has_value());
  InspectionModes modes;
  CHECK_FALSE(modes.any());
  modes.set(InspectionMode::orders, true);
  CHECK(modes.any());
  CHECK(modes[InspectionMode::orders]);
  CHECK_FALSE(modes[InspectionMode::runs]);
}

TEST_CASE("the six axis orders have six colours", "[render]") {
  std::set<InspectionColour> colours;
  for (const AxisOrder order : kAxisOrders) colours.insert(colour_of(order));
  CHECK(colours.size() == 6);
}
