// Folding is idempotent, and it does not see in which normal form a text is written.
#include "common/names/folded_name.hpp"

#include <utf8proc.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <string>

#include "common/core/hash.hpp"
#include "common/core/text.hpp"

namespace runstone::test {
namespace {

std::string utf8_of(utf8proc_int32_t character) {
  utf8proc_uint8_t bytes[4];
  const utf8proc_ssize_t size = utf8proc_encode_char(character, bytes);
  return {reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size)};
}

std::string normal_form(utf8proc_uint8_t* (*form)(const utf8proc_uint8_t*),
                        const std::string& text) {
  utf8proc_uint8_t* mapped = form(reinterpret_cast<const utf8proc_uint8_t*>(text.c_str()));
  REQUIRE(mapped != nullptr);
  std::string out(reinterpret_cast<const char*>(mapped));
  std::free(mapped);
  return out;
}

void check_folding(const std::string& text) {
  const std::string folded = folded_name(text);
  CHECK(folded_name(folded) == folded);
  CHECK(folded_name(normal_form(utf8proc_NFC, text)) == folded);
  CHECK(folded_name(normal_form(utf8proc_NFD, text)) == folded);
  CHECK(is_printable_utf8(folded));
}

}  // namespace

TEST_CASE("every assigned character folds alike in each normal form", "[names][property]") {
  for (utf8proc_int32_t character = 0xa0; character <= 0x10ffff; ++character) {
    if (!utf8proc_codepoint_valid(character) ||
        utf8proc_category(character) == UTF8PROC_CATEGORY_CN)
      continue;
    CAPTURE(character);
    check_folding("a" + utf8_of(character) + "b");
  }
}

TEST_CASE("random texts fold alike in each normal form", "[names][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  for (int i = 0; i < 50'000; ++i) {
    std::string text;
    while (text.size() < 24) {
      // Letters with marks and blanks in between are where forms differ.
      constexpr utf8proc_int32_t kFirst[] = {0x20,  0x41,   0xc0,   0x300,
                                             0x370, 0x1e00, 0x1100, 0xac00};
      constexpr std::uint32_t kCount[] = {1, 26, 0x190, 0x70, 0x80, 0x100, 0x80, 0x800};
      const std::uint32_t block = rng.below(8);
      const auto character =
          kFirst[block] + static_cast<utf8proc_int32_t>(rng.below(kCount[block]));
      if (utf8proc_category(character) != UTF8PROC_CATEGORY_CN) text += utf8_of(character);
    }
    CAPTURE(Catch::rngSeed(), i, text);
    check_folding(text);
  }
}

}  // namespace runstone::test
