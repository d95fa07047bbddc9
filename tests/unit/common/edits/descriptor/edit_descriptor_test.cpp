#include <catch2/catch.hpp>

#include "common/edits/clipboard/clipboard_builder.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/edits/descriptor/edit_memory.hpp"
#include "common/edits/descriptor/edit_record.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {
namespace {

const EditDescriptor kVoxel = {SetVoxel{{1, 2, 3}}, {}, 4};

ErrorCode error_of(const EditDescriptor& edit) {
  const auto result = validate(edit);
  REQUIRE_FALSE(result.has_value());
  return result.error().code;
}

ErrorCode decode_error(const Bytes& bytes) {
  const auto result = decode_descriptor(bytes);
  REQUIRE_FALSE(result.has_value());
  return result.error().code;
}

/// Returns an edit with the head of a PNG of 32 pixels, for one or two materials.
EditDescriptor sample_texture_edit(SplitMix64& rng) {
  const Bytes head = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n', 0,  0, 0, 13, 'I', 'H', 'D',
                      'R',  0,   0,   0,   32,   0,    0,    0,    32, 8, 6, 0,  0,   0};
  const auto first = static_cast<Material>(1 + rng.below(1000));
  std::vector<TextureUse> uses = {{first, static_cast<std::uint8_t>(1 + rng.below(63))}};
  if (rng.below(2) == 0) uses.push_back({static_cast<Material>(first + 1 + rng.below(9)), 63});
  return texture_edit({head, std::move(uses)});
}

EditRecord random_record(SplitMix64& rng) {
  EditRecord record;
  const auto any = [&rng](std::uint64_t max) { return (rng.next() >> rng.below(64)) & max; };
  record.version = {static_cast<Epoch>(any(~0U)), any(kSequenceMax) | 1};
  record.op = {static_cast<AuthorId>(any(~0U)), rng.next(), any(kSequenceMax)};
  record.time_us = static_cast<TimeUs>(rng.next() >> rng.below(64));
  record.cause = static_cast<Cause>(rng.below(kCauseMax + 1));
  if (rng.below(2) == 0) record.subject = any(kSequenceMax) % record.version.seq;
  if (rng.below(2) == 0) record.log = static_cast<LogId>(any(~0U));
  record.edit = record.cause == Cause::rights
                    ? rights_edit(Unprotect{"box" + std::to_string(rng.below(10))})
                : record.cause == Cause::materials ? sample_materials_edit(rng)
                : record.cause == Cause::library   ? library_edit(RemoveBuild{1 + rng.below(1000)})
                : record.cause == Cause::clock     ? clock_edit({rng.below(kDayMs), rng.below(100)})
                : record.cause == Cause::textures  ? sample_texture_edit(rng)
                : record.cause == Cause::gap       ? gap_edit({rng.below(1000), rng.below(2) == 0})
                                                   : random_edit_anywhere(rng);
  return record;
}

}  // namespace

TEST_CASE("descriptors at the limits are valid, one step beyond they are not", "[edits]") {
  constexpr std::int32_t kLow = -kWorldLimit;
  constexpr std::int32_t kEnd = kWorldLimit;
  CHECK(validate({SetVoxel{{kLow, kEnd - 1, 0}}, {}, 1}).has_value());
  CHECK(error_of({SetVoxel{{kLow - 1, 0, 0}}, {}, 1}) == ErrorCode::bad_value);
  CHECK(error_of({SetVoxel{{0, kEnd, 0}}, {}, 1}) == ErrorCode::bad_value);
  CHECK(error_of({SetVoxel{{0, 0, kEnd}}, {}, 1}) == ErrorCode::bad_value);

  CHECK(validate({FillBox{{{kLow, 0, kEnd - 4096}, {kLow + 1, 4096, kEnd}}}, {}, 1}).has_value());
  CHECK(error_of({FillBox{{{0, 0, 0}, {4097, 1, 1}}}, {}, 1}) == ErrorCode::limit_exceeded);
  CHECK(error_of({FillBox{{{0, 0, 0}, {1, 0, 1}}}, {}, 1}) == ErrorCode::bad_value);
  CHECK(error_of({FillBox{{{0, 0, 1}, {1, 1, 0}}}, {}, 1}) == ErrorCode::bad_value);
  CHECK(error_of({FillBox{{{0, 0, kEnd - 1}, {1, 1, kEnd + 1}}}, {}, 1}) == ErrorCode::bad_value);
  CHECK(error_of({FillBox{{{INT32_MIN, 0, 0}, {INT32_MAX, 1, 1}}}, {}, 1}) == ErrorCode::bad_value);

  CHECK(validate({FillSphere{{kLow + 512, kEnd - 513, 0}, 512}, {}, 1}).has_value());
  CHECK(error_of({FillSphere{{0, 0, 0}, 513}, {}, 1}) == ErrorCode::limit_exceeded);
  CHECK(error_of({FillSphere{{kLow + 511, 0, 0}, 512}, {}, 1}) == ErrorCode::bad_value);
  CHECK(error_of({FillSphere{{0, 0, kEnd - 512}, 512}, {}, 1}) == ErrorCode::bad_value);
}

