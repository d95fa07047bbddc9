// The example of docs/protocol.md was computed with Python, without libsodium.
#include "protocol/codec/device_code.hpp"

#include <catch2/catch.hpp>
#include <numeric>

#include "common/core/hex.hpp"
#include "tests/support/core/page_example.hpp"

using namespace runstone;
using runstone::test::page_example;

TEST_CASE("a device code has the slot and the seal of the protocol page", "[protocol][golden]") {
  std::array<std::uint8_t, kDeviceCodeBytes> random{};
  std::iota(random.begin(), random.end(), std::uint8_t{0xf0});
  std::array<std::uint8_t, kDeviceNonceBytes> nonce{};
  std::iota(nonce.begin(), nonce.end(), std::uint8_t{0x40});
  KeySeed seed{};
  seed.fill(2);
  const DeviceCode code(random);
  CHECK(code.text() == "Y3RZ-5WZM-YQVF-FY7S");
  const std::string example = page_example("device-code");
  CHECK(to_hex(code.slot()) == example.substr(0, 32));
  CHECK(to_hex(code.seal(seed, nonce)) == example.substr(96));
}
