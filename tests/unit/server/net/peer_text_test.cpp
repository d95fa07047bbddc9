#include "server/net/peer_text.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

std::string text(const char* address, AddressForm form) {
  return peer_text({asio::ip::make_address(address), 40'312}, form);
}

}  // namespace

TEST_CASE("the log shows an address in full, as its prefix, or not at all", "[net]") {
  CHECK(text("203.0.113.7", AddressForm::full) == "203.0.113.7:40312");
  CHECK(text("203.0.113.7", AddressForm::prefix) == "203.0.113.0/24");
  CHECK(text("203.0.113.7", AddressForm::none) == "-");
  CHECK(text("2001:db8:1:2::3", AddressForm::full) == "[2001:db8:1:2::3]:40312");
  CHECK(text("2001:db8:1:2::3", AddressForm::prefix) == "2001:db8:1::/48");
  CHECK(text("::ffff:203.0.113.7", AddressForm::full) == "203.0.113.7:40312");
  CHECK(text("::ffff:203.0.113.7", AddressForm::prefix) == "203.0.113.0/24");
}
