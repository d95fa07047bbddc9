// The bytes of given shapes: every limit, every truncation, and what is refused.
#include "common/edits/descriptor/given_shapes.hpp"

#include <catch2/catch.hpp>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/edits/descriptor/edit_memory.hpp"

namespace runstone::test {
namespace {

Shape box_shape(std::uint8_t height) { return {ShapeForm::boxes, {{{0, 0, 0}, {16, height, 16}}}}; }

/// Returns shape `i` of many different ones, with one box each.
Shape shape_number(std::size_t i) {
  const auto digit = [&](std::size_t place) { return static_cast<std::uint8_t>(i >> place & 15); };
  return {ShapeForm::boxes, {{{digit(0), digit(4), digit(8)}, {16, 16, 16}}}};
}

/// Returns `count` rows from material 1 on, of which the first `different` have different shapes.
GivenShapes many_shapes(std::size_t count, std::size_t different) {
  GivenShapes given;
  for (std::size_t i = 0; i < count; ++i)
    given.rows.push_back({static_cast<Material>(i + 1), shape_number(i % different)});
  return given;
}

ErrorCode fault_of_given(const GivenShapes& given) {
  const auto valid = validate(given);
  REQUIRE_FALSE(valid.has_value());
  return valid.error().code;
}

}  // namespace

TEST_CASE("given shapes at the limits are valid, one step beyond they are not", "[edits]") {
  CHECK(validate(GivenShapes{{{65535, box_shape(8)}}}).has_value());
  CHECK(validate(many_shapes(kGivenShapesMax, kDifferentShapesMax)).has_value());
  CHECK(fault_of_given({}) == ErrorCode::bad_value);
  CHECK(fault_of_given(many_shapes(kGivenShapesMax + 1, 1)) == ErrorCode::limit_exceeded);
  CHECK(fault_of_given(many_shapes(kDifferentShapesMax + 1, kDifferentShapesMax + 1)) ==
        ErrorCode::limit_exceeded);
  CHECK(fault_of_given({{{kEmpty, box_shape(8)}}}) == ErrorCode::bad_value);
  CHECK(fault_of_given({{{2, box_shape(8)}, {2, box_shape(4)}}}) == ErrorCode::bad_value);
  CHECK(fault_of_given({{{2, box_shape(8)}, {1, box_shape(4)}}}) == ErrorCode::bad_value);
  CHECK(fault_of_given({{{1, {}}}}) == ErrorCode::bad_value);
  CHECK(fault_of_given({{{1, box_shape(17)}}}) == ErrorCode::bad_value);
}

TEST_CASE("the largest record of shapes fits its bound", "[edits]") {
  GivenShapes largest;
  for (std::size_t i = 0; i < kGivenShapesMax; ++i) {
    Shape shape;
    shape.boxes.assign(kShapeBoxesMax, ShapeBox{});
    shape.boxes[0] = shape_number(i % kDifferentShapesMax).boxes[0];
    largest.rows.push_back({static_cast<Material>(65535 - kGivenShapesMax + i), std::move(shape)});
  }
  const EditDescriptor edit = shapes_edit(largest);
  const Bytes bytes = encode(edit);
  CHECK(bytes.size() > std::size_t{24} * 1024);
  CHECK(bytes.size() <= descriptor_bytes_max(EditKind::shapes));
  const auto decoded = decode_descriptor(bytes);
  REQUIRE(decoded.has_value());
  CHECK(*decoded == edit);
  CHECK(memory_bytes(edit) > kGivenShapesMax * kShapeBoxesMax * sizeof(ShapeBox));
}

TEST_CASE("shapes are cut into records of the right size", "[edits]") {
  const GivenShapes all = many_shapes(1000, 300);
  std::vector<std::size_t> sizes;
  std::vector<GivenShape> joined;
  for (std::span<const GivenShape> left(all.rows); !left.empty();) {
    const GivenShapes first = first_of(left);
    REQUIRE(validate(first).has_value());
    joined.insert(joined.end(), first.rows.begin(), first.rows.end());
    sizes.push_back(first.rows.size());
    left = left.subspan(first.rows.size());
  }
  CHECK(joined == all.rows);
  // Each ends before its 257th different shape.
  CHECK(sizes == std::vector<std::size_t>{256, 256, 256, 232});
  CHECK(first_of(many_shapes(600, 10).rows).rows.size() == kGivenShapesMax);
}

TEST_CASE("bytes of given shapes that are cut, too long or not canonical are refused", "[edits]") {
  const Bytes good = encode(shapes_edit({{{300, box_shape(8)}, {301, box_shape(4)}}}));
  // Kind, mask, material; shapes - 1; two shapes of five bytes; rows - 1; step and number of each.
  REQUIRE(good == Bytes{0x0b, 0x00, 0x00, 0x01, 0x00, 0x01, 0xf0, 0x30, 0xf0, 0x00,
                        0x01, 0xf0, 0x70, 0xf0, 0x01, 0xab, 0x02, 0x01, 0x00, 0x00});
  for (std::size_t size = 0; size < good.size(); ++size)
    CHECK_FALSE(decode_descriptor(ByteView(good).first(size)).has_value());
  const auto refused = [&](std::size_t at, std::uint8_t byte) {
    Bytes bytes = good;
    bytes.at(at) = byte;
    return !decode_descriptor(bytes).has_value();
  };
  CHECK(refused(1, 0x01));   // a mask
  CHECK(refused(2, 0x01));   // a material of its own
  CHECK(refused(4, 0x02));   // a form that nobody knows
  CHECK(refused(5, 0x21));   // 33 boxes
  CHECK(refused(7, 0x70));   // two equal shapes
  CHECK(refused(7, 0x80));   // shapes that do not ascend
  CHECK(refused(17, 0x00));  // a shape that no row has
  CHECK(refused(17, 0x02));  // an unknown number
  Bytes longer = good;
  longer.push_back(0);
  CHECK_FALSE(decode_descriptor(longer).has_value());
  // Material 65536.
  const Bytes beyond = {0x0b, 0x00, 0x00, 0x00, 0x00, 0x01, 0xf0,
                        0x30, 0xf0, 0x00, 0xff, 0xff, 0x03, 0x00};
  CHECK_FALSE(decode_descriptor(beyond).has_value());
}

TEST_CASE("given shapes are an edit without voxels", "[edits]") {
  const EditDescriptor edit = shapes_edit({{{35, box_shape(8)}}});
  CHECK_FALSE(decode_voxel_edit(encode(edit)).has_value());
  CHECK_FALSE(has_voxels(edit));
  CHECK(changes_materials(edit));
  CHECK(given_shapes_of(edit) != nullptr);
  CHECK(added_materials_of(edit) == nullptr);
  CHECK(touched_chunks(edit, 16).empty());
  CHECK(counted_voxels(edit) == 0);
  CHECK(bounding_box(edit).empty());
  CHECK_FALSE(validate(EditDescriptor{ShapesEdit{}, {}, kEmpty}).has_value());
  CHECK_FALSE(validate(EditDescriptor{edit.shape, {}, 1}).has_value());
}

}  // namespace runstone::test
