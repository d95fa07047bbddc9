#include "common/names/normal_form.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("texts that look the same have the same normal form", "[names]") {
  CHECK(nfc_of("") == "");
  CHECK(nfc_of("plain Text 1") == "plain Text 1");
  CHECK(nfc_of("e\xcc\x81") == "\xc3\xa9");
  CHECK(nfc_of("\xc3\xa9") == "\xc3\xa9");
  CHECK(nfc_of("\xef\xac\x81") == "\xef\xac\x81");  // the ligature fi is a character of its own
  CHECK(nfc_of("a\xcc\xa3\xcc\x82") == nfc_of("a\xcc\x82\xcc\xa3"));  // two marks in two orders
}

TEST_CASE("characters are counted, not bytes", "[names]") {
  CHECK(character_count("") == 0);
  CHECK(character_count("abc") == 3);
  CHECK(character_count("\xc3\xa9\xf0\x9f\xa7\xb1") == 2);
}
