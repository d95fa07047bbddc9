// The bytes of .rlog version 1, as docs/edit-log.md specifies them. A change here is a new version.
#include <catch2/catch.hpp>

#include "tests/support/core/hex.hpp"
#include "tests/support/rlog/rlog_bytes.hpp"

namespace runstone::test {
namespace {

std::vector<EditRecord> golden_records() {
  constexpr ClientInstance kInstance = 0x0123456789abcdefULL;
  constexpr TimeUs kTime = 1'700'000'000'000'000;
  std::vector<EditRecord> records(3);
  records[0] = {{1, 1}, {1, kInstance, 1}, kTime, Cause::player, {SetVoxel{{1, -2, 3}}, {}, 300}, 0,
                0};
  records[1] = {{1, 2},
                {300, 7, 5},
                kTime + 100,
                Cause::player,
                {SetVoxel{{2, -2, 3}}, {MaskKind::only_empty, 0}, 300},
                0,
                0};
  records[2] = {
      {2, 3}, {1, kInstance, 2}, kTime + 101, Cause::undo, {SetVoxel{{1, -2, 3}}, {}, 0}, 1, 0};
  return records;
}

const Bytes& golden_plain() {
  static const Bytes kBytes = from_hex(
      // mark, version 1
      "89 52 4c 4f 47 0d 0a 1a 01 00 00 00 "
      // block at 12: kind world, stored 87, raw 87, count 0
      "01 00 00 00 57 00 00 00 57 00 00 00 00 00 00 00 "
      // first 1, first and last time 0
      "01 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
      // position 12, checksum of the payload, checksum of the header
      "0c 00 00 00 00 00 00 00 ff 88 f2 80 54 0e c4 7f 50 19 b7 88 d6 1a 8a dc "
      // world id
      "01 02 03 04 05 06 07 08 09 0a 0b 0c 0d 0e 0f 10 "
      // chunk edge 16
      "10 "
      // generator: "flat"
      "04 66 6c 61 74 "
      // version 2
      "02 "
      // seed
      "01 00 00 00 00 00 00 90 "
      // parameters
      "11 67 72 6f 75 6e 64 20 3d 20 22 73 74 6f 6e 65 22 0a "
      // spawn 0.5, 70.25, -3
      "00 00 00 00 00 00 e0 3f 00 00 00 00 00 90 51 40 00 00 00 00 00 00 08 c0 "
      // no base chunks, epoch 0
      "00 00 "
      // materials
      "0b 23 20 74 77 6f 20 72 6f 77 73 0a "
      // block at 163: kind players, stored 76, raw 76, count 2
      "02 00 00 00 4c 00 00 00 4c 00 00 00 02 00 00 00 "
      // first 1, times 0
      "01 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
      // position 163, checksums
      "a3 00 00 00 00 00 00 00 d6 02 9c 46 9c 13 d9 2c 7b f5 f3 eb 56 29 4e 01 "
      // author 1, key, "ada"
      "01 07 07 07 07 07 07 07 07 07 07 07 07 07 07 07 07 07 07 07 07 07 07 07 "
      "07 07 07 07 07 07 07 07 07 03 61 64 61 "
      // author 300, key, "zoe with two dots"
      "ac 02 09 09 09 09 09 09 09 09 09 09 09 09 09 09 09 09 09 09 09 09 09 09 "
      "09 09 09 09 09 09 09 09 09 09 04 7a 6f c3 ab "
      // block at 303: kind edits, stored 69, raw 69, count 3
      "03 00 00 00 45 00 00 00 45 00 00 00 03 00 00 00 "
      // first 1, first time, last time
      "01 00 00 00 00 00 00 00 00 40 1e 18 24 0a 06 00 65 40 1e 18 24 0a 06 00 "
      // position 303, checksums
      "2f 01 00 00 00 00 00 00 c5 95 97 7a b2 0d 0e ab 4f b1 32 97 60 50 cb 7d "
      // two clients
      "02 "
      // author 1 and its instance
      "01 ef cd ab 89 67 45 23 01 "
      // author 300, instance 7
      "ac 02 07 00 00 00 00 00 00 00 "
      // lengths of the columns
      "03 03 03 03 03 03 03 14 "
      // client: 0, 1, 0
      "00 01 00 "
      // epoch: 1, +0, +1
      "01 00 01 "
      // client sequence: 0 + 1, 0 + 1 + 4, 1 + 1
      "00 08 00 "
      // time: +0, +100, +1
      "00 64 01 "
      // cause: player, player, undo
      "00 00 03 "
      // subject: none, none, 2 before
      "00 00 02 "
      // descriptor lengths
      "07 07 06 "
      // descriptors, as in the database
      "01 00 ac 02 02 03 06 01 01 ac 02 04 03 06 01 00 00 02 03 06 "
      // block at 436: kind end
      "04 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
      // first 4, times of the last edit
      "04 00 00 00 00 00 00 00 65 40 1e 18 24 0a 06 00 65 40 1e 18 24 0a 06 00 "
      // position 436, checksums
      "b4 01 00 00 00 00 00 00 c2 94 d3 38 05 80 06 2d 27 b3 e5 a6 c6 56 d9 6f ");
  return kBytes;
}

/// 64 voxels of one line, compressed by zstd 1.5 at level 3. Another zstd may compress differently,
/// but must decompress these bytes.
const Bytes& golden_packed() {
  static const Bytes kBytes = from_hex(
      "89 52 4c 4f 47 0d 0a 1a 01 00 00 00 01 00 00 00 57 00 00 00 57 00 00 00 "
      "00 00 00 00 01 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
      "00 00 00 00 0c 00 00 00 00 00 00 00 ff 88 f2 80 54 0e c4 7f 50 19 b7 88 "
      "d6 1a 8a dc 01 02 03 04 05 06 07 08 09 0a 0b 0c 0d 0e 0f 10 10 04 66 6c "
      "61 74 02 01 00 00 00 00 00 00 90 11 67 72 6f 75 6e 64 20 3d 20 22 73 74 "
      "6f 6e 65 22 0a 00 00 00 00 00 00 e0 3f 00 00 00 00 00 90 51 40 00 00 00 "
      "00 00 00 08 c0 00 00 0b 23 20 74 77 6f 20 72 6f 77 73 0a 03 00 00 00 93 "
      "00 00 00 d2 03 00 00 40 00 00 00 01 00 00 00 00 00 00 00 00 40 1e 18 24 "
      "0a 06 00 18 36 1f 18 24 0a 06 00 a3 00 00 00 00 00 00 00 a3 dc c4 23 f4 "
      "ff 21 24 93 22 6b de 24 8a 5d 40 28 b5 2f fd 60 d2 02 4d 04 00 14 06 01 "
      "01 07 00 40 40 40 7f 40 40 40 c0 03 00 01 00 e8 07 00 00 07 01 00 03 00 "
      "80 01 09 01 00 03 02 04 06 08 0a 0c 0e 10 12 14 16 18 1a 1c 1e 20 22 24 "
      "26 28 2a 2c 2e 30 32 34 36 38 3a 3c 3e 40 42 44 46 48 4a 4c 4e 50 52 54 "
      "56 58 5a 5c 5e 60 62 64 66 68 6a 6c 6e 70 72 74 76 78 7a 7c 7e 80 01 09 "
      "44 a8 20 b6 64 e7 e0 85 e6 12 f0 9e ff ff bf 4a 07 bb 77 ef de 05 41 72 "
      "25 b2 97 ec 7f 0a 20 d7 1b 6f 8d 92 69 76 04 00 00 00 00 00 00 00 00 00 "
      "00 00 00 00 00 00 41 00 00 00 00 00 00 00 18 36 1f 18 24 0a 06 00 18 36 "
      "1f 18 24 0a 06 00 76 01 00 00 00 00 00 00 c2 94 d3 38 05 80 06 2d 43 62 "
      "87 38 b2 c1 24 91 ");
  return kBytes;
}

}  // namespace

TEST_CASE("the bytes of an .rlog whose blocks are not packed are pinned", "[rlog][golden]") {
  const auto records = golden_records();
  CHECK(rlog_of(sample_rlog_world(), sample_rlog_players(), records, {0, 16}) == golden_plain());
  const RlogContents read = read_rlog(golden_plain());
  if (read.error) FAIL(read.error->message());
  CHECK(read.world == sample_rlog_world());
  CHECK(read.players == sample_rlog_players());
  CHECK(read.records == records);
}

TEST_CASE("a packed .rlog of version 1 can be read", "[rlog][golden]") {
  const RlogContents read = read_rlog(golden_packed());
  if (read.error) FAIL(read.error->message());
  CHECK(read.world == sample_rlog_world());
  REQUIRE(read.records.size() == 64);
  for (std::size_t i = 0; i < 64; ++i) {
    EditRecord record;
    record.version = {1, i + 1};
    record.op = {1, 7, i + 1};
    record.time_us = 1'700'000'000'000'000 + static_cast<TimeUs>(i) * 1000;
    record.edit = {SetVoxel{{static_cast<std::int32_t>(i), 64, -5}}, {}, 3};
    CHECK(read.records[i] == record);
  }
}

}  // namespace runstone::test
