// The example of docs/protocol.md was computed with the reference implementation of Argon2 and with
// Python.
#include "protocol/codec/password_key.hpp"

#include <catch2/catch.hpp>
#include <numeric>

#include "common/core/hex.hpp"
#include "tests/support/core/page_example.hpp"

using namespace runstone;
using runstone::test::page_example;

TEST_CASE("the key of a password is that of the protocol page", "[protocol][golden]") {
  PasswordSalt salt{};
  std::iota(salt.begin(), salt.end(), std::uint8_t{0x10});
  const std::string composed =
      "Blaubeer \xc3\xa9"
      "clair 42";
  const std::string decomposed =
      "Blaubeer e\xcc\x81"
      "clair 42";
  const auto key = password_key(decomposed, salt);
  REQUIRE(key.has_value());
  CHECK(password_key(composed, salt).value() == *key);
  const Bytes text(composed.begin(), composed.end());
  CHECK(to_hex(text) + to_hex(salt) + to_hex(*key) + to_hex(hash_of(*key)) ==
        page_example("password"));
}