TEST_CASE("a stroke has points, steps and a radius within its limits, and no point twice in a row",
          "[edits]") {
  constexpr std::int32_t kEnd = kWorldLimit;
  const auto stroke = [](std::vector<VoxelPos> points, std::uint16_t radius = 1) {
    return EditDescriptor{FillStroke{std::move(points), radius}, {}, 1};
  };
  CHECK(validate(stroke({{0, 0, 0}, {1024, -1024, 1024}}, 512)).has_value());
  CHECK(validate(stroke({{0, 0, 0}, {0, 1, 0}, {0, 0, 0}})).has_value());
  CHECK(validate(stroke({{-kEnd + 1, 0, 0}, {-kEnd + 2, kEnd - 2, 0}, {-kEnd + 2, kEnd - 3, 0}}))
            .has_value() == false);  // the step in y
  CHECK(validate(stroke({{-kEnd + 1, kEnd - 9, 0}, {-kEnd + 2, kEnd - 2, 0}})).has_value());
  CHECK(error_of(stroke({})) == ErrorCode::bad_value);
  CHECK(error_of(stroke({{0, 0, 0}})) == ErrorCode::bad_value);
  CHECK(error_of(stroke({{0, 0, 0}, {0, 0, 0}})) == ErrorCode::bad_value);
  CHECK(error_of(stroke({{0, 0, 0}, {1, 0, 0}}, 0)) == ErrorCode::bad_value);
  CHECK(error_of(stroke({{0, 0, 0}, {1, 0, 0}}, 513)) == ErrorCode::limit_exceeded);
  CHECK(error_of(stroke({{0, 0, 0}, {1025, 0, 0}})) == ErrorCode::limit_exceeded);
  CHECK(error_of(stroke({{0, 0, 0}, {0, 0, -1025}})) == ErrorCode::limit_exceeded);
  CHECK(error_of(stroke({{0, kEnd - 1, 0}, {0, kEnd - 2, 0}})) == ErrorCode::bad_value);
  CHECK(error_of(stroke({{0, 5, INT32_MIN}, {0, 5, INT32_MAX}})) == ErrorCode::bad_value);
  std::vector<VoxelPos> points;
  for (std::int32_t i = 0; i < 256; ++i) points.push_back({i, 0, 0});
  CHECK(validate(stroke(points)).has_value());
  points.push_back({0, 0, 0});
  CHECK(error_of(stroke(points)) == ErrorCode::limit_exceeded);
}

