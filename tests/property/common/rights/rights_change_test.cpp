#include "common/rights/rights_change.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/support/rights/random_rights.hpp"

namespace runstone::test {
namespace {

Bytes bytes_of(const RightsChange& change) {
  Bytes out;
  encode(change, out);
  return out;
}

/// Returns true if the bytes are rejected, or are the one encoding of a valid change.
bool rejected_or_canonical(const Bytes& bytes) {
  ByteReader in(bytes);
  const RightsChange change = read_rights_change(in);
  if (!in.ok()) return true;
  return validate(change).has_value() && bytes_of(change) == bytes;
}

}  // namespace

TEST_CASE("changes of rights survive their bytes", "[rights][property]") {
  SplitMix64 rng{62 + Catch::rngSeed()};
  std::size_t largest = 0;
  for (int round = 0; round < 4000; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    const RightsChange change =
        round % 2 == 0 ? random_rights_change(rng) : random_close_change(rng);
    REQUIRE(validate(change).has_value());
    const Bytes bytes = bytes_of(change);
    REQUIRE(bytes.size() <= kRightsChangeBytesMax);
    ByteReader in(bytes);
    REQUIRE(read_rights_change(in) == change);
    REQUIRE(in.ok());
    largest = std::max(largest, bytes.size());
  }
  CHECK(largest > 1000);
}

TEST_CASE("a cut, longer or damaged change is rejected or is another valid one",
          "[rights][property]") {
  SplitMix64 rng{63 + Catch::rngSeed()};
  for (int round = 0; round < 400; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    const Bytes bytes = bytes_of(random_rights_change(rng));
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
      ByteReader in(cut);
      read_rights_change(in);
      REQUIRE_FALSE(in.ok());
    }
    Bytes longer = bytes;
    longer.push_back(static_cast<std::uint8_t>(rng.below(256)));
    ByteReader in(longer);
    read_rights_change(in);
    REQUIRE_FALSE(in.ok());
    for (std::size_t at = 0; at < bytes.size(); ++at) {
      Bytes damaged = bytes;
      damaged[at] ^= static_cast<std::uint8_t>(1 + rng.below(255));
      REQUIRE(rejected_or_canonical(damaged));
    }
  }
}

}  // namespace runstone::test
