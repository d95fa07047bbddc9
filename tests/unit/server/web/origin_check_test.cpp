#include "server/web/origin_check.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("without a list only pages of the gateway itself may open a WebSocket", "[web]") {
  const OriginCheck encrypted({}, true);
  CHECK(encrypted.allows("https://play.example.org", "play.example.org"));
  CHECK(encrypted.allows("https://PLAY.example.org:8443", "play.example.ORG:8443"));
  CHECK_FALSE(encrypted.allows("http://play.example.org", "play.example.org"));
  CHECK_FALSE(encrypted.allows("https://evil.example", "play.example.org"));
  CHECK_FALSE(encrypted.allows("https://play.example.org.evil.example", "play.example.org"));
  CHECK_FALSE(encrypted.allows("https://play.example.org:8443", "play.example.org"));
  CHECK_FALSE(encrypted.allows("null", "play.example.org"));
  CHECK_FALSE(encrypted.allows("https://", ""));
  CHECK_FALSE(encrypted.allows("", ""));
  CHECK(encrypted.allows(std::nullopt, "play.example.org"));  // no page has sent it
  const OriginCheck plain({}, false);
  CHECK(plain.allows("http://127.0.0.1:8080", "127.0.0.1:8080"));
  CHECK(plain.allows("http://localhost:8080", "LOCALHOST:8080"));
  CHECK(plain.allows("http://[::1]:8080", "[::1]:8080"));
  CHECK_FALSE(plain.allows("https://127.0.0.1:8080", "127.0.0.1:8080"));
  // A name that leads here may be one of somebody else's pages.
  CHECK_FALSE(plain.allows("http://evil.example:8080", "evil.example:8080"));
  CHECK_FALSE(plain.allows("http://localhost.evil.example", "localhost.evil.example"));
}

TEST_CASE("with a list only the pages of its origins may open a WebSocket", "[web]") {
  const auto origins = parse_origins(" https://a.example,http://b.example:81 ");
  REQUIRE(origins.has_value());
  REQUIRE(*origins == std::vector<std::string>{"https://a.example", "http://b.example:81"});
  const OriginCheck check(*origins, true);
  CHECK(check.allows("https://a.example", "elsewhere.example"));
  CHECK(check.allows("http://b.example:81", "elsewhere.example"));
  CHECK_FALSE(check.allows("http://b.example", "elsewhere.example"));
  CHECK_FALSE(check.allows("https://elsewhere.example", "elsewhere.example"));
  CHECK(check.sockets() == " wss://a.example ws://b.example:81");
  CHECK(OriginCheck({}, true).sockets().empty());
}

TEST_CASE("a list with something that is no origin is refused", "[web]") {
  for (const char* text : {"a.example", "https://", "https://a.example/", "ftp://a.example",
                           "https://A.example", "https://a.example https://*"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_origins(text).has_value());
  }
  CHECK(parse_origins("").value().empty());
}