TEST_CASE(
    "a paste has a clipboard, an orientation and no material, "
    "and its touched cells lie in the world",
    "[edits]") {
  ClipboardBuilder cells({4, 1, 1});
  cells.append(3, std::nullopt);
  cells.append(1, Material{300});
  const auto clipboard = *cells.finish();
  const auto paste = [&](VoxelPos at, Orientation orientation = {}) {
    return EditDescriptor{Paste{at, clipboard, orientation}, {}, kEmpty};
  };
  CHECK(validate(paste({1, 2, 3})).has_value());
  CHECK(validate(paste({kWorldLimit - 4, 0, 0})).has_value());
  CHECK(error_of(paste({kWorldLimit - 3, 0, 0})) == ErrorCode::bad_value);
  CHECK(validate(paste({kWorldLimit - 3, 0, 0}, Orientation{}.mirrored(Axis::x))).has_value());
  CHECK(error_of(paste({kWorldLimit, 0, 0}, Orientation{}.mirrored(Axis::x))) ==
        ErrorCode::bad_value);
  CHECK(error_of(paste({-kWorldLimit - 1, 0, 0})) ==
        ErrorCode::bad_value);  // although its only cell lies inside
  CHECK(error_of(paste({INT32_MAX, 0, 0})) == ErrorCode::bad_value);
  CHECK(error_of(paste({0, 0, 0}, {AxisOrder::xyz, 8})) == ErrorCode::bad_value);
  CHECK(error_of({Paste{}, {}, kEmpty}) == ErrorCode::bad_value);
  EditDescriptor coloured = paste({0, 0, 0});
  coloured.material = 1;
  CHECK(error_of(coloured) == ErrorCode::bad_value);
  CHECK(decode_error({6, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 7, 1}) ==
        ErrorCode::bad_value);  // likewise
  CHECK(decode_error({6, 0, 0, 0, 0, 0, 48, 0, 0, 0, 0, 0, 7, 1}) ==
        ErrorCode::bad_value);  // orientation
  CHECK(decode_descriptor(Bytes{6, 0, 0, 0, 0, 0, 47, 0, 0, 0, 0, 0, 7, 1}).has_value());

  CHECK(material_max(paste({0, 0, 0})) == 300);
  EditDescriptor masked = paste({0, 0, 0});
  masked.mask = {MaskKind::only_material, 301};
  CHECK(material_max(masked) == 301);
  CHECK(material_max(kVoxel) == 4);
}

TEST_CASE("pastes are equal when their clipboards are, shared or not", "[edits]") {
  const auto clipboard = [](Material material) {
    ClipboardBuilder cells({2, 2, 2});
    cells.append(8, material);
    return *cells.finish();
  };
  const auto shared = clipboard(1);
  const Paste paste{{1, 2, 3}, shared, {}};
  CHECK(paste == Paste{{1, 2, 3}, shared, {}});
  CHECK(paste == Paste{{1, 2, 3}, clipboard(1), {}});
  CHECK_FALSE(paste == Paste{{1, 2, 3}, clipboard(2), {}});
  CHECK_FALSE(paste == Paste{{1, 2, 4}, shared, {}});
  CHECK_FALSE(paste == Paste{{1, 2, 3}, shared, Orientation{}.mirrored(Axis::y)});
  CHECK_FALSE(paste == Paste{{1, 2, 3}, nullptr, {}});
  CHECK(Paste{} == Paste{});
}

TEST_CASE("only the only_material mask has a material", "[edits]") {
  EditDescriptor edit = kVoxel;
  edit.mask = {MaskKind::only_material, 9};
  CHECK(validate(edit).has_value());
  edit.mask.kind = MaskKind::only_solid;
  CHECK(error_of(edit) == ErrorCode::bad_value);
  edit.mask = {static_cast<MaskKind>(4), 0};
  CHECK(error_of(edit) == ErrorCode::bad_value);
}

TEST_CASE("masks admit the voxels that their names describe", "[edits]") {
  const auto admits = [](MaskKind kind, Material material, Material present) {
    return Mask{kind, material}.admits(present);
  };
  for (const Material present : std::initializer_list<Material>{0, 1, 7, 65535}) {
    CHECK(admits(MaskKind::everything, 0, present));
    CHECK(admits(MaskKind::only_empty, 0, present) == (present == 0));
    CHECK(admits(MaskKind::only_solid, 0, present) == (present != 0));
    CHECK(admits(MaskKind::only_material, 7, present) == (present == 7));
  }
}

