#include "protocol/codec/invite_token.hpp"

#include <catch2/catch.hpp>

#include "protocol/codec/server_link.hpp"

namespace runstone::test {
namespace {

KeyPair server_keys(std::uint8_t n) {
  KeySeed seed{};
  seed.fill(n);
  return key_pair_of(seed);
}

}  // namespace

TEST_CASE("an invite token holds for its world and server alone", "[protocol]") {
  const KeyPair server = server_keys(1);
  const WorldId world{1, 2, 3};
  const std::string token = invite_token(0x0123456789abcdef, world, server);
  CHECK(token.size() == kInviteTokenBytes);
  CHECK(invite_of(token, world, server.public_key) == 0x0123456789abcdef);
  CHECK(invite_of(token, WorldId{1, 2, 4}, server.public_key) == std::nullopt);
  CHECK(invite_of(token, world, server_keys(2).public_key) == std::nullopt);
}

TEST_CASE("a token that differs in one character is refused", "[protocol]") {
  const KeyPair server = server_keys(1);
  const WorldId world{};
  const std::string token = invite_token(7, world, server);
  for (std::size_t i = 0; i < token.size(); ++i) {
    for (const char c : {'A', 'z', '=', ' ', '\n'}) {
      std::string forged = token;
      if (forged[i] == c) continue;
      forged[i] = c;
      CAPTURE(i, c);
      REQUIRE(invite_of(forged, world, server.public_key) == std::nullopt);
    }
  }
  CHECK(invite_of("", world, server.public_key) == std::nullopt);
  CHECK(invite_of(token + "A", world, server.public_key) == std::nullopt);
}

TEST_CASE("a link has an address and perhaps an invite", "[protocol]") {
  CHECK(text_of(ServerLink{"example.org:4747", "abc"}) == "runstone://example.org:4747/#abc");
  CHECK(text_of(ServerLink{"example.org", ""}) == "runstone://example.org");
  for (const ServerLink& link : {ServerLink{"[::1]:4747", "abc"}, ServerLink{"a.b", ""}})
    CHECK(*parse_server_link(text_of(link)) == link);
  CHECK(*parse_server_link("192.0.2.1:5") == ServerLink{"192.0.2.1:5", ""});
  CHECK(*parse_server_link("runstone://a/") == ServerLink{"a", ""});
  CHECK(*parse_server_link("runstone://a#t") == ServerLink{"a", "t"});
  CHECK(*parse_server_link("a:5/#t") == ServerLink{"a:5", "t"});
  for (const char* wrong :
       {"runstone://", "runstone:///#t", "runstone://a/b#t", "runstone://a/#"}) {
    CAPTURE(wrong);
    CHECK_FALSE(parse_server_link(wrong).has_value());
  }
  CHECK_FALSE(parse_server_link("runstone://a/#" + std::string(129, 'x')).has_value());
}

}  // namespace runstone::test
