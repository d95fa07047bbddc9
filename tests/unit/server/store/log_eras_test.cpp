// A log whose time was corrected: what a time means where times fall.
#include <array>
#include <catch2/catch.hpp>
#include <fstream>
#include <limits>
#include <span>

#include "server/store/copy_stored_world.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/sql/temp_place.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {
namespace {

constexpr TimeUs kMinute = 60'000'000;
constexpr TimeUs kStart = TimeUs{500'000'000} * kMinute / 10;
constexpr TimeUs kAhead = 2 * 365 * 24 * 60 * kMinute;

void make_correction(EditRecord& record) {
  record.cause = Cause::rights;
  record.subject = 0;
  record.edit = rights_edit(CorrectTime{-kAhead, record.version.seq});
}

/// Returns 40 edits, one each minute: 1 to 10 by a right clock, 11 to 20 by one that is ahead, 21 the
/// correction, 22 to 30 by a right clock, 31 a correction by half an hour, from 32 on right.
std::vector<EditRecord> corrected_records() {
  SplitMix64 rng(1);
  auto records = sample_records(rng, 1, 1, 40);
  for (std::size_t i = 0; i < records.size(); ++i) {
    records[i].time_us = kStart + static_cast<TimeUs>(i + 1) * kMinute;
    if (i >= 10 && i < 20) records[i].time_us += kAhead;
    if (i >= 30) records[i].time_us -= 30 * kMinute;
  }
  make_correction(records[20]);
  make_correction(records[30]);
  return records;
}

TimeUs minute(TimeUs count) { return kStart + count * kMinute; }

/// Makes a world of these records, with a keyframe.
void make_corrected_world(const std::string& place, const std::vector<EditRecord>& records,
                          Sequence kept = 25) {
  auto store = create_world(place, sample_meta());
  REQUIRE(store.has_value());
  REQUIRE((*store)->raise_epoch().has_value());
  // In several commits, so that the list of eras grows.
  for (std::size_t at = 0; at < records.size(); at += 8)
    REQUIRE((*store)->append({}, std::span(records).subspan(at, 8)).has_value());
  const EditRecord& at = records[static_cast<std::size_t>(kept - 1)];
  const Keyframe keyframe{{at.version, at.time_us}, 0, {}};
  REQUIRE((*store)->save_keyframe({}, keyframe).has_value());
}

/// The definition, by a scan of all records.
Sequence newest_at(std::span<const EditRecord> records, TimeUs time_us) {
  for (std::size_t i = records.size(); i-- > 0;) {
    if (records[i].time_us <= time_us) return records[i].version.seq;
  }
  return 0;
}

std::vector<Sequence> found_between(Store& store, TimeUs from_us, TimeUs until_us) {
  LogQuery query;
  query.from_us = from_us;
  query.until_us = until_us;
  std::vector<Sequence> all;
  const auto done = store.query_log(query, [&](const EditRecord& record) {
    all.push_back(record.version.seq);
    return true;
  });
  if (!done) FAIL(done.error().message());
  return all;
}

std::vector<Sequence> sequences(Sequence first, Sequence last) {
  std::vector<Sequence> all;
  for (Sequence seq = first; seq <= last; ++seq) all.push_back(seq);
  return all;
}

}  // namespace

TEST_CASE("a moment is the newest edit that is not later, also where times fall",
          "[store][clock]") {
  TempPlace place;
  const auto records = corrected_records();
  make_corrected_world(place / "w", records);
  auto store = *open_world(place / "w", StoreAccess::read_only);
  std::vector<TimeUs> times{kStart, kStart + kAhead, 0, minute(100)};
  for (const EditRecord& record : records)
    for (const TimeUs near_us : {TimeUs{-1}, TimeUs{0}, TimeUs{1}})
      times.push_back(record.time_us + near_us);
  for (const TimeUs from_us : times) {
    CAPTURE(from_us);
    const Sequence at = newest_at(records, from_us);
    CHECK(*store->sequence_at(from_us) == at);
    const Sequence before = newest_at(records, from_us - 1);
    CHECK(found_between(*store, from_us, std::numeric_limits<TimeUs>::max()) ==
          sequences(before + 1, 40));
    CHECK(found_between(*store, std::numeric_limits<TimeUs>::min(), from_us) == sequences(1, at));
  }
  // Five minutes after the second correction the clock is right: `since` is exact.
  CHECK(found_between(*store, minute(5), std::numeric_limits<TimeUs>::max()) == sequences(35, 40));
  CHECK(store->check().has_value());
}

