#include "common/mesh/rdm/divider.hpp"

#include <catch2/catch.hpp>

#include "common/runs/extent.hpp"

namespace runstone::rdm {
namespace {

TEST_CASE("a divider divides every index of a chunk by every side exactly", "[mesh]") {
  // The quotient can be wrong only at multiples and directly before them, because it grows with the
  // index between them.
  for (std::uint32_t side = 1; side <= kSideMax + 1; ++side) {
    const Divider divide(side);
    std::uint32_t wrong = 0;
    for (std::uint32_t multiple = 0; multiple <= kVolumeMax + side; multiple += side) {
      wrong += divide(multiple) != multiple / side ? 1 : 0;
      if (multiple > 0) wrong += divide(multiple - 1) != (multiple - 1) / side ? 1 : 0;
    }
    CAPTURE(side);
    REQUIRE(wrong == 0);
  }
}

}  // namespace
}  // namespace runstone::rdm
