#include "protocol/codec/draw_order.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <string>
#include <vector>

#include "common/core/hash.hpp"
#include "tests/support/core/hex.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

constexpr std::int32_t kEdge = 16;
const ChunkKey kKey{0, {1, -2, 3}};

MaterialTable two_materials() {
  MaterialTable table;
  GenerationRule rule;
  REQUIRE(table.add({"red", {220, 30, 30, 255}, Visibility::opaque, rule}).has_value());
  REQUIRE(table
              .add({"gl\"ass",
                    {40, 80, 255, 128},
                    Visibility::transparent,
                    {},
                    MaterialBody::solid,
                    MaterialLook{1, 2, 3, 4, MaterialPattern::weave}})
              .has_value());
  return table;
}

DrawPicture sample_picture() {
  DrawPicture picture;
  picture.camera = {1.5, -2, 300.25, 0.5, -0.25, 1.25, 0.5, 800};
  picture.size = {640, 360};
  picture.file = "frames/bild 1 \xc3\xbc.png";
  return picture;
}

RunChunk sample_voxels() {
  SplitMix64 rng(7);
  return random_chunk(rng, Extent::cube(kEdge), AxisOrder::xzy, 3, ChunkShape::boxes);
}

Bytes world() {
  Bytes out;
  append_draw_world(kEdge, two_materials(), out);
  return out;
}

Bytes whole_stream() {
  Bytes out = world();
  append_draw_chunk(kKey, sample_voxels(), out);
  append_draw_forget(kKey, out);
  append_draw_picture(sample_picture(), out);
  append_draw_end(out);
  return out;
}

struct Outcome {
  std::vector<DrawOrder> orders;
  std::optional<Error> error;  // of feed() or finish()
};

Outcome read(ByteView stream, std::size_t piece = ~std::size_t{0}) {
  Outcome out;
  DrawOrderReader reader;
  while (!stream.empty()) {
    const ByteView part = stream.first(std::min(piece, stream.size()));
    stream = stream.subspan(part.size());
    const auto fed = reader.feed(part, [&](DrawOrder order) -> Result<void> {
      out.orders.push_back(std::move(order));
      return {};
    });
    if (!fed) {
      CHECK(reader.feed({}, nullptr).error() == fed.error());
      CHECK(reader.finish().error() == fed.error());
      out.error = fed.error();
      return out;
    }
  }
  if (const auto done = reader.finish(); !done) out.error = done.error();
  return out;
}

/// Returns the error of a frame that follows a valid world.
Error error_after_world(const Bytes& frame) {
  Bytes stream = world();
  const std::size_t at = stream.size();
  stream.insert(stream.end(), frame.begin(), frame.end());
  const Outcome outcome = read(stream);
  REQUIRE(outcome.error.has_value());
  CHECK(outcome.error->offset == at);
  return *outcome.error;
}

Error picture_error(const DrawPicture& picture) {
  const auto sound = validate(picture);
  REQUIRE_FALSE(sound.has_value());
  return sound.error();
}

}  // namespace

TEST_CASE("draw orders come back unchanged, however the stream is cut", "[protocol]") {
  const std::size_t piece = GENERATE(std::size_t{1}, 3, 4096, 1 << 20);
  const Outcome outcome = read(whole_stream(), piece);
  CAPTURE(piece, outcome.error ? outcome.error->what : "");
  REQUIRE_FALSE(outcome.error);
  REQUIRE(outcome.orders.size() == 5);
  const auto& made = std::get<DrawWorld>(outcome.orders[0]);
  CHECK(made.edge == kEdge);
  REQUIRE(made.materials.size() == 3);
  CHECK(made.materials[1].colour == two_materials()[1].colour);
  CHECK_FALSE(made.materials[1].generation);
  CHECK(made.materials[2] == two_materials()[2]);
  const auto& chunk = std::get<DrawChunk>(outcome.orders[1]);
  CHECK(chunk.key == kKey);
  CHECK(chunk.voxels == sample_voxels());
  CHECK(std::get<DrawForget>(outcome.orders[2]).key == kKey);
  const auto& picture = std::get<DrawPicture>(outcome.orders[3]);
  CHECK(picture.camera == sample_picture().camera);
  CHECK(picture.size == sample_picture().size);
  CHECK(picture.file == sample_picture().file);
}

