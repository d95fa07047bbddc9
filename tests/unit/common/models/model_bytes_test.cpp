#include "common/models/model_bytes.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>

#include "common/models/printable_line.hpp"

using namespace runstone;

namespace {

constexpr std::size_t kBytesMax = std::size_t{1} << 20;
// Places of fields in the bytes.
constexpr std::size_t kPositions = 6, kTriangles = 10, kNotices = 22, kFirstPosition = 34;

ReadModel painted_triangles() {
  ReadModel read;
  Model& m = read.model;
  m.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2.5F, 0}, {0, 0, -1}};
  m.texture_places = {{0, 0}, {1, 0}, {0, 1}, {-3, 0.5F}};
  m.colours = {{1, 2, 3, 255}, {4, 5, 6, 7}, {8, 9, 10, 11}, {12, 13, 14, 15}};
  m.triangles = {{0, 1, 2}, {3, 2, 1}};
  m.material_of = {1, 0};
  m.materials = {{"brick", {200, 100, 50, 255}, 0}, {"", {1, 2, 3, 4}, std::nullopt}};
  m.textures = {{2, 1, {1, 2, 3, 4, 5, 6, 7, 8}}};
  m.metres_per_unit = 0.01;
  read.notices = {"one", "two"};
  return read;
}

Bytes encoded(const ReadModel& read) {
  Bytes out;
  REQUIRE(encode_model(read, [&out](ByteView bytes) {
    out.insert(out.end(), bytes.begin(), bytes.end());
    return true;
  }));
  return out;
}

Result<ReadModel> decoded(ByteView bytes, std::size_t bytes_max = kBytesMax) {
  return decode_model(
      [&bytes](std::span<std::uint8_t> to) {
        if (to.size() > bytes.size()) return false;
        std::copy_n(bytes.begin(), to.size(), to.begin());
        bytes = bytes.subspan(to.size());
        return true;
      },
      bytes_max);
}

void set_u32(Bytes& bytes, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

}  // namespace

TEST_CASE("a model comes through its bytes unchanged", "[models]") {
  const ReadModel read = painted_triangles();
  const auto again = decoded(encoded(read));
  REQUIRE(again.has_value());
  const Model& a = read.model;
  const Model& b = again->model;
  CHECK(a.positions == b.positions);
  CHECK(a.texture_places == b.texture_places);
  CHECK(a.colours == b.colours);
  CHECK(a.triangles == b.triangles);
  CHECK(a.material_of == b.material_of);
  REQUIRE(b.materials.size() == 2);
  CHECK(b.materials[0].name == "brick");
  CHECK(b.materials[0].colour == ModelColour{200, 100, 50, 255});
  CHECK(b.materials[0].texture == 0U);
  CHECK_FALSE(b.materials[1].texture.has_value());
  REQUIRE(b.textures.size() == 1);
  CHECK(b.textures[0].texels == a.textures[0].texels);
  CHECK(b.metres_per_unit == 0.01);
  CHECK(again->notices == read.notices);
}

TEST_CASE("the bytes of a model of one point are pinned", "[models]") {
  ReadModel read;
  read.model.positions = {{1, 2, -0.5F}};
  const Bytes expected = {'R', 'S', 'M', 'B', 1,    0,    1, 0, 0, 0,    0, 0, 0, 0,   0, 0,
                          0,   0,   0,   0,   0,    0,    0, 0, 0, 0,    0, 0, 0, 0,   0, 0,
                          0,   0,   0,   0,   0x80, 0x3f, 0, 0, 0, 0x40, 0, 0, 0, 0xbf};
  CHECK(encoded(read) == expected);
}