TEST_CASE("unknown kinds, long varints and out-of-range fields are rejected", "[edits]") {
  CHECK(decode_error({}) == ErrorCode::truncated);
  for (const std::uint8_t tag : Bytes{0, 5, 7, 255}) {
    CHECK(decode_error({tag, 0, 4, 0, 0, 0}) == ErrorCode::unknown_kind);
  }
  CHECK(decode_error({1, 4, 4, 0, 0, 0}) == ErrorCode::unknown_kind);
  CHECK(decode_error({1, 0, 0x84, 0x00, 0, 0, 0}) == ErrorCode::not_canonical);
  CHECK(decode_error({1, 0, 0x80, 0x80, 0x04, 0, 0, 0}) ==
        ErrorCode::bad_value);  // material 65,536
  CHECK(decode_error({1, 0, 4, 0x80, 0x80, 0x80, 0x80, 0x04, 0, 0}) ==
        ErrorCode::bad_value);                                                        // x = 2^29
  CHECK(decode_error({2, 0, 4, 0, 0, 0, 0x80, 0x20, 0, 0}) == ErrorCode::bad_value);  // side 4097
  CHECK(decode_error({3, 0, 4, 0, 0, 0, 0x81, 0x04}) == ErrorCode::bad_value);        // radius 513
  CHECK(decode_error({4, 0, 4, 0x81, 0x04, 0, 0, 0, 0, 2, 0, 0}) ==
        ErrorCode::bad_value);                                                     // radius 513
  CHECK(decode_error({4, 0, 4, 0, 0, 0, 0, 0, 2, 0, 0}) == ErrorCode::bad_value);  // radius 0
  CHECK(decode_error({4, 0, 4, 1, 0, 0, 0, 0, 0, 0, 0}) == ErrorCode::bad_value);  // the same point
  CHECK(decode_error({4, 0, 4, 1, 0xff, 0x01, 0, 0, 0, 2, 0, 0}) ==
        ErrorCode::bad_value);  // 257 points
  CHECK(decode_error({4, 0, 4, 1, 0, 0, 0, 0, 0x82, 0x10, 0, 0}) ==
        ErrorCode::bad_value);  // step 1,025
  CHECK(decode_error({4, 0, 4, 1, 1, 0, 0, 0, 2, 0, 0}) ==
        ErrorCode::truncated);  // one point too few
  // Every field is in range, but the box ends beyond the world.
  CHECK(decode_error({2, 0, 4, 0xfe, 0xff, 0xff, 0xff, 0x03, 0, 0, 1, 0, 0}) ==
        ErrorCode::bad_value);
}

TEST_CASE("descriptors round trip, and every truncation and extra byte is rejected", "[edits]") {
  SplitMix64 rng{11};
  std::size_t longest = 0;
  for (int round = 0; round < 3000; ++round) {
    const EditDescriptor edit = random_edit_anywhere(rng);
    CAPTURE(edit);
    Bytes bytes = encode(edit);
    longest = std::max(longest, bytes.size());
    const auto back = decode_descriptor(bytes);
    REQUIRE(back.has_value());
    REQUIRE(*back == edit);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      REQUIRE_FALSE(decode_descriptor(ByteView(bytes).first(size)).has_value());
    }
    bytes.push_back(0);
    REQUIRE(decode_error(bytes) == ErrorCode::trailing_bytes);
  }
  CHECK(longest <= kDescriptorBytesMax);
}

TEST_CASE("flipped descriptor bytes are rejected or decode to a descriptor that encodes to them",
          "[edits]") {
  SplitMix64 rng{12};
  std::size_t survivors = 0;
  for (int round = 0; round < 400; ++round) {
    const Bytes bytes = encode(random_edit_anywhere(rng));
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
      Bytes flipped = bytes;
      flipped[bit / 8] = static_cast<std::uint8_t>(flipped[bit / 8] ^ (1u << (bit % 8)));
      const auto edit = decode_descriptor(flipped);
      if (!edit) continue;
      ++survivors;
      REQUIRE(validate(*edit).has_value());
      REQUIRE(encode(*edit) == flipped);
    }
  }
  CHECK(survivors > 0);  // most fields have other valid values, so the check above ran
}

TEST_CASE("records round trip, and every truncation and extra byte is rejected", "[edits]") {
  SplitMix64 rng{13};
  for (int round = 0; round < 1000; ++round) {
    const EditRecord record = random_record(rng);
    Bytes bytes = encode_record(record);
    const auto back = decode_record(bytes);
    REQUIRE(back.has_value());
    REQUIRE(*back == record);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      REQUIRE_FALSE(decode_record(ByteView(bytes).first(size)).has_value());
    }
    bytes.push_back(0);
    REQUIRE_FALSE(decode_record(bytes).has_value());
  }
}