TEST_CASE("a full table with the longest names and looks fits a draw order", "[protocol]") {
  MaterialTable table;
  for (unsigned i = 1; i < kMaterialCountMax; ++i) {
    const std::string digits = std::to_string(i);
    // Quotation marks take two bytes each in the text of the table.
    MaterialInfo info{std::string(kMaterialNameBytesMax - digits.size(), '"') + digits,
                      {1, 2, 3, 4},
                      Visibility::transparent,
                      GenerationRule{},
                      MaterialBody::passable,
                      MaterialLook{99, 99, 99, 99, MaterialPattern::planks}};
    REQUIRE(table.add(std::move(info)).has_value());
  }
  Bytes out;
  append_draw_world(kEdge, table, out);
  CHECK(out.size() <= kDrawHeaderBytes + kDrawBodyBytesMax);
}

TEST_CASE("the bytes of draw orders are pinned", "[protocol]") {
  Bytes out;
  append_draw_forget(kKey, out);
  DrawPicture picture;
  picture.camera = {1, 0, 0, 0, 0, 1.5, 0.5, 1024};
  picture.size = {16, 258};
  picture.file = "a.png";
  append_draw_picture(picture, out);
  append_draw_end(out);
  CHECK(to_hex(out) ==
        "0d00000003"
        "00"
        "01000000"
        "feffffff"
        "03000000"
        "4900000004"
        "000000000000f03f"
        "0000000000000000"
        "0000000000000000"
        "0000000000000000"
        "0000000000000000"
        "000000000000f83f"
        "000000000000e03f"
        "0000000000009040"
        "1000"
        "0201"
        "612e706e67"
        "0000000005");
  const Bytes head = world();
  CHECK(to_hex(ByteView(head).subspan(4, 3)) == "010210");
}

TEST_CASE("a truncated stream of orders is an error, and no incomplete order is delivered",
          "[protocol]") {
  const Bytes stream = whole_stream();
  for (std::size_t size = 0; size < stream.size(); ++size) {
    CAPTURE(size);
    const Outcome outcome = read(ByteView(stream).first(size));
    REQUIRE(outcome.error);
    CHECK(outcome.error->code == ErrorCode::truncated);
    CHECK(outcome.orders.size() < 5);
  }
  Bytes longer = stream;
  longer.push_back(0);
  CHECK(read(longer).error->code == ErrorCode::trailing_bytes);
}

TEST_CASE("a flipped byte never gives an order outside its limits", "[protocol]") {
  const Bytes stream = whole_stream();
  for (std::size_t i = 0; i < stream.size(); ++i) {
    Bytes bad = stream;
    bad[i] ^= 0x81;
    for (const DrawOrder& order : read(bad, 4096).orders) {
      if (const auto* chunk = std::get_if<DrawChunk>(&order)) {
        CHECK(validate(chunk->voxels).has_value());
        CHECK(chunk->voxels.extent == Extent::cube(kEdge));
      }
      if (const auto* picture = std::get_if<DrawPicture>(&order))
        CHECK(validate(*picture).has_value());
    }
  }
}

