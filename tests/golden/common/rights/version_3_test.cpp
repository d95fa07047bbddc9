#include <catch2/catch.hpp>
#include <utility>

#include "common/rights/rights_change.hpp"

// The changes of rights that version 3 adds. Their bytes may change until version 3 is released.
namespace runstone::test {

TEST_CASE("the bytes of a correction of the time are pinned", "[rights][golden]") {
  // Two years of 365 days back, and two hours forward.
  const std::pair<CorrectTime, Bytes> golden[] = {
      {{-63'072'000'000'000, 22}, {15, 0xff, 0xff, 0xbd, 0x82, 0xa3, 0xd7, 0x1c, 22}},
      {{7'200'000'000, 300}, {15, 0x80, 0xa0, 0xba, 0xd2, 0x35, 0xac, 0x02}}};
  for (const auto& [correction, bytes] : golden) {
    const RightsChange change = correction;
    Bytes out;
    encode(change, out);
    CHECK(out == bytes);
    ByteReader in(bytes);
    CHECK(read_rights_change(in) == change);
    CHECK(in.ok());
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      ByteReader cut(ByteView(bytes).first(size));
      static_cast<void>(read_rights_change(cut));
      CHECK_FALSE(cut.ok());
    }
  }
}

}  // namespace runstone::test