TEST_CASE("a large model is written in pieces and read again", "[models]") {
  ReadModel read;
  for (std::uint32_t i = 0; i < 50'000; ++i) {
    read.model.positions.push_back({static_cast<float>(i), 1, 2});
    read.model.colours.push_back({static_cast<std::uint8_t>(i), 0, 0, 255});
    read.model.triangles.push_back({i, 0, 49'999 - i});
    read.model.material_of.push_back(0);
  }
  read.model.materials.resize(1);
  std::size_t largest = 0;
  REQUIRE(encode_model(read, [&largest](ByteView bytes) {
    largest = std::max(largest, bytes.size());
    return true;
  }));
  CHECK(largest == 64 * 1024);
  const auto again = decoded(encoded(read), std::size_t{8} << 20);
  REQUIRE(again.has_value());
  CHECK(again->model.positions == read.model.positions);
  CHECK(again->model.colours == read.model.colours);
  CHECK(again->model.triangles == read.model.triangles);
}

TEST_CASE("encoding ends when the bytes cannot be written", "[models]") {
  int calls = 0;
  CHECK_FALSE(encode_model(painted_triangles(), [&calls](ByteView) {
    ++calls;
    return false;
  }));
  CHECK(calls == 1);
}

TEST_CASE("every cut of a model's bytes is noticed", "[models]") {
  const Bytes whole = encoded(painted_triangles());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    CAPTURE(size);
    const auto read = decoded(ByteView(whole).first(size));
    REQUIRE_FALSE(read.has_value());
    CHECK(read.error().code == ErrorCode::truncated);
  }
}

TEST_CASE("every changed byte of a model gives a valid model or an error", "[models]") {
  const Bytes whole = encoded(painted_triangles());
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const int value : {0, 1, 127, 128, 255}) {
      Bytes bytes = whole;
      bytes[at] = static_cast<std::uint8_t>(value);
      const auto read = decoded(bytes);
      if (read) CHECK(validate(read->model).has_value());
    }
  }
}

TEST_CASE("a model of hostile bytes is rejected before memory is taken", "[models]") {
  Bytes bytes = encoded(painted_triangles());
  const auto code_of = [&bytes](std::size_t bytes_max = kBytesMax) {
    const auto read = decoded(bytes, bytes_max);
    REQUIRE_FALSE(read.has_value());
    return read.error().code;
  };
  SECTION("huge counts") {
    const std::size_t field = GENERATE(kPositions, kTriangles, kNotices);
    set_u32(bytes, field, 0xffffffff);
    CHECK(code_of() == ErrorCode::limit_exceeded);
  }
  SECTION("more positions than the limit of bytes allows") {
    set_u32(bytes, kPositions, 90'000'000);
    CHECK(code_of() == ErrorCode::limit_exceeded);
  }
  SECTION("more bytes than allowed") { CHECK(code_of(100) == ErrorCode::limit_exceeded); }
  SECTION("a position that is not finite") {
    set_u32(bytes, kFirstPosition, 0x7f800000);
    CHECK(code_of() == ErrorCode::bad_value);
  }
  SECTION("another version") {
    bytes[4] = 2;
    CHECK(code_of() == ErrorCode::bad_version);
  }
  SECTION("unknown flags") {
    bytes[5] = 0xff;
    CHECK(code_of() == ErrorCode::bad_value);
  }
  SECTION("a notice that controls the terminal") {
    bytes.back() = 27;
    CHECK(code_of() == ErrorCode::bad_value);
  }
}

TEST_CASE("texts of files become printable lines", "[models]") {
  CHECK(printable_line("oak wood", 64) == "oak wood");
  CHECK(printable_line("a\n\x1b[1mb\xff", 64) == "a??[1mb?");
  CHECK(printable_line("M\xc3\xbcller", 64) == "M\xc3\xbcller");
  CHECK(printable_line("M\xc3\xbcller", 2) == "M");
  CHECK(printable_line("cut \xe2\x82", 64) == "cut ??");
  CHECK(printable_line("\xf0\x9f\x98\x80\xf0\x9f\x98\x80", 5) == "\xf0\x9f\x98\x80");
  CHECK(printable_line("", 64).empty());
  CHECK(printable_line("abc", 0).empty());
}