TEST_CASE("flipped record bytes are rejected or decode to a record that encodes to them",
          "[edits]") {
  SplitMix64 rng{14};
  std::size_t survivors = 0;
  for (int round = 0; round < 200; ++round) {
    const EditRecord record = random_record(rng);
    const Bytes bytes = encode_record(record);
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
      Bytes flipped = bytes;
      flipped[bit / 8] = static_cast<std::uint8_t>(flipped[bit / 8] ^ (1u << (bit % 8)));
      const auto other = decode_record(flipped);
      if (!other) continue;
      ++survivors;
      REQUIRE(encode_record(*other) == flipped);
    }
  }
  CHECK(survivors > 0);
}

TEST_CASE("the longest stroke fits the bound of its kind", "[edits]") {
  FillStroke stroke{{{-kWorldLimit + 512, kWorldLimit - 513 - 1024, -kWorldLimit + 512}}, 512};
  while (stroke.points.size() < kStrokePointsMax) {
    const VoxelPos& last = stroke.points.back();
    const std::int32_t up = stroke.points.size() % 2 == 0 ? -1024 : 1024;
    stroke.points.push_back({last.x + 1024, last.y + up, last.z + 1024});
  }
  Bytes bytes = encode({stroke, {MaskKind::only_material, 65535}, 65535});
  CHECK(bytes.size() == 1557);
  const auto back = decode_descriptor(bytes);
  REQUIRE(back.has_value());
  CHECK(std::get<FillStroke>(back->shape) == stroke);
  bytes.resize(descriptor_bytes_max(EditKind::fill_stroke), 0);
  CHECK(decode_error(bytes) == ErrorCode::trailing_bytes);
  bytes.push_back(0);
  CHECK(decode_error(bytes) == ErrorCode::limit_exceeded);
}

TEST_CASE("descriptors of the small kinds have at most 64 bytes, wherever they lie", "[edits]") {
  Bytes bytes = encode(kVoxel);
  bytes.resize(descriptor_bytes_max(EditKind::set_voxel), 0);
  CHECK(decode_error(bytes) == ErrorCode::trailing_bytes);
  bytes.push_back(0);
  CHECK(decode_error(bytes) == ErrorCode::limit_exceeded);
}

TEST_CASE("a record has room for descriptors of later kinds, up to its own bound", "[edits]") {
  const EditRecord record = {{1, 1}, {1, 2, 3}, 4, Cause::player, kVoxel};
  const Bytes descriptor = encode(kVoxel);
  const auto with_descriptor_of = [&](std::size_t size, std::uint8_t kind) {
    Bytes bytes = encode_record(record);
    bytes.resize(bytes.size() - descriptor.size() - 1);
    ByteWriter w(bytes);
    w.varint(size);
    w.u8(kind);
    bytes.resize(bytes.size() + size - 1, 0);
    const auto decoded = decode_record(bytes);
    REQUIRE_FALSE(decoded.has_value());
    return decoded.error();
  };
  constexpr std::uint8_t kLater = 15;
  CHECK(with_descriptor_of(65, 1).code == ErrorCode::limit_exceeded);  // the kind's bound
  // The length is allowed; this build does not know the kind.
  CHECK(with_descriptor_of(65, kLater).code == ErrorCode::unknown_kind);
  CHECK(with_descriptor_of(kRecordDescriptorBytesMax, kLater).code == ErrorCode::unknown_kind);
  const Error error = with_descriptor_of(kRecordDescriptorBytesMax + 1, kLater);
  CHECK(error.code == ErrorCode::bad_value);
  CHECK(error.what == std::string("descriptor too long"));
}

