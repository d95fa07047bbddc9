#include "protocol/codec/device_code.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

KeySeed some_seed() {
  KeySeed seed{};
  seed.fill(7);
  return seed;
}

}  // namespace

TEST_CASE("a device code is read as people type it", "[protocol]") {
  const DeviceCode code({0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
  CHECK(code.text() == "000G-40R4-0M30-E209");
  for (const char* typed : {"000G-40R4-0M30-E209", "000g40r40m30e209", " OoO G4 0R-4oM3-0E2-O9 "}) {
    const auto read = DeviceCode::parse(typed);
    REQUIRE(read.has_value());
    CHECK(read->text() == code.text());
    CHECK(is_same_slot(read->slot(), code.slot()));
  }
  CHECK(DeviceCode::parse("IL1i-l000-0000-0000")->text() == "1111-1000-0000-0000");
  for (const char* wrong : {"", "000G-40R4-0M30-E20", "000G-40R4-0M30-E2090", "000G-40R4-0M30-E20U",
                            "000G_40R40M30E209", "000G-40R4-0M30-E20\xc3\xa9"})
    CHECK_FALSE(DeviceCode::parse(wrong).has_value());
}

TEST_CASE("only the code that sealed a key opens it, and only unchanged", "[protocol]") {
  const DeviceCode code({1}), other({2});
  const Bytes sealed = code.seal(some_seed(), {3});
  CHECK(sealed.size() == 72);
  CHECK(code.open(sealed) == some_seed());
  CHECK_FALSE(other.open(sealed).has_value());
  CHECK_FALSE(is_same_slot(code.slot(), other.slot()));
  for (std::size_t i = 0; i < sealed.size(); ++i) {
    Bytes forged = sealed;
    forged[i] ^= 1;
    CHECK_FALSE(code.open(forged).has_value());
    CHECK_FALSE(code.open(ByteView(sealed).first(i)).has_value());
  }
  Bytes longer = sealed;
  longer.push_back(0);
  CHECK_FALSE(code.open(longer).has_value());
}
