#include <catch2/catch.hpp>

#include "common/core/text.hpp"

namespace runstone::test {

TEST_CASE("text from outside is well-formed UTF-8 without control characters", "[core]") {
  for (const char* good :
       {"", "a", "\x7e", "\xc2\xa0", "\xc3\xa9", "\xdf\xbf", "\xe0\xa0\x80", "\xed\x9f\xbf",
        "\xee\x80\x80", "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf", "stone \xe2\x82\xac 5"}) {
    CAPTURE(good);
    CHECK(is_printable_utf8(good));
  }
  for (const char* bad : {"\n",
                          "\x1f",
                          "\x7f",
                          "\x80",
                          "\xbf",
                          "\xc0\x80",
                          "\xc1\xbf",
                          "\xc2",
                          "\xc2\x7f",
                          "\xc2\x80",
                          "\xc2\x9f",  // C1 controls
                          "\xe0\x9f\xbf",
                          "\xe2\x82",
                          "\xe2\x82z",  // overlong, cut, broken
                          "\xed\xa0\x80",
                          "\xed\xbf\xbf",  // surrogates
                          "\xf0\x8f\xbf\xbf",
                          "\xf4\x90\x80\x80",
                          "\xf5\x80\x80\x80",
                          "\xff",
                          "\xf0\x90\x80"}) {
    CAPTURE(bad);
    CHECK_FALSE(is_printable_utf8(bad));
  }
  CHECK_FALSE(is_printable_utf8(std::string_view("\0", 1)));
}

TEST_CASE("a name can be seen, typed and quoted", "[core]") {
  for (const char* good : {"ada", "the mole", "O'Neill", "\xc3\x85sa", "\xe6\x9d\x8e",
                           "\xd9\x85\xd8\xad\xd9\x85\xd8\xaf", "\xf0\x9f\xa7\xb1 builder"}) {
    CAPTURE(good);
    CHECK(is_plain_name(good));
  }
  for (const char* bad : {"", " ada", "ada ", "a\"b", "a\\b", "a\nb",
                          "\xc3",         // cut
                          "ada\xc2\xa0",  // U+00A0, a blank that does not break
                          "ad\xe2\x80\x8b"
                          "a",  // U+200B, no width
                          "\xe2\x80\xae"
                          "nimda",                  // U+202E, right to left from here
                          "a\xe2\x81\xa6z",         // U+2066
                          "a\xef\xbb\xbfz",         // U+FEFF
                          "\xe3\x85\xa4",           // U+3164, an empty letter
                          "a\xf3\xa0\x81\x81z"}) {  // U+E0041, a tag
    CAPTURE(bad);
    CHECK_FALSE(is_plain_name(bad));
  }
}

TEST_CASE("characters that cannot be seen are found and replaced", "[core]") {
  const std::string hidden =
      "a\xe2\x80\xae"
      "b\xc2\xad";  // U+202E, U+00AD
  CHECK(has_unseen_character(hidden));
  CHECK(with_unseen_replaced(hidden) == "a?b?");
  const std::string plain = "\"a b\" \\ \xc3\xa9\xe2\x82\xac\xf0\x9f\xa7\xb1";
  CHECK_FALSE(has_unseen_character(plain));
  CHECK(with_unseen_replaced(plain) == plain);
  CHECK_FALSE(has_unseen_character(""));
}

TEST_CASE("text is cut between characters", "[core]") {
  const std::string_view text =
      "a\xc3\xa9\xe2\x82\xac\xf0\x9f\xa7\xb1";  // characters of 1, 2, 3 and 4 bytes
  const std::size_t kept[] = {0, 1, 1, 3, 3, 3, 6, 6, 6, 6, 10, 10};
  for (std::size_t most = 0; most < 12; ++most)
    CHECK(cut_utf8(text, most) == text.substr(0, kept[most]));
  CHECK(cut_utf8("", 0).empty());
}

}  // namespace runstone::test
