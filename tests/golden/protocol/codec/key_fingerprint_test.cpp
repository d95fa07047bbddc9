// Fingerprints of pinned keys. People compare them, so they never change.
#include "protocol/codec/key_fingerprint.hpp"

#include <catch2/catch.hpp>

#include "protocol/codec/handshake.hpp"

namespace runstone::test {

TEST_CASE("the fingerprint of a key is the one that people have noted", "[protocol][golden]") {
  CHECK(key_fingerprint({}) == "H7NG-TTMA-D4ET");
  KeySeed seed{};
  seed.fill(1);
  CHECK(key_fingerprint(key_pair_of(seed).public_key) == "RQH1-NCE9-YR12");
}

}  // namespace runstone::test
