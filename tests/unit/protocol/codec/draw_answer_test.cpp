#include "protocol/codec/draw_answer.hpp"

#include <catch2/catch.hpp>

namespace runstone {
namespace {

std::optional<DrawAnswer> back(const DrawAnswer& answer) {
  std::string line = to_line(answer);
  REQUIRE(line.back() == '\n');
  line.pop_back();
  return parse_draw_answer(line);
}

}  // namespace

TEST_CASE("draw answers have pinned lines, and come back from them", "[protocol]") {
  CHECK(to_line(DrawReady{1, "EGL surfaceless"}) == "ready 1 EGL surfaceless\n");
  CHECK(to_line(PictureDrawn{12, 3, 4567, "a b.png"}) ==
        "drawn quads=12 chunks=3 us=4567 a b.png\n");
  CHECK(to_line(PictureUnwritten{"a b.png: cannot be written: Permission denied"}) ==
        "unwritten a b.png: cannot be written: Permission denied\n");
  CHECK(to_line(DrawFailed{"no memory"}) == "error no memory\n");
  for (const DrawAnswer& answer :
       {DrawAnswer{DrawReady{7, "x"}}, DrawAnswer{PictureDrawn{0, 1, 2, "f \xc3\xbc"}},
        DrawAnswer{PictureUnwritten{"g"}}, DrawAnswer{DrawFailed{"a: b"}}}) {
    CHECK(back(answer) == answer);
  }
}

TEST_CASE("unprintable bytes of an answer become blanks, and long text is cut", "[protocol]") {
  CHECK(back(DrawFailed{"two\nlines\x80"}) == DrawAnswer{DrawFailed{"two lines "}});
  const std::string line = to_line(DrawFailed{std::string(20'000, 'x')});
  CHECK(line.size() == kDrawAnswerBytesMax);
  CHECK(back(DrawFailed{std::string(20'000, 'x')}).has_value());
}

TEST_CASE("other lines are no answers", "[protocol]") {
  for (const char* line :
       {"", "ready", "ready 1", "ready x EGL", "ready -1 EGL", "ready 4294967296 EGL", "drawn",
        "error", "Error x", "drawn quads=1 chunks=2 us=3", "drawn quads=1 chunks=2 us=3 ",
        "drawn quads=1 chunks=2 us= f", "drawn quads=+1 chunks=2 us=3 f",
        "drawn chunks=2 quads=1 us=3 f", "error a\tb", "error \xff"}) {
    CAPTURE(line);
    CHECK_FALSE(parse_draw_answer(line).has_value());
  }
  CHECK_FALSE(parse_draw_answer("error " + std::string(kDrawAnswerBytesMax, 'x')).has_value());
}

}  // namespace runstone
