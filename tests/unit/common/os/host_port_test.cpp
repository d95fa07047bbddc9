#include "common/os/host_port.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

constexpr std::uint16_t kDefault = 4747;

HostPort parsed(std::string_view text) {
  const auto address = parse_host_port(text, kDefault);
  INFO(text);
  REQUIRE(address.has_value());
  return *address;
}

}  // namespace

TEST_CASE("an address without a port gets the default port", "[os]") {
  CHECK(parsed("localhost") == HostPort{"localhost", kDefault});
  CHECK(parsed("127.0.0.1") == HostPort{"127.0.0.1", kDefault});
  CHECK(parsed("::1") == HostPort{"::1", kDefault});
  CHECK(parsed("fe80::1%eth0") == HostPort{"fe80::1%eth0", kDefault});
  CHECK(parsed("::") == HostPort{"::", kDefault});
  CHECK(parsed("[::1]") == HostPort{"::1", kDefault});
}

TEST_CASE("an address with a port keeps it, and brackets enclose IPv6", "[os]") {
  CHECK(parsed("localhost:1") == HostPort{"localhost", 1});
  CHECK(parsed("example.org:65535") == HostPort{"example.org", 65535});
  CHECK(parsed("[::1]:4000") == HostPort{"::1", 4000});
  CHECK(parsed("[2001:db8::7]:80") == HostPort{"2001:db8::7", 80});
}

TEST_CASE("several addresses are separated by commas", "[os]") {
  const auto all = parse_host_ports("a,b:1,[::1]:2", kDefault);
  REQUIRE(all.has_value());
  CHECK(*all == std::vector<HostPort>{{"a", kDefault}, {"b", 1}, {"::1", 2}});
  CHECK(parse_host_ports("a", kDefault).value() == std::vector<HostPort>{{"a", kDefault}});
  for (const char* text : {"", ",", "a,", ",a", "a,,b", "a,b:0"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_host_ports(text, kDefault).has_value());
  }
}

TEST_CASE("an address becomes text that reads back to it", "[os]") {
  for (const char* text : {"localhost:4747", "127.0.0.1:1", "[::1]:4000"})
    CHECK(to_string(parsed(text)) == text);
}

TEST_CASE("an address of a wrong form is refused", "[os]") {
  for (const char* text : {"", ":", ":4000", "host:", "host:0", "host:65536", "host:-1", "host:+1",
                           "host:1x", "host: 1", "[]", "[]:1", "[::1", "[::1]4000",
                           "[::1]:", "[::1]:0", "[::1]x:1", "host:1:2", "[host]:1"}) {
    CAPTURE(text);
    const auto address = parse_host_port(text, kDefault);
    REQUIRE_FALSE(address.has_value());
    CHECK_FALSE(address.error().empty());
  }
}

TEST_CASE("a server may listen on every address and on a free port", "[os]") {
  CHECK(parse_listen_address(":4000", kDefault).value() == HostPort{"0.0.0.0", 4000});
  CHECK(parse_listen_address("127.0.0.1:0", kDefault).value() == HostPort{"127.0.0.1", 0});
  CHECK(parse_listen_address("[::]:0", kDefault).value() == HostPort{"::", 0});
  CHECK(parse_listen_address("localhost", kDefault).value() == HostPort{"localhost", kDefault});
  for (const char* text : {"", ":", "host:", "host:65536", "host:-1", "[]:1", "[::1"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_listen_address(text, kDefault).has_value());
  }
}
