// The shapes of Welcome: what comes back, and which bytes are refused.
#include "protocol/codec/shape_list.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "common/shapes/shape_bytes.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone::test {
namespace {

const Shape kSlab{ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}}};
const Shape kLow{ShapeForm::boxes, {{{0, 0, 0}, {16, 4, 16}}}};
const Shape kPlant{ShapeForm::crossed, {{{1, 0, 1}, {15, 12, 15}}}};

MaterialTable shaped_table() {
  MaterialTable table;
  const auto add = [&](const char* name, const Shape& shape) {
    MaterialInfo info{name, {1, 2, 3, 255}, Visibility::opaque, {}};
    info.shape = shape;
    REQUIRE(table.add(std::move(info)).has_value());
  };
  add("slab", kSlab);
  add("stone", {});
  add("plant", kPlant);
  add("low", kLow);
  add("other slab", kSlab);
  return table;
}

Bytes bytes_of_shapes(const std::vector<Shape>& shapes) {
  Bytes bytes;
  ByteWriter w(bytes);
  for (const Shape& shape : shapes) write_shape(w, shape);
  return bytes;
}

Result<Message> sent_and_read(const Welcome& welcome) {
  const EncodedMessage encoded = encode_message(welcome);
  return decode_message(Sender::server, encoded.kind, *encoded.bytes, 0);
}

}  // namespace

TEST_CASE("the different shapes of a table come back, ascending", "[protocol][shapes]") {
  const MaterialTable table = shaped_table();
  const ShapeList list(table);
  CHECK(list.encode() == bytes_of_shapes({kLow, kSlab, kPlant}));
  const auto read = decode_shapes(list.encode());
  REQUIRE(read.has_value());
  CHECK(*read == std::vector<Shape>{kLow, kSlab, kPlant});
  std::vector<int> numbers;
  for (const MaterialInfo& row : table.rows()) numbers.push_back(list.number(row));
  CHECK(numbers == std::vector<int>{0, 2, 0, 3, 1, 2});
  CHECK(ShapeList().number(table[1]) == 0);
  CHECK(ShapeList(MaterialTable{}).empty());
  CHECK(decode_shapes({})->empty());
}

TEST_CASE("bytes of shapes that are bad or not canonical are refused", "[protocol][shapes]") {
  CHECK_FALSE(decode_shapes(bytes_of_shapes({kSlab, kLow})).has_value());
  CHECK_FALSE(decode_shapes(bytes_of_shapes({kSlab, kSlab})).has_value());
  const Bytes good = bytes_of_shapes({kLow, kSlab});
  for (std::size_t size = 1; size < good.size(); ++size) {
    if (size != good.size() / 2) CHECK_FALSE(decode_shapes(ByteView(good).first(size)).has_value());
  }
  CHECK_FALSE(decode_shapes(Bytes{0x00, 0x00}).has_value());  // a cube
  // 4097 different shapes.
  std::vector<Shape> many;
  for (unsigned i = 0; i <= kTableShapesMax; ++i) {
    const auto digit = [&](unsigned place) { return static_cast<std::uint8_t>(i >> place & 15); };
    many.push_back({ShapeForm::boxes,
                    {{{digit(8), digit(4), digit(0)},
                      {16, 16, static_cast<std::uint8_t>(i == kTableShapesMax ? 15 : 16)}}}});
  }
  std::sort(many.begin(), many.end());
  const auto too_many = decode_shapes(bytes_of_shapes(many));
  REQUIRE_FALSE(too_many.has_value());
  CHECK(too_many.error().code == ErrorCode::limit_exceeded);
  many.pop_back();
  CHECK(decode_shapes(bytes_of_shapes(many)).has_value());
}

TEST_CASE("Welcome has shapes with the feature only", "[protocol][shapes]") {
  Welcome welcome;
  welcome.epoch = 1;
  welcome.edit_volume_max = 1;
  welcome.heights = {-64, 64};
  welcome.materials = shaped_table();
  welcome.features = kFeatureShapes;
  const auto with = sent_and_read(welcome);
  if (!with) FAIL(with.error().what);
  CHECK(std::get<Welcome>(*with).materials == welcome.materials);
  const std::size_t size_with = encode_message(welcome).bytes->size();
  welcome.features = kFeatureMaterials;
  const auto without = sent_and_read(welcome);
  REQUIRE(without.has_value());
  for (const MaterialInfo& row : std::get<Welcome>(*without).materials.rows())
    CHECK(row.shape.is_cube());
  CHECK(encode_message(welcome).bytes->size() < size_with);
}

}  // namespace runstone::test
