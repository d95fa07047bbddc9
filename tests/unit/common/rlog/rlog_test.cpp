// The tests read .rlog files: intact ones, truncated at every byte, with every bit flipped, with
// reordered blocks, and with wrong content under correct checksums.
#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "tests/support/edits/builder_session.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/rlog/rlog_bytes.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {
namespace {

constexpr RlogOptions kSmallBlocks{3, 16};

std::vector<EditRecord> records_of(std::uint64_t seed, Sequence first, std::size_t count) {
  SplitMix64 rng(seed);
  return sample_records(rng, 2, first, count);
}

void make_time_correction(EditRecord& record, TimeUs step_us) {
  record.cause = Cause::rights;
  record.subject = 0;
  record.edit = rights_edit(CorrectTime{step_us, 11});
}

bool is_start_of(const std::vector<EditRecord>& part, const std::vector<EditRecord>& whole) {
  return part.size() <= whole.size() && std::equal(part.begin(), part.end(), whole.begin());
}

}  // namespace

TEST_CASE("an .rlog gives back world, players and edits", "[rlog]") {
  const auto players = sample_rlog_players();
  for (const Sequence first : {Sequence{1}, Sequence{500}}) {
    for (const std::size_t count : {0u, 1u, 16u, 100u}) {
      for (const int level : {0, 3}) {
        CAPTURE(first, count, level);
        const RlogWorld world = sample_rlog_world(first);
        const auto records = records_of(count, first, count);
        const Bytes file = rlog_of(world, players, records, {level, 16});
        const RlogContents read = read_rlog(file);
        if (read.error) FAIL(read.error->message());
        CHECK(read.world == world);
        CHECK(read.players == players);
        CHECK(read.records == records);
      }
    }
  }
}

