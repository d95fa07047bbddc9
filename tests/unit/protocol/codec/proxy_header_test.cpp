#include "protocol/codec/proxy_header.hpp"

#include <catch2/catch.hpp>

#include "common/core/hash.hpp"
#include "tests/support/core/hex.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

const std::string kSignature = "0d0a0d0a000d0a515549540a";
/// 203.0.113.7:40312 to 192.0.2.1:443.
const std::string kV4 = kSignature + "21110 00c cb007107 c0000201 9d78 01bb";
/// 2001:db8::7 port 40312 to 2001:db8::1 port 443.
const std::string kV6 = kSignature +
                        "21210024 20010db8000000000000000000000007"
                        "20010db8000000000000000000000001 9d78 01bb";

ErrorCode code_of(const Bytes& bytes) {
  const auto read = read_proxy_header(bytes);
  REQUIRE_FALSE(read.has_value());
  return read.error().code;
}

PeerEndpoint v6_endpoint() {
  PeerEndpoint out;
  out.address = {0x20, 0x01, 0x0d, 0xb8, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 7};
  out.port = 40312;
  return out;
}

}  // namespace

TEST_CASE("a PROXY header gives the address of an IPv4 client", "[proxy]") {
  const auto read = read_proxy_header(from_hex(kV4));
  REQUIRE(read.has_value());
  CHECK(read->client == peer_endpoint_v4(0xcb007107, 40312));
}

TEST_CASE("a PROXY header gives the address of an IPv6 client", "[proxy]") {
  const auto read = read_proxy_header(from_hex(kV6));
  REQUIRE(read.has_value());
  CHECK(read->client == v6_endpoint());
}

TEST_CASE("the bytes of a PROXY header that is written are pinned", "[proxy]") {
  CHECK(write_proxy_header(peer_endpoint_v4(0xcb007107, 40312),
                           peer_endpoint_v4(0xc0000201, 443)) == from_hex(kV4));
  PeerEndpoint gateway = v6_endpoint();
  gateway.address[15] = 1;
  gateway.port = 443;
  CHECK(write_proxy_header(v6_endpoint(), gateway) == from_hex(kV6));
  // One side of each family: both are written as IPv6.
  const Bytes mixed = write_proxy_header(peer_endpoint_v4(0xcb007107, 40312), gateway);
  const auto read = read_proxy_header(mixed);
  REQUIRE(read.has_value());
  CHECK(read->client == peer_endpoint_v4(0xcb007107, 40312));
}

TEST_CASE("a LOCAL header names no client, whatever stands behind its prefix", "[proxy]") {
  for (const char* rest : {"20000000", "20110000", "20000003 010203", "2011000c 00"}) {
    Bytes bytes = from_hex(kSignature + rest);
    bytes.resize(kProxyPrefixBytes + bytes[15]);
    const auto read = read_proxy_header(bytes);
    REQUIRE(read.has_value());
    CHECK_FALSE(read->client.has_value());
  }
}

TEST_CASE("TLVs of a PROXY header are skipped if they fill it exactly", "[proxy]") {
  const std::string addresses = "cb007107 c0000201 9d78 01bb";
  const auto with = [&](const std::string& length, const std::string& tlvs) {
    return from_hex(kSignature + "2111" + length + addresses + tlvs);
  };
  const auto read = read_proxy_header(with("0014", "ea0002abcd 040000"));
  REQUIRE(read.has_value());
  CHECK(read->client == peer_endpoint_v4(0xcb007107, 40312));
  CHECK(code_of(with("000d", "ea")) == ErrorCode::truncated);
  CHECK(code_of(with("0010", "ea000201")) == ErrorCode::truncated);
}

TEST_CASE("each truncation of a PROXY header, and a byte too many, is refused", "[proxy]") {
  for (const std::string& text : {kV4, kV6}) {
    const Bytes whole = from_hex(text);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      CAPTURE(size);
      CHECK(code_of(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size))) ==
            ErrorCode::truncated);
    }
    Bytes longer = whole;
    longer.push_back(0);
    CHECK(code_of(longer) == ErrorCode::trailing_bytes);
  }
  // A length that is too short for the addresses.
  CHECK(code_of(from_hex(kSignature + "2111000b cb007107 c0000201 9d78 01")) ==
        ErrorCode::truncated);
}

TEST_CASE("a PROXY header of another version, command, family or size is refused", "[proxy]") {
  CHECK(code_of(from_hex("504f585920544350342031 2e322e332e34")) ==
        ErrorCode::bad_value);  // version 1
  CHECK(code_of(from_hex(kSignature + "11110000")) == ErrorCode::bad_version);
  CHECK(code_of(from_hex(kSignature + "31110000")) == ErrorCode::bad_version);
  CHECK(code_of(from_hex(kSignature + "22110000")) == ErrorCode::unknown_kind);
  for (const char* family : {"00", "10", "12", "20", "22", "31", "32", "41", "ff"}) {
    Bytes bytes = from_hex(kSignature + "21" + family + "00d8");
    bytes.resize(kProxyPrefixBytes + 0xd8);
    CAPTURE(family);
    CHECK(code_of(bytes) == ErrorCode::unknown_kind);
  }
  Bytes prefix = from_hex(kSignature + "21110208");  // 520 + 16 bytes: the largest
  const auto largest = proxy_header_bytes(prefix);
  REQUIRE(largest.has_value());
  CHECK(*largest == kProxyHeaderBytesMax);
  ++prefix.back();
  CHECK_FALSE(proxy_header_bytes(prefix).has_value());
}

TEST_CASE("random bytes are no PROXY header, and damaged ones never break a rule", "[proxy]") {
  SplitMix64 rng(Catch::rngSeed());
  CAPTURE(Catch::rngSeed());
  for (int i = 0; i < 20'000; ++i) {
    Bytes bytes(rng.below(64));
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(rng.next());
    CHECK_FALSE(read_proxy_header(bytes).has_value());
    Bytes damaged = from_hex(i % 2 == 0 ? kV4 : kV6);
    const std::uint32_t at = rng.below(static_cast<std::uint32_t>(damaged.size()));
    damaged[at] ^= static_cast<std::uint8_t>(1 + rng.below(255));
    const auto read = read_proxy_header(damaged);
    // Of the signature, the version and the length each bit counts; of the addresses none does.
    const bool is_address = at >= kProxyPrefixBytes;
    if (is_address) CHECK(read.has_value());
    if (at < 12 || at == 14 || at == 15) CHECK_FALSE(read.has_value());
  }
}
