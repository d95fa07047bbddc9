#include <catch2/catch.hpp>

#include "common/edits/descriptor/edit_descriptor.hpp"

// The kinds of edits that version 3 adds. Their bytes may change until version 3 is released.
namespace runstone::test {
namespace {

AddBuild golden_build() {
  AddBuild build;
  build.info.name = "Mill";
  build.info.author = "zo\xc3\xab";
  build.info.tags = {"wood"};
  build.info.created_us = 300;
  build.info.sides = {70, 3, 2};
  build.info.origin = {-5, 64, 300};
  build.touched = 137;
  build.file_bytes = 329;
  build.file_digest = 0x0123456789abcdefULL;
  build.content = 0x200000001ULL;
  return build;
}

void check_bytes_of(const EditDescriptor& edit, const Bytes& golden) {
  CHECK(encode(edit) == golden);
  const auto decoded = decode_descriptor(golden);
  REQUIRE(decoded.has_value());
  CHECK(*decoded == edit);
  CHECK_FALSE(decode_voxel_edit(golden).has_value());
  for (std::size_t size = 0; size < golden.size(); ++size)
    CHECK_FALSE(decode_descriptor(ByteView(golden).first(size)).has_value());
  Bytes longer = golden;
  longer.push_back(0);
  CHECK_FALSE(decode_descriptor(longer).has_value());
}

}  // namespace

TEST_CASE("the bytes of changes of the library are pinned", "[edits][golden]") {
  check_bytes_of(library_edit(RemoveBuild{300}), {0x0a, 0x00, 0x00, 0x02, 0xac, 0x02});
  check_bytes_of(library_edit(golden_build()),
                 {0x0a, 0x00, 0x00, 0x01,                          // added
                  0x45, 0x02, 0x01,                                // sides
                  0x09, 0x80, 0x01, 0xd8, 0x04,                    // origin
                  0xac, 0x02,                                      // created
                  0x04, 'M',  'i',  'l',  'l',                     // name
                  0x04, 'z',  'o',  0xc3, 0xab,                    // author
                  0x01, 0x04, 'w',  'o',  'o',  'd',               // tags
                  0x89, 0x01,                                      // touched cells
                  0xc9, 0x02,                                      // bytes of the file
                  0xef, 0xcd, 0xab, 0x89, 0x67, 0x45, 0x23, 0x01,  // digest of the file
                  0x01, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00});
}

TEST_CASE("the bytes of given shapes are pinned", "[edits][golden]") {
  const Shape slab{ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}}};
  const Shape stairs{ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}, {{8, 8, 0}, {16, 16, 16}}}};
  const Shape plant{ShapeForm::crossed, {{{1, 0, 1}, {15, 12, 15}}}};
  check_bytes_of(shapes_edit({{{5, plant}, {300, slab}, {301, stairs}, {700, slab}}}),
                 {0x0b, 0x00, 0x00,              // shapes, no mask, no material
                  0x02,                          // three different ones, ascending
                  0x00, 0x01, 0xf0, 0x70, 0xf0,  // one box
                  0x00, 0x02, 0xf0, 0x70, 0xf0, 0xf8, 0xf8, 0xf0,  // two boxes
                  0x01, 0x01, 0xe1, 0xb0, 0xe1,                    // crossed planes
                  0x03,                                            // four rows
                  0x04, 0x02,                                      // 5
                  0xa6, 0x02, 0x00,                                // 5 + 1 + 294
                  0x00, 0x01,                                      // 301
                  0x8e, 0x03, 0x00});                              // 301 + 1 + 398
  CHECK(kind_of(shapes_edit({{{5, slab}}})) == EditKind::shapes);
  CHECK(static_cast<int>(EditKind::shapes) == 11);
}

TEST_CASE("the bytes of a given texture are pinned", "[edits][golden]") {
  const Bytes png = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n', 0,  0, 0, 13, 'I', 'H', 'D',
                     'R',  0,   0,   0,   32,   0,    0,    0,    32, 8, 6, 0,  0,   0};
  std::vector<std::uint8_t> bytes = {0x0c, 0x00, 0x00,  // texture, no mask, no material
                                     0x1c};             // 29 bytes
  bytes.insert(bytes.end(), png.begin(), png.end());
  bytes.insert(bytes.end(), {0x01,                // two uses
                             0x04, 0x3f,          // 5, all sides
                             0xa6, 0x02, 0x04});  // 5 + 1 + 294, the lower side
  check_bytes_of(texture_edit({png, {{5, 63}, {300, 4}}}), bytes);
  CHECK(static_cast<int>(EditKind::texture) == 12);
  CHECK(static_cast<int>(Cause::textures) == 10);
}

TEST_CASE("the bytes of a record that sets the clock are pinned", "[edits][golden]") {
  check_bytes_of(clock_edit({75'600'000, 20}), {0x0d, 0x00, 0x00,        // no mask, no material
                                                0x80, 0xa1, 0x86, 0x24,  // 21:00
                                                0x14});                  // rate 20
  CHECK(static_cast<int>(EditKind::clock) == 13);
  CHECK(static_cast<int>(Cause::clock) == 9);
}

TEST_CASE("the bytes of a record that stands for a lost one are pinned", "[edits][golden]") {
  check_bytes_of(gap_edit({300, true}), {0x0e, 0x00, 0x00,  // no mask, no material
                                         0x01,              // it begins an era
                                         0xac, 0x02});      // author 300
  check_bytes_of(gap_edit({}), {0x0e, 0x00, 0x00, 0x00, 0x00});
  CHECK(static_cast<int>(EditKind::gap) == 14);
  CHECK(static_cast<int>(Cause::gap) == 11);
}

TEST_CASE("the cause of changes of the library has its number", "[edits][golden]") {
  CHECK(static_cast<int>(Cause::library) == 8);
  CHECK(kind_of(library_edit(RemoveBuild{1})) == EditKind::library);
  CHECK(static_cast<int>(EditKind::library) == 10);
}

}  // namespace runstone::test