TEST_CASE("frames with an invalid header are refused, with the offset of their first byte",
          "[protocol]") {
  CHECK(error_after_world(from_hex("0000000000")).code == ErrorCode::unknown_kind);
  CHECK(error_after_world(from_hex("0000000006")).code == ErrorCode::unknown_kind);
  CHECK(error_after_world(from_hex("0100800102")).code == ErrorCode::limit_exceeded);
  CHECK(error_after_world(from_hex("ffffffff02")).code == ErrorCode::limit_exceeded);
  CHECK(error_after_world(world()).code == ErrorCode::broken_invariant);
  CHECK(error_after_world(from_hex("01000000 05 00")).code == ErrorCode::trailing_bytes);
  // Keys: level of detail, and a chunk beyond the world's end at edge 16.
  CHECK(error_after_world(from_hex("0d00000003 01 00000000 00000000 00000000")).code ==
        ErrorCode::bad_value);
  CHECK(error_after_world(from_hex("0d00000003 00 00000002 00000000 00000000")).code ==
        ErrorCode::bad_value);
  CHECK(error_after_world(from_hex("0e00000003 00 00000000 00000000 00000000 00")).code ==
        ErrorCode::trailing_bytes);
  Bytes end;
  append_draw_end(end);
  CHECK(read(end).error->code == ErrorCode::broken_invariant);  // the world must come first
  // A chunk whose edge is not that of the world.
  Bytes chunk;
  append_draw_chunk(kKey, uniform_chunk(Extent::cube(32), 1), chunk);
  error_after_world(chunk);
}

TEST_CASE("a world of another version, edge or material table is refused", "[protocol]") {
  const Bytes good = world();
  for (const auto& [at, value, code] :
       {std::tuple{5, 1, ErrorCode::bad_version}, std::tuple{6, 24, ErrorCode::bad_value},
        std::tuple{6, 0, ErrorCode::bad_value}, std::tuple{7, int{'@'}, ErrorCode::bad_value}}) {
    Bytes bad = good;
    bad[static_cast<std::size_t>(at)] = static_cast<std::uint8_t>(value);
    CAPTURE(at, value);
    const Outcome outcome = read(bad);
    REQUIRE(outcome.error);
    CHECK(outcome.error->code == code);
    CHECK(outcome.orders.empty());
  }
}

TEST_CASE("a picture outside its limits is refused, and the error names the field", "[protocol]") {
  CHECK(validate(sample_picture()).has_value());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto with = [](auto change) {
    DrawPicture picture = sample_picture();
    change(picture);
    return std::string(picture_error(picture).what);
  };
  CHECK(with([&](DrawPicture& p) { p.camera.y = nan; }).find("eye") != std::string::npos);
  CHECK(with([](DrawPicture& p) { p.camera.x = 3e9; }).find("eye") != std::string::npos);
  CHECK(with([&](DrawPicture& p) { p.camera.yaw = nan; }).find("yaw") != std::string::npos);
  CHECK(with([](DrawPicture& p) { p.camera.fov_y = 3.2; }).find("field of view") !=
        std::string::npos);
  CHECK(with([](DrawPicture& p) { p.camera.near = 0; }).find("near and far") != std::string::npos);
  CHECK(with([](DrawPicture& p) { p.camera.far = p.camera.near; }).find("near and far") !=
        std::string::npos);
  CHECK(with([](DrawPicture& p) { p.camera.far = 2e6; }).find("near and far") != std::string::npos);
  CHECK(with([](DrawPicture& p) { p.size.width = 15; }).find("pixels") != std::string::npos);
  CHECK(with([](DrawPicture& p) { p.size.height = 8193; }).find("pixels") != std::string::npos);
  CHECK(with([](DrawPicture& p) { p.file.clear(); }).find("file name") != std::string::npos);
  CHECK(with([](DrawPicture& p) { p.file = "a\nb"; }).find("file name") != std::string::npos);
  CHECK(with([](DrawPicture& p) { p.file.assign(4097, 'a'); }).find("file name") !=
        std::string::npos);
}

TEST_CASE("an error of the handler ends the reading", "[protocol]") {
  DrawOrderReader reader;
  int taken = 0;
  const auto refuse = [&](DrawOrder) -> Result<void> {
    ++taken;
    return fail(ErrorCode::limit_exceeded, "enough");
  };
  CHECK_FALSE(reader.feed(whole_stream(), refuse).has_value());
  CHECK_FALSE(reader.feed(whole_stream(), refuse).has_value());
  CHECK(taken == 1);
}

}  // namespace runstone::test