TEST_CASE("a compaction keeps the meaning of times", "[store][clock]") {
  TempPlace place;
  const auto records = corrected_records();
  make_corrected_world(place / "w", records);
  auto store = *open_world(place / "w", StoreAccess::read_write);
  REQUIRE(store->compact(25).has_value());
  CHECK(store->log_range()->first == 26);
  for (const EditRecord& record : records) {
    CAPTURE(record.version.seq);
    // All times are within the last era or behind its beginning.
    CHECK(*store->sequence_at(record.time_us) == newest_at(records, record.time_us));
  }
  const auto before = store->sequence_at(kStart);
  REQUIRE_FALSE(before.has_value());
  CHECK(before.error().kind == StoreError::Kind::bad_request);
  CHECK(store->check().has_value());
}

TEST_CASE("a compaction behind the last correction leaves no eras", "[store][clock]") {
  TempPlace place;
  const auto records = corrected_records();
  make_corrected_world(place / "w", records, 32);
  {
    auto store = *open_world(place / "w", StoreAccess::read_write);
    REQUIRE(store->compact(32).has_value());
  }
  auto store = *open_world(place / "w", StoreAccess::read_only);
  CHECK(*store->sequence_at(minute(2)) == 32);  // the head
  CHECK(*store->sequence_at(minute(5)) == 35);
  CHECK(store->sequence_at(minute(1)).error().kind == StoreError::Kind::bad_request);
  CHECK(found_between(*store, minute(3), std::numeric_limits<TimeUs>::max()) == sequences(33, 40));
  CHECK(store->check().has_value());
  // Older programs cannot read the correction among the changes of rights.
  store.reset();
  CHECK(stored_format(place / "w") == "6");
}

TEST_CASE("a corrected world is of format 6, and so is a copy", "[store][clock]") {
  TempPlace place;
  auto records = corrected_records();
  make_corrected_world(place / "w", records);
  CHECK(stored_format(place / "w") == "6");
  const std::string copy = place / "copy";
  const auto copied = copy_stored_world(place / "w", copy, {});
  if (!copied) FAIL(copied.error().message());
  CHECK(stored_format(place / "copy") == "6");
  auto store = *open_world(copy, StoreAccess::read_only);
  for (const EditRecord& record : records)
    CHECK(*store->sequence_at(record.time_us) == newest_at(records, record.time_us));
  records.resize(8);
  auto other = create_world(place / "plain", sample_meta());
  REQUIRE(other.has_value());
  REQUIRE((*other)->raise_epoch().has_value());
  REQUIRE((*other)->append({}, records).has_value());
  other->reset();
  CHECK(stored_format(place / "plain") == "5");
}

TEST_CASE("the main file of a corrected world has the format although no program has closed it",
          "[store][clock][sqlite]") {
  const TempFolder folder;
  auto store = *create_world(folder / "w", sample_meta());
  REQUIRE(store->raise_epoch().has_value());
  const auto records = corrected_records();
  const auto format = [&] {
    std::ifstream file(folder / "w/world.sqlite", std::ios::binary);
    std::array<char, 64> header{};
    REQUIRE(file.read(header.data(), header.size()));
    return int{header[63]};  // the last byte of user_version
  };
  REQUIRE(store->append({}, std::span(records).first(20)).has_value());
  CHECK(format() == 5);
  REQUIRE(store->append({}, std::span(records).subspan(20, 1)).has_value());
  CHECK(format() == 6);
}

TEST_CASE("the check names a fallen time without a correction, and a list of eras that lacks one",
          "[store][clock][damage]") {
  TempPlace place;
  SECTION("a fallen time") {
    auto store = *create_world(place / "w", sample_meta());
    REQUIRE(store->raise_epoch().has_value());
    SplitMix64 rng(2);
    auto records = sample_records(rng, 1, 1, 4);
    records[2].time_us -= kMinute;
    REQUIRE(store->append({}, records).has_value());
    const auto check = store->check();
    REQUIRE_FALSE(check.has_value());
    CHECK(check.error().where == "edit_log seq=3");
  }
  SECTION("a lost list") {
    make_corrected_world(place / "w", corrected_records());
    raw_sql(place / "w/world.sqlite", "DELETE FROM meta WHERE key = 'log_eras'");
    const auto check = (*open_world(place / "w", StoreAccess::read_only))->check();
    REQUIRE_FALSE(check.has_value());
    CHECK(check.error().where == "meta key=log_eras");
  }
}

}  // namespace runstone::test
