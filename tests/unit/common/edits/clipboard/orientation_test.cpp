#include "common/edits/clipboard/orientation.hpp"

#include <catch2/catch.hpp>
#include <set>

namespace runstone::test {

TEST_CASE("the 48 orientations have the bytes 0 to 47", "[edits]") {
  for (int byte = 0; byte < 256; ++byte) {
    const auto orientation = Orientation::of_byte(static_cast<std::uint8_t>(byte));
    REQUIRE(orientation.has_value() == (byte < kOrientationCount));
    if (!orientation) continue;
    CHECK(orientation->valid());
    CHECK(orientation->to_byte() == byte);
  }
  CHECK(Orientation{}.to_byte() == 0);
  CHECK_FALSE(Orientation{AxisOrder::xyz, 8}.valid());
  CHECK_FALSE(Orientation{static_cast<AxisOrder>(6), 0}.valid());
}

TEST_CASE("a quarter turn maps +z to +x and +x to -z, and four of them are the identity",
          "[edits]") {
  const Orientation turned = Orientation{}.rotated_about_y(1);
  CHECK(turned.along(Axis::x) == Axis::z);
  CHECK(turned.along(Axis::y) == Axis::y);
  CHECK(turned.along(Axis::z) == Axis::x);
  CHECK_FALSE(turned.flipped(Axis::x));
  CHECK_FALSE(turned.flipped(Axis::y));
  CHECK(turned.flipped(Axis::z));
  CHECK(turned.rotated({3, 5, 7}) == Extent{7, 5, 3});
  CHECK(Orientation{}.rotated_about_y(2) == Orientation{AxisOrder::xyz, 5});
  CHECK(Orientation{}.rotated_about_y(-1) == Orientation{}.rotated_about_y(3));
  for (std::uint8_t byte = 0; byte < kOrientationCount; ++byte) {
    const Orientation any = *Orientation::of_byte(byte);
    CHECK(any.rotated_about_y(4) == any);
    CHECK(any.rotated_about_y(1).rotated_about_y(1) == any.rotated_about_y(2));
    CHECK(any.rotated_about_y(-5).rotated_about_y(1) == any);
    CHECK(any.rotated_about_y(1).along(Axis::x) == any.along(Axis::z));
    CHECK(any.rotated_about_y(1).flipped(Axis::x) == any.flipped(Axis::z));
    CHECK(any.rotated_about_y(1).flipped(Axis::z) != any.flipped(Axis::x));
    CHECK(any.rotated_about_y(1).flipped(Axis::y) == any.flipped(Axis::y));
  }
}

TEST_CASE(
    "mirroring twice is the identity, and quarter turns and mirrors make sixteen orientations",
    "[edits]") {
  std::set<int> reached;
  for (int quarters = 0; quarters < 4; ++quarters) {
    const Orientation turned = Orientation{}.rotated_about_y(quarters);
    for (const Axis axis : {Axis::x, Axis::y, Axis::z}) {
      CHECK(turned.mirrored(axis).mirrored(axis) == turned);
      CHECK(turned.mirrored(axis).flipped(axis) != turned.flipped(axis));
      CHECK(turned.mirrored(axis).axes == turned.axes);
      reached.insert(turned.mirrored(axis).to_byte());
      reached.insert(turned.mirrored(axis).mirrored(Axis::y).to_byte());
    }
    reached.insert(turned.to_byte());
  }
  CHECK(reached.size() == 16);
}

}  // namespace runstone::test
