// The bytes of new materials: every limit, every truncation, and what is refused.
#include "common/edits/descriptor/added_materials.hpp"

#include <catch2/catch.hpp>

#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone::test {
namespace {

MaterialRow row_of(std::string name, Visibility visibility = Visibility::opaque,
                   std::uint8_t alpha = 255) {
  return {std::move(name), {1, 2, 3, alpha}, visibility};
}

/// Returns `count` rows with the longest names.
std::vector<MaterialRow> long_rows(std::size_t count) {
  std::vector<MaterialRow> rows;
  for (std::size_t i = 0; i < count; ++i) {
    std::string name = std::to_string(i);
    name.resize(kMaterialNameBytesMax, 'x');
    rows.push_back(row_of(std::move(name)));
  }
  return rows;
}

MaterialRow with_look(MaterialRow row, const MaterialLook& look) {
  row.look = look;
  return row;
}

ErrorCode fault_of(const AddedMaterials& added) {
  const auto valid = validate(added);
  REQUIRE_FALSE(valid.has_value());
  return valid.error().code;
}

Bytes bytes_of_added(const AddedMaterials& added) {
  Bytes out;
  ByteWriter w(out);
  write_added_materials(w, added);
  return out;
}

}  // namespace

TEST_CASE("new materials at the limits are valid, one step beyond they are not", "[edits]") {
  const auto last = static_cast<Material>(kMaterialCountMax - 1);
  CHECK(validate({last, {row_of("a")}}).has_value());
  CHECK(validate({1, long_rows(kAddedMaterialsMax)}).has_value());
  CHECK(validate({1, {row_of("glass", Visibility::transparent, 9)}}).has_value());
  CHECK(validate({1, {row_of("gone", Visibility::empty, 0)}}).has_value());

  CHECK(fault_of({1, {}}) == ErrorCode::bad_value);
  CHECK(fault_of({1, long_rows(kAddedMaterialsMax + 1)}) == ErrorCode::limit_exceeded);
  CHECK(fault_of({kEmpty, {row_of("a")}}) == ErrorCode::bad_value);
  CHECK(fault_of({last, {row_of("a"), row_of("b")}}) == ErrorCode::bad_value);
  CHECK(fault_of({1, {row_of("a"), row_of("b"), row_of("a")}}) == ErrorCode::bad_value);
  for (const std::string& name : {std::string(), std::string("a\nb"), std::string("\xff"),
                                  std::string(kMaterialNameBytesMax + 1, 'a')}) {
    CAPTURE(name);
    CHECK(fault_of({1, {row_of(name)}}) == ErrorCode::bad_value);
  }
  CHECK(fault_of({1, {row_of("a", Visibility::opaque, 254)}}) == ErrorCode::bad_value);
  CHECK(fault_of({1, {row_of("a", static_cast<Visibility>(3))}}) == ErrorCode::bad_value);
  CHECK(validate({1, {with_look(row_of("a"), {100, 100, 100, 100})}}).has_value());
  CHECK(fault_of({1, {with_look(row_of("a"), {101, 0, 0, 0})}}) == ErrorCode::bad_value);
}

TEST_CASE("the largest addition of materials fits its bound, and the record's", "[edits]") {
  const AddedMaterials largest{static_cast<Material>(kMaterialCountMax - kAddedMaterialsMax),
                               long_rows(kAddedMaterialsMax)};
  CHECK(bytes_of_added(largest).size() == kAddedMaterialsBytesMax);
  const Bytes descriptor = encode(materials_edit(largest));
  CHECK(descriptor.size() <= descriptor_bytes_max(EditKind::materials));
  CHECK(decode_descriptor(descriptor).has_value());

  AddedMaterials with_looks = largest;
  for (MaterialRow& row : with_looks.rows) row.look = MaterialLook{};
  CHECK(bytes_of_added(with_looks).size() == kAddedMaterialsBytesMax + kAddedLooksBytesMax);
  const Bytes longer = encode(materials_edit(with_looks));
  CHECK(longer.size() <= descriptor_bytes_max(EditKind::materials_with_looks));
  CHECK(decode_descriptor(longer).has_value());
}

TEST_CASE("bytes of new materials that are cut, too long or not canonical are refused", "[edits]") {
  const Bytes good = encode(materials_edit({300, {row_of("wool"), row_of("ice")}}));
  for (std::size_t size = 0; size < good.size(); ++size) {
    const Bytes cut(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size));
    CHECK_FALSE(decode_descriptor(cut).has_value());
  }
  const auto refused = [&](std::size_t at, std::uint8_t byte) {
    Bytes bytes = good;
    bytes.at(at) = byte;
    return !decode_descriptor(bytes).has_value();
  };
  // Kind, mask, material; first: ac 02; count - 1: 01; length: 04.
  REQUIRE(Bytes(good.begin(), good.begin() + 7) == Bytes{0x08, 0x00, 0x00, 0xac, 0x02, 0x01, 0x04});
  CHECK(refused(1, 0x01));   // a mask
  CHECK(refused(2, 0x01));   // a material of its own
  CHECK(refused(4, 0x00));   // a varint that is too long
  CHECK(refused(5, 0x00));   // one row, and bytes behind it
  CHECK(refused(6, 0x00));   // an empty name
  CHECK(refused(6, 0x41));   // a name of 65 bytes
  CHECK(refused(15, 0x03));  // a visibility that nobody knows
  Bytes longer = good;
  longer.push_back(0);
  CHECK_FALSE(decode_descriptor(longer).has_value());
  // Two rows of one name.
  Bytes twice = {0x08, 0x00, 0x00, 0x05, 0x01};
  for (int i = 0; i < 2; ++i) twice.insert(twice.end(), {0x01, 'a', 1, 2, 3, 0xff, 0x01});
  CHECK_FALSE(decode_descriptor(twice).has_value());
}

TEST_CASE("the kind of new materials says if a row has a look", "[edits]") {
  const MaterialRow plain = row_of("wool"), other = row_of("oil"),
                    shiny = with_look(row_of("ice"), {1, 2, 3, 4});
  CHECK(kind_of(materials_edit({300, {plain, other}})) == EditKind::materials);
  const EditDescriptor edit = materials_edit({300, {plain, shiny}});
  CHECK(kind_of(edit) == EditKind::materials_with_looks);
  const Bytes good = encode(edit);
  REQUIRE(decode_descriptor(good).has_value());
  CHECK(*decode_descriptor(good) == edit);
  CHECK_FALSE(decode_voxel_edit(good).has_value());
  for (std::size_t size = 0; size < good.size(); ++size) {
    const Bytes cut(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size));
    CHECK_FALSE(decode_descriptor(cut).has_value());
  }
  const auto refused = [&](std::size_t at, std::uint8_t byte) {
    Bytes bytes = good;
    bytes.at(at) = byte;
    return !decode_descriptor(bytes).has_value();
  };
  CHECK(refused(0, 0x08));                             // the kind without looks
  CHECK(refused(good.size() - 5, 101));                // variation
  CHECK(refused(good.size() - 2, 101));                // emission
  CHECK(refused(good.size() - 1, kMaterialPatterns));  // a pattern of a later version
  CHECK(refused(good.size() - 6, 0x01));               // a row without a look, and bytes behind it
  CHECK(refused(good.size() - 6, 0x21));               // an unused bit
  Bytes without = encode(materials_edit({300, {plain, other}}));
  without[0] = 0x09;
  CHECK(decode_descriptor(without).error().code == ErrorCode::not_canonical);
}

}  // namespace runstone::test
