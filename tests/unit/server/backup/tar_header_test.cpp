// Headers of tar files.
#include "server/backup/tar_header.hpp"

#include <catch2/catch.hpp>

#include "common/core/hex.hpp"
#include "server/backup/backup_manifest.hpp"

namespace runstone::test {

TEST_CASE("a header of a tar file has the bytes that another program writes", "[backup]") {
  // The hash of the header that Python's tarfile writes in the format USTAR.
  const TarEntry entry{"world.sqlite", 12'345, 1'795'000'000};
  const auto header = tar_header(entry);
  REQUIRE(header.has_value());
  CHECK(to_hex(hash_of_block(*header)) ==
        "514a6c100d8a42ac60e47b3812e76ed904697b134cb3f9d6fae6a07d4bd40bfc");
  const auto back = parse_tar_header(*header);
  REQUIRE(back.has_value());
  CHECK(*back == entry);
}

TEST_CASE("sizes of tar entries are octal up to 8 GiB and binary from there on", "[backup]") {
  for (const std::uint64_t bytes :
       {0ULL, 1ULL, 511ULL, (1ULL << 33) - 1, 1ULL << 33, 20ULL << 30, 1ULL << 50}) {
    CAPTURE(bytes);
    const auto header = tar_header({"a", bytes, 0});
    REQUIRE(header.has_value());
    const auto back = parse_tar_header(*header);
    REQUIRE(back.has_value());
    REQUIRE(back->has_value());
    CHECK((*back)->bytes == bytes);
    CHECK((bytes + tar_padding(bytes)) % kTarBlockBytes == 0);
  }
  const TarHeader large = *tar_header({"a", 20ULL << 30, 0});
  // As GNU tar writes it.
  const std::uint8_t expected[12] = {0x80, 0, 0, 0, 0, 0, 0, 5, 0, 0, 0, 0};
  CHECK(std::equal(std::begin(expected), std::end(expected), large.begin() + 124));
}

TEST_CASE("a header that is damaged or of another kind is refused", "[backup]") {
  const TarHeader sound = *tar_header({"world.sqlite", 12'345, 1'795'000'000});
  for (std::size_t i = 0; i < sound.size(); ++i) {
    CAPTURE(i);
    TarHeader changed = sound;
    changed[i] ^= 1;
    const auto read = parse_tar_header(changed);
    // The last bytes of the checksum end it and count as blanks.
    if (i == 154 || i == 155) continue;
    REQUIRE_FALSE(read.has_value());
  }
  CHECK_FALSE(tar_header({std::string(101, 'a'), 1, 0}).has_value());
  CHECK(tar_header({std::string(100, 'a'), 1, 0}).has_value());
  CHECK_FALSE(tar_header({"", 1, 0}).has_value());
  const auto end = parse_tar_header(TarHeader{});
  REQUIRE(end.has_value());
  CHECK_FALSE(end->has_value());
}

}  // namespace runstone::test
