#include "protocol/rules/chat_text.hpp"

#include <catch2/catch.hpp>

#include "protocol/limits.hpp"

namespace runstone::test {
namespace {

std::string fault(std::string_view line) {
  const auto text = chat_text(line);
  return text ? "" : text.error();
}

TEST_CASE("a line of chat is taken without the blanks at its ends", "[chat]") {
  CHECK(*chat_text("hello") == "hello");
  CHECK(*chat_text("  two  words ") == "two  words");
  CHECK(*chat_text("\"quoted\" \\ <b>") == "\"quoted\" \\ <b>");
  CHECK(*chat_text("\xe4\xbd\xa0\xe5\xa5\xbd") == "\xe4\xbd\xa0\xe5\xa5\xbd");
  const std::string longest(kChatBytesMax, 'x');
  CHECK(*chat_text(" " + longest + " ") == longest);
}

TEST_CASE("a line of chat that is empty, too long or cannot be seen is refused", "[chat]") {
  CHECK(fault("") == "it is empty");
  CHECK(fault("    ") == "it is empty");
  CHECK(fault(std::string(kChatBytesMax + 1, 'x')) == "it has more than 512 bytes");
  for (const char* bad : {"a\nb", "\x1b[2J", "a\tb", "\xc2\x9b", "\xff", "\xe2\x82"}) {
    CAPTURE(bad);
    CHECK(fault(bad) == "it has control characters, or is no UTF-8 text");
  }
  for (const char* bad : {"a\xe2\x80\xae"
                          "b",               // U+202E, right to left from here
                          "\xe2\x80\x8b",    // U+200B, no width
                          "a\xe2\x81\xa6z",  // U+2066
                          "\xc2\xa0"}) {     // U+00A0, a blank that is not trimmed
    CAPTURE(bad);
    CHECK(fault(bad) == "it has invisible characters");
  }
}

}  // namespace
}  // namespace runstone::test
