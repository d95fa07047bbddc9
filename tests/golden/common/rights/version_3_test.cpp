#include <catch2/catch.hpp>

#include "common/rights/rights_change.hpp"

// What version 3 adds to changes of rights. It may change until the release.
namespace runstone::test {

TEST_CASE("the bytes of a correction of the time are pinned", "[rights][golden]") {
  const Bytes golden = {15, 0x80, 0x80, 0x9f, 0xc1, 0xd1, 0xab, 0x0e};  // two years of 365 days
  const RightsChange change = CorrectTime{63'072'000'000'000};
  Bytes out;
  encode(change, out);
  CHECK(out == golden);
  ByteReader in(golden);
  CHECK(read_rights_change(in) == change);
  CHECK(in.ok());
}

}  // namespace runstone::test