TEST_CASE("a change of rights is an edit without voxels", "[edits]") {
  const EditDescriptor grant = rights_edit(GrantRole{{}, kModeratorRole});
  const VoxelBox box{{-3, 0, 5}, {4, 9, 40}};
  ProtectedBox spawn;
  spawn.name = "spawn";
  spawn.box = box;
  const EditDescriptor protect = rights_edit(Protect{spawn});
  for (const EditDescriptor& edit : {grant, protect}) {
    const auto decoded = decode_descriptor(encode(edit));
    REQUIRE(decoded.has_value());
    CHECK(*decoded == edit);
    CHECK_FALSE(decode_voxel_edit(encode(edit)).has_value());
    CHECK(touched_chunks(edit, 16).empty());
    CHECK(touched_chunks_bound(edit, 16) == 0);
    CHECK(counted_voxels(edit) == 0);
    CHECK_FALSE(touches(edit, box));
    std::vector<IndexSpan> spans;
    append_spans(edit, {0, 0, 0}, Extent::cube(16), AxisOrder::xyz, spans);
    CHECK(spans.empty());
  }
  CHECK(bounding_box(protect) == box);
  CHECK(bounding_box(grant).empty());
  CHECK(error_of({grant.shape, {}, 1}) == ErrorCode::bad_value);
  CHECK(error_of({grant.shape, {MaskKind::only_empty, kEmpty}, kEmpty}) == ErrorCode::bad_value);
  CHECK(error_of({RightsEdit{}, {}, kEmpty}) == ErrorCode::bad_value);
}

TEST_CASE("new materials are an edit without voxels", "[edits]") {
  const EditDescriptor wool = materials_edit({35, {{"wool", {1, 2, 3, 255}, Visibility::opaque}}});
  const auto decoded = decode_descriptor(encode(wool));
  REQUIRE(decoded.has_value());
  CHECK(*decoded == wool);
  CHECK_FALSE(decode_voxel_edit(encode(wool)).has_value());
  CHECK_FALSE(has_voxels(wool));
  CHECK(touched_chunks(wool, 16).empty());
  CHECK(touched_chunks_bound(wool, 16) == 0);
  CHECK(counted_voxels(wool) == 0);
  CHECK(bounding_box(wool).empty());
  CHECK_FALSE(touches(wool, {{-9, -9, -9}, {9, 9, 9}}));
  std::vector<IndexSpan> spans;
  append_spans(wool, {0, 0, 0}, Extent::cube(16), AxisOrder::xyz, spans);
  CHECK(spans.empty());
  CHECK(memory_bytes(wool) > sizeof(EditDescriptor));
  CHECK(error_of({wool.shape, {}, 1}) == ErrorCode::bad_value);
  CHECK(error_of({wool.shape, {MaskKind::only_empty, kEmpty}, kEmpty}) == ErrorCode::bad_value);
  CHECK(error_of({MaterialsEdit{}, {}, kEmpty}) == ErrorCode::bad_value);
}

TEST_CASE("the cause of a record is that of its edit", "[edits]") {
  const EditDescriptor grant = rights_edit(GrantRole{{}, kModeratorRole});
  CHECK(validate_fields({{1, 1}, {}, 0, Cause::rights, grant}).has_value());
  CHECK_FALSE(validate_fields({{1, 1}, {}, 0, Cause::console, grant}).has_value());
  CHECK_FALSE(validate_fields({{1, 1}, {}, 0, Cause::rights, kVoxel}).has_value());
  const EditDescriptor wool = materials_edit({35, {{"wool", {1, 2, 3, 255}, {}}}});
  CHECK(validate_fields({{1, 1}, {}, 0, Cause::materials, wool}).has_value());
  for (const Cause other : {Cause::console, Cause::rights})
    CHECK_FALSE(validate_fields({{1, 1}, {}, 0, other, wool}).has_value());
  for (const EditDescriptor& edit : {kVoxel, grant})
    CHECK_FALSE(validate_fields({{1, 1}, {}, 0, Cause::materials, edit}).has_value());
  const EditDescriptor slab = shapes_edit({{{35, {ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}}}}}});
  CHECK(validate_fields({{1, 1}, {}, 0, Cause::materials, slab}).has_value());
  CHECK_FALSE(validate_fields({{1, 1}, {}, 0, Cause::console, slab}).has_value());
  const EditDescriptor gone = library_edit(RemoveBuild{7});
  CHECK(validate_fields({{1, 1}, {}, 0, Cause::library, gone}).has_value());
  CHECK_FALSE(validate_fields({{1, 1}, {}, 0, Cause::console, gone}).has_value());
  CHECK_FALSE(validate_fields({{1, 1}, {}, 0, Cause::library, wool}).has_value());
}

