#include "common/rights/address_range.hpp"

#include <catch2/catch.hpp>

namespace runstone::test {

TEST_CASE("a range of addresses holds the blocks with its prefix", "[rights]") {
  const AddressRange v4{address_block_v4(0xc000'0200), 32 + 24};  // 192.0.2.0/24
  CHECK(v4.is_canonical());
  CHECK(v4.contains(address_block_v4(0xc000'0200)));
  CHECK(v4.contains(address_block_v4(0xc000'02ff)));
  CHECK_FALSE(v4.contains(address_block_v4(0xc000'0300)));
  CHECK_FALSE(v4.contains(AddressBlock{0x2001'0db8'0000'0000}));

  const AddressRange one{AddressBlock{0x2001'0db8'0000'0001}, 64};
  CHECK(one.is_canonical());
  CHECK(one.contains(AddressBlock{0x2001'0db8'0000'0001}));
  CHECK_FALSE(one.contains(AddressBlock{0x2001'0db8'0000'0000}));

  const AddressRange all{AddressBlock{0}, 0};
  CHECK(all.is_canonical());
  CHECK(all.contains(AddressBlock{~std::uint64_t{0}}));
}

TEST_CASE("a range is canonical if no bit behind its prefix is set", "[rights]") {
  CHECK(AddressRange{AddressBlock{1ULL << 63}, 1}.is_canonical());
  CHECK_FALSE(AddressRange{AddressBlock{1ULL << 62}, 1}.is_canonical());
  CHECK_FALSE(AddressRange{AddressBlock{1}, 0}.is_canonical());
  CHECK_FALSE(AddressRange{AddressBlock{1}, 63}.is_canonical());
  CHECK_FALSE(AddressRange{AddressBlock{0}, 65}.is_canonical());
}

}  // namespace runstone::test
