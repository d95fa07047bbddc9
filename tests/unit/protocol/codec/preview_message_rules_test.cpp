// Which values are refused of shared previews.
#include <string>

#include "tests/unit/protocol/codec/built_message.hpp"

namespace runstone::test {
namespace {

const EditDescriptor kPreviewed{SetVoxel{{1, 2, 3}}, {}, 1};

Bytes with_length(const Bytes& descriptor) {
  Bytes out = varints({descriptor.size()});
  return joined(std::move(out), descriptor);
}

Bytes list_of(std::size_t count) {
  Bytes out;
  for (std::size_t i = 0; i < count; ++i)
    out = joined(std::move(out), with_length(encode(kPreviewed)));
  return out;
}

bool passes_list(const Bytes& list) {
  return passes<PreviewShare>(
      [&](FlatBufferBuilder& b) { return wire::CreatePreviewShare(b, b.CreateVector(list)); });
}

}  // namespace

TEST_CASE("a preview has up to four whole valid edits, and nothing behind them", "[protocol]") {
  CHECK(passes<PreviewShare>([](FlatBufferBuilder& b) { return wire::CreatePreviewShare(b); }));
  for (std::size_t count = 0; count <= kPreviewEditsMax; ++count)
    CHECK(passes_list(list_of(count)));
  CHECK_FALSE(passes_list(list_of(kPreviewEditsMax + 1)));
  const Bytes one = list_of(1);
  for (std::size_t size = 1; size < one.size(); ++size)
    CHECK_FALSE(passes_list({one.begin(), one.begin() + static_cast<std::ptrdiff_t>(size)}));
  CHECK_FALSE(passes_list(joined(one, {0})));
  CHECK_FALSE(passes_list(joined(one, {9})));
  CHECK_FALSE(passes_list(varints({kPreviewBytesMax + 1})));
  CHECK_FALSE(passes_list(Bytes(kPreviewBytesMax + 2 * kPreviewEditsMax + 1, std::uint8_t{0})));
  CHECK_FALSE(passes_list(with_length({99})));  // of an unknown kind
}

TEST_CASE("edits are shared if they are few, valid and near to each other", "[protocol]") {
  const std::vector<EditDescriptor> none;
  CHECK(may_be_shared(none, 16));
  CHECK(may_be_shared({kPreviewed, kPreviewed, kPreviewed, kPreviewed}, 16));
  CHECK_FALSE(may_be_shared(std::vector<EditDescriptor>(5, kPreviewed), 16));
  const EditDescriptor ball{FillSphere{{0, 0, 0}, 24}, {}, 1};
  CHECK(may_be_shared({ball}, 32));
  CHECK(may_be_shared({ball}, 16));
  CHECK_FALSE(may_be_shared({{FillSphere{{0, 0, 0}, 64}, {}, 1}}, 16));
  FillStroke stroke{{}, 2};
  for (std::int32_t i = 0; i < 200; ++i) stroke.points.push_back({i % 2 * 900, i % 3 * 900, i});
  CHECK_FALSE(may_be_shared({{stroke, {}, 1}}, 128));
  CHECK_FALSE(may_be_shared({{Paste{}, {}, kEmpty}}, 16));  // without a clipboard
}

namespace {

BrushStroke hill_stroke() {
  BrushStroke stroke;
  stroke.size = 32;
  stroke.strength = 4;
  stroke.material = 3;
  stroke.mask = {MaskKind::only_material, 7};
  stroke.where = "not is wood";
  stroke.mix = "70% gravel, 30% dirt";
  for (std::int32_t i = 0; i < 200; ++i) stroke.places.push_back({i, 60 + i % 3, -i / 2});
  return stroke;
}

bool passes_stroke(const Bytes& stroke, std::size_t edits = 1) {
  return passes<PreviewShare>([&](FlatBufferBuilder& b) {
    const auto list = b.CreateVector(list_of(edits));
    return wire::CreatePreviewShare(b, list, b.CreateVector(stroke));
  });
}

}  // namespace

TEST_CASE("a stroke of a preview is read back, with edits beside it", "[protocol]") {
  BrushStroke path;
  path.brush = BrushKind::path;
  path.size = 5;
  path.mode = 1;
  path.material = 2;
  path.places = {{-5, 3, kWorldLimit - 1}, {9, 3, kWorldLimit - 8}};
  for (const BrushStroke& stroke : {hill_stroke(), path}) {
    REQUIRE(check_stroke(stroke));
    const Bytes bytes = encode_stroke(stroke);
    CHECK(bytes.size() <= kPreviewStrokeBytesMax);
    const auto read = decode_stroke(bytes);
    REQUIRE(read);
    CHECK(*read == stroke);
    CHECK(passes_stroke(bytes));
    CHECK_FALSE(passes_stroke(bytes, 0));
    // A cut at the end of a place leaves a shorter stroke. Every other cut is refused.
    for (std::size_t size = 1; size < bytes.size(); ++size) {
      const auto cut = decode_stroke(ByteView(bytes).first(size));
      if (cut) CHECK(cut->places.size() < stroke.places.size());
    }
    for (std::size_t at = 0; at < bytes.size(); ++at) {
      for (const unsigned flip : {0x01U, 0x80U, 0xffU}) {
        Bytes flipped = bytes;
        flipped[at] = static_cast<std::uint8_t>(flipped[at] ^ flip);
        const auto other = decode_stroke(flipped);
        if (other) CHECK(encode_stroke(*other) == flipped);  // equal strokes have equal bytes
      }
    }
  }
}

TEST_CASE("a stroke with a value out of its range is refused with words", "[protocol]") {
  const auto why = [](auto&& change) {
    BrushStroke stroke = hill_stroke();
    change(stroke);
    const auto checked = check_stroke(stroke);
    return checked ? std::string() : std::string(checked.error().what);
  };
  using S = BrushStroke;
  CHECK(why([](S&) {}).empty());
  CHECK(why([](S& s) { s.mode = 7; }) == "stroke: unknown mode");
  CHECK(why([](S& s) { s.size = 0; }) == "stroke: a brush of this size does not exist");
  CHECK(why([](S& s) { s.size = 129; }) == "stroke: a brush of this size does not exist");
  CHECK(why([](S& s) { s.falloff = 4; }) == "stroke: unknown falloff");
  CHECK(why([](S& s) { s.strength = 0; }) == "stroke: a strength out of range");
  CHECK(why([](S& s) { s.seed = 10'000; }) == "stroke: a seed out of range");
  CHECK(why([](S& s) { s.where = std::string(1025, 'a'); }) ==
        "stroke: the filter is too long or not printable");
  CHECK(why([](S& s) { s.mix = "a\nb"; }) == "stroke: the mix is too long or not printable");
  CHECK(why([](S& s) { s.places.clear(); }) == "stroke: no place");
  CHECK(why([](S& s) { s.places.resize(257, s.places.front()); }) == "stroke: too many places");
  CHECK(why([](S& s) { s.places = {{0, kWorldLimit, 0}}; }) ==
        "stroke: a place outside of the world");
  CHECK(why([](S& s) { s.places = {{0, 0, 0}, {1025, 0, 0}}; }) ==
        "stroke: two places too far apart");
  CHECK(why([](S& s) { s.mask = {MaskKind::only_solid, 3}; }) ==
        "stroke: a mask with a material that it does not use");
  CHECK(why([](S& s) {
          s.size = 128;
          s.mode = 3;
          s.strength = 64;
        }) == "stroke: too much work for a preview");
  CHECK(why([](S& s) {
          s.brush = BrushKind::path;
          s.mode = 0;
        }) == "stroke: a path with settings of a terrain brush");
}

}  // namespace runstone::test