TEST_CASE("extreme numbers pass through an .rlog", "[rlog]") {
  constexpr TimeUs kLow = std::numeric_limits<TimeUs>::min(),
                   kHigh = std::numeric_limits<TimeUs>::max();
  RlogWorld world = sample_rlog_world();
  world.head = {3, kSequenceMax - 5};
  world.head_us = kLow;
  std::vector<EditRecord> records(4);
  for (std::size_t i = 0; i < records.size(); ++i) {
    records[i].version = {i < 2 ? 3u : 0xffff'ffffu, kSequenceMax - 4 + i};
    records[i].op = {0xffff'ffffu, ~ClientInstance{0}, i % 2 == 0 ? kSequenceMax : 0};
    records[i].time_us = i < 2 ? kLow : kHigh;
    records[i].edit = {SetVoxel{{-kWorldLimit, kWorldLimit - 1, 0}}, {}, 65535};
    records[i].subject = i == 3 ? 1 : records[i].version.seq - 1;
  }
  const RlogContents read = read_rlog(rlog_of(world, {}, records, {0, 3}));
  if (read.error) FAIL(read.error->message());
  CHECK(read.world == world);
  CHECK(read.records == records);
}

TEST_CASE("edits that do not continue the log are not written", "[rlog]") {
  const auto good = records_of(1, 1, 3);
  const auto rejected = [&](const std::function<void(EditRecord&)>& change) {
    RlogWriter writer([](ByteView) { return true; });
    REQUIRE(writer.begin(sample_rlog_world(), {}).has_value());
    REQUIRE(writer.add(good[0]).has_value());
    EditRecord next = good[1];
    change(next);
    const auto added = writer.add(next);
    REQUIRE_FALSE(added.has_value());
    CHECK(added.error().seq == next.version.seq);
    return std::string(added.error().error.what);
  };
  CHECK(rejected([](EditRecord& r) { r.version.seq = 3; }) == "does not continue the log");
  CHECK(rejected([](EditRecord& r) { r.version.epoch = 1; }) == "epoch falls");
  CHECK(rejected([&](EditRecord& r) { r.time_us = good[0].time_us - 1; }) == "time falls");
  CHECK(rejected([](EditRecord& r) { r.log = 1; }) == "belongs to another log");
  CHECK(rejected([](EditRecord& r) { r.subject = 2; }) == "subject is not an earlier edit");
  RlogWriter full([](ByteView) { return false; });
  CHECK(full.begin(sample_rlog_world(), {}).error().error.code == ErrorCode::io_failed);
}

TEST_CASE("time falls in an .rlog only at a correction, which begins a block", "[rlog][clock]") {
  auto records = records_of(6, 1, 40);
  constexpr TimeUs kYear = TimeUs{365} * 24 * 3600 * 1'000'000;
  for (std::size_t i = 0; i < 20; ++i) records[i].time_us += 2 * kYear;
  make_time_correction(records[20], -2 * kYear);
  Bytes file = rlog_of(sample_rlog_world(), {}, records, {0, 16});
  const RlogContents read = read_rlog(file);
  if (read.error) FAIL(read.error->message());
  CHECK(read.records == records);
  // The world, 16 edits, 4 edits, 16 edits, 4 edits, the end, and the length of the file.
  CHECK(blocks_of(file).size() == 7);
  CHECK(read_rlog(file, 21).records.front() == records[20]);
  // A writer takes no time that falls without a correction.
  records[20] = records[19];
  records[20].version.seq = 21;
  RlogWriter writer([](ByteView) { return true; });
  REQUIRE(writer.begin(sample_rlog_world(), {}).has_value());
  for (std::size_t i = 0; i < 21; ++i) REQUIRE(writer.add(records[i]).has_value());
  CHECK(writer.add(records[21]).error().error.what == std::string("time falls"));
}

TEST_CASE("corrections in a row begin a block each", "[rlog][clock]") {
  auto records = records_of(8, 1, 40);
  constexpr TimeUs kYear = TimeUs{365} * 24 * 3600 * 1'000'000;
  for (std::size_t i = 0; i < 21; ++i) records[i].time_us += i < 20 ? 2 * kYear : kYear;
  make_time_correction(records[20], -kYear);
  make_time_correction(records[21], -kYear);
  const Bytes file = rlog_of(sample_rlog_world(), {}, records, {0, 16});
  const RlogContents read = read_rlog(file);
  if (read.error) FAIL(read.error->message());
  CHECK(read.records == records);
  // The world, 16 edits, 4 edits, 1 edit, 16 edits, 3 edits, the end, and the length of the file.
  CHECK(blocks_of(file).size() == 8);
}

TEST_CASE("a block with a fallen time and no correction is rejected", "[rlog][clock][damage]") {
  auto records = records_of(7, 1, 32);
  Bytes file = rlog_of(sample_rlog_world(), {}, records, {0, 16});
  // The times in the headers of the first block of edits become later than those of the second one.
  const std::size_t first = blocks_of(file)[1];
  for (const std::size_t at : {std::size_t{24}, std::size_t{32}}) file[first + at + 6] += 1;
  mend_rlog(file);
  const RlogContents read = read_rlog(file);
  REQUIRE(read.error.has_value());
  CHECK(read.error->seq == 17);
  CHECK(read.error->error.what == std::string("time falls from block to block"));
}

TEST_CASE("reading begins at a sequence without unpacking earlier blocks", "[rlog]") {
  const auto records = records_of(2, 1, 100);
  Bytes file = rlog_of(sample_rlog_world(), sample_rlog_players(), records, kSmallBlocks);
  // The first block of edits is damaged inside. Reading it fails; skipping it does not.
  const std::size_t third = blocks_of(file)[2];
  file[third + kRlogHeaderBytes] ^= 1;
  CHECK(read_rlog(file).error.has_value());
  for (const std::size_t index : {16u, 17u, 31u, 32u, 99u}) {
    CAPTURE(index);
    const std::vector<EditRecord> rest(records.begin() + static_cast<std::ptrdiff_t>(index),
                                       records.end());
    const RlogContents by_seq = read_rlog(file, records[index].version.seq);
    CHECK((!by_seq.error && by_seq.records == rest));
  }
  CHECK(read_rlog(file, 101).records.empty());
  CHECK_FALSE(read_rlog(file, 101).error.has_value());
}

TEST_CASE("a truncated .rlog gives the edits of its complete blocks and names the place",
          "[rlog]") {
  const auto records = records_of(3, 1, 60);
  const Bytes file = rlog_of(sample_rlog_world(), sample_rlog_players(), records, kSmallBlocks);
  const auto begins = blocks_of(file);
  for (std::size_t bytes = 0; bytes < file.size(); ++bytes) {
    const RlogContents read =
        read_rlog(Bytes(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(bytes)));
    CAPTURE(bytes);
    REQUIRE(read.error.has_value());
    REQUIRE(is_start_of(read.records, records));
    // World, players, then 16 edits a block.
    std::size_t whole = 0;
    while (whole + 1 < begins.size() && begins[whole + 1] <= bytes) ++whole;
    REQUIRE(read.records.size() == (whole < 2 ? 0 : std::min<std::size_t>((whole - 2) * 16, 60)));
    if (whole >= 2) {
      REQUIRE(read.error->seq == read.records.size() + 1);
      REQUIRE(read.error->position == begins[whole]);
    }
  }
}

TEST_CASE("every flipped bit of an .rlog is detected, and all edits before it are read", "[rlog]") {
  const auto records = records_of(4, 1, 40);
  const Bytes file = rlog_of(sample_rlog_world(), sample_rlog_players(), records, kSmallBlocks);
  const auto begins = blocks_of(file);
  for (std::size_t bit = 0; bit < file.size() * 8; ++bit) {
    Bytes flipped = file;
    flipped[bit / 8] = static_cast<std::uint8_t>(flipped[bit / 8] ^ (1u << (bit % 8)));
    const RlogContents read = read_rlog(flipped);
    CAPTURE(bit);
    REQUIRE(read.error.has_value());
    // 0: the file's mark; 1: the first block.
    const auto block = static_cast<std::size_t>(
        std::upper_bound(begins.begin(), begins.end(), bit / 8) - begins.begin());
    REQUIRE(read.records.size() == (block < 4 ? 0 : std::min<std::size_t>((block - 3) * 16, 40)));
    REQUIRE(is_start_of(read.records, records));
    REQUIRE(read.error->position == (block == 0 ? 0 : begins[block - 1]));
  }
}

TEST_CASE("moved, missing, duplicated and foreign blocks of an .rlog are detected", "[rlog]") {
  const auto records = records_of(5, 1, 64);
  const Bytes file = rlog_of(sample_rlog_world(), {}, records, {0, 16});
  const Bytes other = rlog_of(sample_rlog_world(), {}, records_of(6, 1, 64), {0, 16});
  const auto begins = blocks_of(file), others = blocks_of(other);
  const auto block = [](const Bytes& from, const std::vector<std::size_t>& at, std::size_t i) {
    return Bytes(from.begin() + static_cast<std::ptrdiff_t>(at[i]),
                 from.begin() + static_cast<std::ptrdiff_t>(at[i + 1]));
  };
  // Blocks 0 (world), 1 .. 4 (edits), 5 (end).
  const auto joined = [&](std::initializer_list<std::size_t> order, bool foreign_third = false) {
    Bytes out(file.begin(), file.begin() + kRlogFileHeadBytes);
    std::size_t place = 0;
    for (const std::size_t i : order) {
      const Bytes part =
          foreign_third && place == 3 ? block(other, others, i) : block(file, begins, i);
      out.insert(out.end(), part.begin(), part.end());
      ++place;
    }
    return out;
  };
  REQUIRE_FALSE(read_rlog(joined({0, 1, 2, 3, 4, 5})).error.has_value());
  const auto stands = [&](Bytes bytes, std::size_t edits) {
    for (const bool mended : {false, true}) {
      if (mended) mend_rlog(bytes);  // checksums as a forger would set them; sequences still differ
      const RlogContents read = read_rlog(bytes);
      CAPTURE(mended);
      REQUIRE(read.error.has_value());
      CHECK(read.records.size() == edits);
      CHECK(read.error->seq == edits + 1);
    }
  };
  stands(joined({0, 1, 3, 2, 4, 5}), 16);
  stands(joined({0, 1, 3, 4, 5}), 16);
  stands(joined({0, 1, 2, 2, 3, 4, 5}), 32);
  stands(joined({0, 1, 2, 3, 4, 5, 5}), 64);
  stands(joined({0, 1, 2, 0, 3, 4, 5}), 32);
  const RlogContents foreign = read_rlog(joined({0, 1, 2, 3, 4, 5}, true));
  CHECK((foreign.error && foreign.error->error.code == ErrorCode::bad_checksum));
  CHECK(foreign.records.size() == 32);
}

TEST_CASE(
    "a bad record with correct checksums is named, and the edits before it in its block are read",
    "[rlog]") {
  const auto records = records_of(7, 1, 20);
  const Bytes file = rlog_of(sample_rlog_world(), {}, records, {0, 16});
  std::size_t partial = 0;
  for (std::size_t at = blocks_of(file)[1] + kRlogHeaderBytes; at < blocks_of(file)[2]; ++at) {
    Bytes changed = file;
    changed[at] ^= 0x80;
    mend_rlog(changed);
    const RlogContents read = read_rlog(changed);
    CAPTURE(at);
    for (const EditRecord& record : read.records) REQUIRE(validate(record.edit).has_value());
    if (!read.error) continue;  // another valid log
    REQUIRE(read.error->seq == read.records.size() + 1);
    const std::size_t named = read.error->position == blocks_of(file)[1] ? 1 : 2;
    REQUIRE(read.error->position == blocks_of(file)[named]);
    // A block may hold too much after its last record. Then the next block is not read.
    REQUIRE((named == 1 ? read.records.size() <= 16 : read.records.size() >= 16));
    if (!read.records.empty() && read.records.size() < 16) ++partial;
  }
  CHECK(partial > 20);
}

TEST_CASE("an .rlog error names the edit and the byte", "[rlog]") {
  CHECK(RlogError{{ErrorCode::bad_checksum, "checksum of the block is wrong", 0}, 9121, 123456}
            .message() == "edit 9121 at byte 123456: checksum of the block is wrong");
  const Bytes newer = [] {
    Bytes file = rlog_of(sample_rlog_world(), {}, {}, {});
    file[8] = 2;
    return file;
  }();
  CHECK(read_rlog(newer).error->error.code == ErrorCode::bad_version);
  CHECK(read_rlog({}).error->message() == "edit 1 at byte 0: is not an .rlog file");
}

TEST_CASE("a single-voxel edit of a builders' evening costs at most 16 bytes of .rlog", "[rlog]") {
  BuilderSession session(11);
  std::vector<EditRecord> records;
  for (int i = 0; i < 50'000; ++i) records.push_back(session.next());
  for (const int level : {1, 9}) {
    const Bytes file =
        rlog_of(sample_rlog_world(), {}, records, {level, RlogOptions{}.edits_per_block});
    const double bytes = static_cast<double>(file.size()) / static_cast<double>(records.size());
    UNSCOPED_INFO("level " << level << ": " << bytes << " bytes an edit");
    CHECK(bytes < 16);
    CHECK(bytes > 3);  // the microseconds alone take more
  }
}

}  // namespace runstone::test
