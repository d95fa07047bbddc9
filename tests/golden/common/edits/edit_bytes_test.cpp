#include <catch2/catch.hpp>

#include "common/edits/clipboard/clipboard_builder.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/edits/descriptor/edit_record.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/edits/pinned_record.hpp"

// Bytes derived by hand from docs/edit-log.md. They are stored in logs: a change here is a new kind
// or version.
namespace runstone::test {
namespace {

void check_bytes(const EditDescriptor& edit, const Bytes& golden) {
  CAPTURE(edit);
  CHECK(encode(edit) == golden);
  const auto decoded = decode_descriptor(golden);
  REQUIRE(decoded.has_value());
  CHECK(*decoded == edit);
}

}  // namespace

TEST_CASE("descriptor bytes of a set voxel are pinned", "[edits][golden]") {
  check_bytes({SetVoxel{{1, -2, 3}}, {}, 300}, {0x01, 0x00, 0xac, 0x02, 0x02, 0x03, 0x06});
  check_bytes({SetVoxel{{0, 0, 0}}, {MaskKind::only_empty, 0}, 0},
              {0x01, 0x01, 0x00, 0x00, 0x00, 0x00});
  check_bytes({SetVoxel{{-kWorldLimit, kWorldLimit - 1, 64}}, {}, 65535},
              {0x01, 0x00, 0xff, 0xff, 0x03,              // material 65,535
               0xff, 0xff, 0xff, 0xff, 0x03,              // zigzag(-2^29) = 2^30 - 1
               0xfe, 0xff, 0xff, 0xff, 0x03, 0x80, 0x01}  // zigzag(2^29 - 1) = 2^30 - 2, then 128
  );
}

TEST_CASE("descriptor bytes of a filled box are pinned", "[edits][golden]") {
  check_bytes({FillBox{{{-1, 0, 100}, {0, 32, 4196}}}, {MaskKind::only_material, 65535}, 0},
              {0x02, 0x03, 0xff, 0xff, 0x03,  // box, only_material 65,535
               0x00,                          // removes
               0x01, 0x00, 0xc8, 0x01,        // min: -1, 0, 100
               0x00, 0x1f, 0xff, 0x1f});      // sides minus one: 0, 31, 4095
}

TEST_CASE("descriptor bytes of a filled sphere are pinned", "[edits][golden]") {
  check_bytes({FillSphere{{0, 64, -64}, 512}, {MaskKind::only_solid, 0}, 7},
              {0x03, 0x02, 0x07, 0x00, 0x80, 0x01, 0x7f, 0x80, 0x04});
  check_bytes({FillSphere{{5, 6, 7}, 0}, {}, 127}, {0x03, 0x00, 0x7f, 0x0a, 0x0c, 0x0e, 0x00});
}

TEST_CASE("descriptor bytes of a stroke are pinned", "[edits][golden]") {
  check_bytes(
      {FillStroke{{{0, 64, -64}, {-1, 64, 960}, {0, 63, -64}}, 3}, {MaskKind::only_empty, 0}, 7},
      {0x04, 0x01, 0x07,          // stroke, only_empty, material 7
       0x03, 0x01,                // radius 3, points minus two
       0x00, 0x80, 0x01, 0x7f,    // 0, 64, -64
       0x01, 0x00, 0x80, 0x10,    // -1, 0, +1024
       0x02, 0x01, 0xff, 0x0f});  // +1, -1, -1024
}

TEST_CASE("descriptor bytes of a paste are pinned", "[edits][golden]") {
  ClipboardBuilder cells({3, 1, 2}, AxisOrder::xyz);
  cells.append(2, Material{7});
  cells.append(2, std::nullopt);
  cells.append(1, kEmpty);
  cells.append(1, Material{7});
  const Paste paste{{0, 64, -64}, *cells.finish(), Orientation{}.rotated_about_y(1)};
  check_bytes({paste, {MaskKind::only_empty, 0}, kEmpty},
              {0x06, 0x01, 0x00,        // paste, only_empty, no material of its own
               0x00, 0x80, 0x01, 0x7f,  // 0, 64, -64
               0x2c,                    // z, y, x of the clipboard along x, y, z; backwards along z
               0x00, 0x02, 0x00, 0x01,  // order x, y, z; sides minus one
               0x01, 0x00, 0x06,        // palette of 2: 0, then 0 + 1 + 6
               0x05, 0x02, 0x00,
               0x01});  // 2 of number 2; 2 of 0 (0 of 0, 1); 1 of 1 (0 of 1, 2); 1 of 2 (1 of 0, 2)
  ClipboardBuilder whole(Extent::cube(128), AxisOrder::xyz);
  whole.append(Extent::cube(128).volume(), Material{65535});
  check_bytes({Paste{{-kWorldLimit, 0, 0}, *whole.finish(), *Orientation::of_byte(47)}, {}, kEmpty},
              {0x06, 0x00, 0x00,                          // paste everywhere
               0xff, 0xff, 0xff, 0xff, 0x03, 0x00, 0x00,  // zigzag(-2^29) = 2^30 - 1, 0, 0
               0x2f,                                      // z, y, x, all backwards
               0x00, 0x7f, 0x7f, 0x7f,                    // order x, y, z; sides of 128
               0x00, 0xff, 0xff, 0x03,                    // palette of 1: 65,535
               0xff, 0xff, 0xff, 0x01});                  // (2^21 - 1) * 2 + 1
}

const AddedMaterials kWoolAndIce{
    300,
    {{"wool", {0xb8, 0x32, 0x2f, 0xff}, Visibility::opaque},
     {"ice \u00e9", {0xcf, 0xe8, 0xf0, 0x48}, Visibility::transparent}}};

TEST_CASE("descriptor bytes of new materials are pinned", "[edits][golden]") {
  check_bytes(materials_edit(kWoolAndIce),
              {0x08, 0x00, 0x00,                      // new materials, no mask, no material
               0xac, 0x02, 0x01,                      // the first is 300, and there are two
               0x04, 'w',  'o',  'o',  'l',           //
               0xb8, 0x32, 0x2f, 0xff, 0x01,          // colour, opaque
               0x06, 'i',  'c',  'e',  ' ',  0xc3,    //
               0xa9, 0xcf, 0xe8, 0xf0, 0x48, 0x02});  // colour, transparent
}

TEST_CASE("descriptor bytes of new materials with looks are pinned", "[edits][golden]") {
  AddedMaterials added = kWoolAndIce;
  added.rows[1].look = MaterialLook{3, 4, 10, 0, MaterialPattern::tiles};
  check_bytes(materials_edit(added), {0x09, 0x00, 0x00,  // with looks, no mask, no material
                                      0xac, 0x02, 0x01,  // the first is 300, and there are two
                                      0x04, 'w',  'o',  'o',  'l',   //
                                      0xb8, 0x32, 0x2f, 0xff, 0x01,  // colour, opaque, no look
                                      0x06, 'i',  'c',  'e',  ' ',  0xc3, 0xa9,  //
                                      0xcf, 0xe8, 0xf0, 0x48, 0x12,  // colour, transparent, a look
                                      0x03, 0x04, 0x0a, 0x00, 0x03});
}

TEST_CASE("record bytes of new materials are pinned", "[edits][golden]") {
  EditRecord record;
  record.version = {2, 300};
  record.op = {0, 1, 5};
  record.cause = Cause::materials;
  record.edit = materials_edit({1, {{"a", {1, 2, 3, 255}, Visibility::opaque}}});
  const Bytes golden = {0x01, 0x00, 0x02, 0xac, 0x02, 0x00,  // version, log, epoch, seq, author
                        0x01, 0,    0,    0,    0,    0,    0,    0,  // instance
                        0x05, 0x00, 0x07, 0x00,  // client sequence, time, cause, subject
                        0xff, 0xff, 0xff, 0xff, 0x03, 0xff, 0xff, 0xff, 0xff, 0x03,  // -2^29
                        0xff, 0xff, 0xff, 0xff, 0x03, 0x00, 0x00, 0x00,              // empty
                        0x0c, 0x08, 0x00, 0x00, 0x01, 0x00, 0x01, 'a',               // descriptor
                        0x01, 0x02, 0x03, 0xff, 0x01};
  CHECK(encode_record(record) == golden);
  const auto decoded = decode_record(golden);
  REQUIRE(decoded.has_value());
  CHECK(*decoded == record);
}

TEST_CASE("record bytes are pinned", "[edits][golden]") {
  const EditRecord record = pinned_record();
  const Bytes golden = {
      0x01,                                            // record version
      0x01,                                            // log
      0x02, 0xac, 0x02,                                // epoch 2, sequence 300
      0x07,                                            // author
      0xef, 0xcd, 0xab, 0x89, 0x67, 0x45, 0x23, 0x01,  // instance, little-endian
      0x05,                                            // client sequence
      0x80, 0x80, 0xf2, 0x81, 0x83, 0x89, 0x85, 0x06,  // zigzag(1,700,000,000,000,000)
      0x02,                                            // cause: rollback
      0xab, 0x02,                                      // subject: sequence 299
      0x05, 0x7a, 0x85, 0x01, 0x07, 0x07, 0x07,        // box: min -3, 61, -67, sides 7
      0x08,                                            // descriptor length
      0x03, 0x02, 0x07, 0x00, 0x80, 0x01, 0x7f, 0x03,  // descriptor
  };
  CHECK(encode_record(record) == golden);
  const auto decoded = decode_record(golden);
  REQUIRE(decoded.has_value());
  CHECK(*decoded == record);
}

}  // namespace runstone::test
