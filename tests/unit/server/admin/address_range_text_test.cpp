#include "server/admin/address_range_text.hpp"

#include <catch2/catch.hpp>
#include <string>

namespace runstone::address_range_text_test {
namespace {

/// Returns the range as it is printed, or the error, or "no address".
std::string again(const std::string& text) {
  const auto parsed = parse_address_range(text);
  if (!parsed) return "no address";
  if (!*parsed) return (*parsed).error();
  CHECK((*parsed)->range.is_canonical());
  return text_of((*parsed)->range);
}

}  // namespace

TEST_CASE("ranges of addresses are read and printed", "[admin][rights]") {
  CHECK(again("192.0.2.7") == "192.0.2.7");
  CHECK(again("192.0.2.7/32") == "192.0.2.7");
  CHECK(again("192.0.2.7/24") == "192.0.2.0/24");
  CHECK(again("192.0.2.7/0") == "0.0.0.0/0");
  CHECK(again("::ffff:192.0.2.7") == "192.0.2.7");
  CHECK(again("2001:db8::1") == "2001:db8::/64");
  CHECK(again("2001:db8:1:2::/64") == "2001:db8:1:2::/64");
  CHECK(again("2001:db8:1:2::/33") == "2001:db8::/33");
  CHECK(again("::/0") == "::/0");
  CHECK(again("::1") == "::/64");
  CHECK((*parse_address_range("2001:db8::1"))->is_widened);
  CHECK_FALSE((*parse_address_range("2001:db8::1/64"))->is_widened);
  CHECK_FALSE((*parse_address_range("192.0.2.7"))->is_widened);
}

TEST_CASE("other words are no addresses, and a prefix has its length", "[admin][rights]") {
  for (const char* word :
       {"ana", "1.2.3", "1.2.3.4.5", "1:2", "", "/24", "fe80::1%lo", "1.2.3.400"})
    CHECK(again(word) == "no address");
  for (const char* word : {"192.0.2.7/33", "192.0.2.7/", "192.0.2.7/-1", "192.0.2.7/8x"})
    CHECK(again(word) == "a number from 0 to 32 comes after the / of IPv4");
  CHECK(again("2001:db8::/65") ==
        "a number from 0 to 64 comes after the / of IPv6: a subscriber has at least a /64");
}

}  // namespace runstone::address_range_text_test
