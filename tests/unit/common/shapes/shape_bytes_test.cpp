#include "common/shapes/shape_bytes.hpp"

#include <catch2/catch.hpp>

#include "common/shapes/shape_faces.hpp"

namespace runstone::test {
namespace {

const Shape kStairsOfBytes{ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}, {{8, 8, 0}, {16, 16, 16}}}};
// Form 0, two boxes, and for each axis (max - 1) << 4 | min.
const Bytes kStairsBytes = {0, 2, 0xf0, 0x70, 0xf0, 0xf8, 0xf8, 0xf0};

Result<Shape> shape_of_bytes(const Bytes& bytes) {
  ByteReader in(bytes);
  Shape out = read_shape(in);
  if (auto end = in.finish(); !end) return failure(end.error());
  return out;
}

}  // namespace

TEST_CASE("the bytes of a shape are pinned", "[shapes][golden]") {
  Bytes bytes;
  ByteWriter out(bytes);
  write_shape(out, kStairsOfBytes);
  CHECK(bytes == kStairsBytes);
  const auto read = shape_of_bytes(kStairsBytes);
  REQUIRE(read);
  CHECK(*read == kStairsOfBytes);

  const Shape plant{ShapeForm::crossed, {{{1, 0, 2}, {15, 12, 14}}}};
  bytes.clear();
  write_shape(out, plant);
  CHECK(bytes == Bytes{1, 1, 0xe1, 0xb0, 0xd2});
  CHECK(*shape_of_bytes(bytes) == plant);
}

TEST_CASE("bytes that are no shape are rejected", "[shapes]") {
  for (std::size_t size = 0; size < kStairsBytes.size(); ++size) {
    CAPTURE(size);
    CHECK_FALSE(
        shape_of_bytes({kStairsBytes.begin(), kStairsBytes.begin() + static_cast<int>(size)}));
  }
  const auto with = [](std::size_t at, std::uint8_t byte) {
    Bytes out = kStairsBytes;
    out[at] = byte;
    return shape_of_bytes(out);
  };
  CHECK_FALSE(with(0, 2));     // unknown form
  CHECK_FALSE(with(1, 0));     // no box
  CHECK_FALSE(with(1, 33));    // too many boxes
  CHECK_FALSE(with(2, 0x12));  // max 2 is not above min 2
  CHECK(with(2, 0x22));        // max 3 is
  Bytes longer = kStairsBytes;
  longer.push_back(0);
  CHECK_FALSE(shape_of_bytes(longer));
  ByteReader in(ByteView{});
  CHECK(read_shape(in).is_cube());
  CHECK_FALSE(in.ok());
}

TEST_CASE("a shape of too many faces is rejected", "[shapes]") {
  CHECK_FALSE(check_shape(Shape{}));
  CHECK(check_shape(kStairsOfBytes));
  // Plates along all axes, which leave cells between them.
  Shape plates;
  for (std::uint8_t i = 0; i < 15; i = static_cast<std::uint8_t>(i + 2)) {
    const auto end = static_cast<std::uint8_t>(i + 1);
    plates.boxes.push_back({{i, 0, 0}, {end, 16, 16}});
    plates.boxes.push_back({{0, i, 0}, {16, end, 16}});
    plates.boxes.push_back({{0, 0, i}, {16, 16, end}});
  }
  REQUIRE(validate_shape(plates));
  CAPTURE(ShapeFaces(plates).faces().size());
  const auto refused = check_shape(plates);
  REQUIRE_FALSE(refused);
  CHECK(refused.error().code == ErrorCode::limit_exceeded);
  Bytes bytes;
  ByteWriter out(bytes);
  write_shape(out, plates);
  CHECK_FALSE(shape_of_bytes(bytes));
}

}  // namespace runstone::test
