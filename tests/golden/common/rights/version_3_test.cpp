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

TEST_CASE("the bytes of a grant with an end are pinned", "[rights][golden]") {
  GrantRole grant{{}, "mason", 1'700'000'000'000'000};
  for (std::size_t i = 0; i < grant.key.size(); ++i)
    grant.key[i] = static_cast<std::uint8_t>(i + 1);
  Bytes golden = {16};
  golden.insert(golden.end(), grant.key.begin(), grant.key.end());
  const Bytes rest = {5, 'm', 'a', 's', 'o', 'n', 0x80, 0x80, 0xf9, 0xc0, 0xc1, 0xc4, 0x82, 0x03};
  golden.insert(golden.end(), rest.begin(), rest.end());
  Bytes out;
  encode(grant, out);
  CHECK(out == golden);
  ByteReader in(golden);
  CHECK(read_rights_change(in) == RightsChange{grant});
  CHECK(in.ok());
  for (std::size_t size = 0; size < golden.size(); ++size) {
    ByteReader cut(ByteView(golden).first(size));
    static_cast<void>(read_rights_change(cut));
    CHECK_FALSE(cut.ok());
  }
  // A grant without an end has the bytes of earlier versions.
  Bytes without(golden.begin(), golden.begin() + 1 + 32 + 6);
  without.push_back(0);
  ByteReader endless(without);
  static_cast<void>(read_rights_change(endless));
  CHECK_FALSE(endless.ok());
}

}  // namespace runstone::test