TEST_CASE("a record's numbers stay within 63 bits and its subject before itself", "[edits]") {
  EditRecord record = {
      {1, kSequenceMax}, {1, 2, kSequenceMax}, 4, Cause::undo, kVoxel, kSequenceMax - 1, ~0U};
  const auto good = decode_record(encode_record(record));
  REQUIRE(good.has_value());
  CHECK(*good == record);
  const auto broken = [](EditRecord bad, const char* what) {
    const auto numbers = validate_fields(bad);
    return !numbers && numbers.error().what == std::string(what);
  };
  record.subject = record.version.seq;
  CHECK(broken(record, "subject is not an earlier edit"));
  record.subject = 0;
  record.op.seq = kSequenceMax + 1;
  CHECK(broken(record, "client sequence exceeds 63 bits"));
  record.op.seq = 0;
  record.version.seq = kSequenceMax + 1;
  CHECK(broken(record, "sequence exceeds 63 bits"));
  record.version.seq = 0;
  CHECK(broken(record, "sequence 0 is the base, not an edit"));

  // The bytes are the version byte, then log, epoch, sequence, author, instance, client sequence,
  // time, cause, subject.
  const auto decoded = [](std::uint64_t seq, std::uint64_t client_seq, std::uint64_t subject) {
    Bytes bytes;
    ByteWriter w(bytes);
    w.u8(kEditRecordVersion);
    w.varint(0);
    w.varint(1);
    w.varint(seq);
    w.varint(1);
    w.u64(2);
    w.varint(client_seq);
    w.svarint(4);
    w.u8(static_cast<std::uint8_t>(Cause::undo));
    w.varint(subject);
    for (const std::int64_t c : {1, 2, 3}) w.svarint(c);
    for (int axis = 0; axis < 3; ++axis) w.varint(1);
    const Bytes descriptor = encode(kVoxel);
    w.varint(descriptor.size());
    w.bytes(descriptor);
    const auto back = decode_record(bytes);
    return back ? std::string("good") : back.error().what;
  };
  CHECK(decoded(9, 3, 8) == "good");
  CHECK(decoded(kSequenceMax, kSequenceMax, 0) == "good");
  CHECK(decoded(9, 3, 9) == "subject is not an earlier edit");
  CHECK(decoded(9, 3, ~std::uint64_t{0}) == "subject is not an earlier edit");
  CHECK(decoded(9, kSequenceMax + 1, 0) == "client sequence exceeds 63 bits");
  CHECK(decoded(kSequenceMax + 1, 3, 0) == "sequence exceeds 63 bits");
}

TEST_CASE("a record's version, sequence, cause and box are checked", "[edits]") {
  const EditRecord record = {{1, 1}, {1, 2, 3}, 4, Cause::player, kVoxel};
  const Bytes good = encode_record(record);
  REQUIRE(decode_record(good).has_value());
  // version 0, log 1, epoch 2, seq 3, author 4, instance 5 .. 12, client seq 13, time 14, cause 15,
  // subject 16, box 17 .. 22
  const auto error_with = [&good](std::size_t at, std::uint8_t byte) {
    Bytes bad = good;
    bad[at] = byte;
    const auto result = decode_record(bad);
    REQUIRE_FALSE(result.has_value());
    return result.error().code;
  };
  CHECK(error_with(0, 2) == ErrorCode::bad_version);
  CHECK(error_with(0, 0) == ErrorCode::bad_version);
  CHECK(error_with(3, 0) == ErrorCode::bad_value);
  CHECK(error_with(15, 6) == ErrorCode::bad_value);
  CHECK(error_with(16, 1) == ErrorCode::bad_value);  // edit 1 refers to itself
  CHECK(error_with(17, 4) == ErrorCode::bad_value);  // box one voxel off
  CHECK(error_with(20, 2) == ErrorCode::bad_value);  // box one voxel longer
  CHECK(error_with(23, 5) == ErrorCode::trailing_bytes);
  CHECK(error_with(24, 15) == ErrorCode::unknown_kind);
}

}  // namespace runstone::test
