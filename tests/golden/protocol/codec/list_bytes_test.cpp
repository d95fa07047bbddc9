#include <catch2/catch.hpp>

#include "protocol/codec/uniform_list.hpp"
#include "tests/support/hex.hpp"

// The bytes are those of docs/protocol.md.
namespace runstone::test {
namespace {

TEST_CASE("uniform chunks have the bytes of the protocol page", "[protocol][golden]") {
  const std::vector<UniformChunk> chunks = {
      {{0, {1, -2, 3}}, 0, {}}, {{0, {1, -1, 3}}, 0, {}}, {{0, {2, 5, 3}}, 7, {3, 500}}};
  const char* const bytes =
      "020603"       // x 1, z 3, y -2
      "010000"       // one more on top, material 0, base
      "02000e"       // x + 1, the same z, y + 7
      "000703f403";  // alone, material 7, epoch 3, seq 500
  CHECK(to_hex(encode_uniform(chunks)) == bytes);
  const auto read = decode_uniform(from_hex(bytes), 32);
  REQUIRE(read.has_value());
  CHECK(*read == chunks);
}

}  // namespace
}  // namespace runstone::test
