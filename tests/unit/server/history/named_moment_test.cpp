// Moments as users write them, and their sequences in a log.
#include "server/history/named_moment.hpp"

#include <catch2/catch.hpp>

#include "common/core/utc_text.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/store/compact_by_hand.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

constexpr TimeUs kSecond = 1'000'000;

NamedMoment parsed(const std::string& text) {
  const auto moment = parse_moment(text);
  if (!moment) FAIL(moment.error());
  return *moment;
}

}  // namespace

TEST_CASE("moments are sequences, times in UTC and times before the end", "[history][moment]") {
  CHECK(parsed("0") == NamedMoment(Sequence{0}));
  CHECK(parsed("9120") == NamedMoment(Sequence{9120}));
  CHECK(parsed("9223372036854775807") == NamedMoment(kSequenceMax));
  CHECK(parsed("1970-01-01T00:00:00Z") == NamedMoment(AtTime{0}));
  CHECK(parsed("2026-11-21T23:05:00Z") == NamedMoment(AtTime{1'795'302'300 * kSecond}));
  CHECK(parsed("2026-11-21T23:05Z") == NamedMoment(AtTime{1'795'302'300 * kSecond}));
  CHECK(parsed("2024-02-29T12:00:01.5Z") == NamedMoment(AtTime{1'709'208'001 * kSecond + 500'000}));
  CHECK(parsed("2024-02-29T12:00:01.000001Z") == NamedMoment(AtTime{1'709'208'001 * kSecond + 1}));
  CHECK(parsed("-2h30m") == NamedMoment(BeforeEnd{9'000 * kSecond}));
  CHECK(parsed("-1d2h3m4s") == NamedMoment(BeforeEnd{93'784 * kSecond}));
  CHECK(parsed("2026-11-21") == NamedMoment(AtTime{1'795'219'200 * kSecond}));
  CHECK(parsed("-90s") == NamedMoment(BeforeEnd{90 * kSecond}));
}

TEST_CASE("a text that is no moment is refused with examples of moments", "[history][moment]") {
  for (const char* text : {"",
                           "-",
                           "x",
                           "12x",
                           " 12",
                           "12 ",
                           "+12",
                           "9223372036854775808",
                           "99999999999999999999",
                           "-2",
                           "-h",
                           "-30m2h",
                           "-2h2h",
                           "-2h 30m",
                           "-1234567s",
                           "2026-11-21T23:05:00+01:00",
                           "2026-13-21T23:05:00Z",
                           "2025-02-29T00:00:00Z",
                           "2026-11-31T00:00:00Z",
                           "2026-11-21T24:00:00Z",
                           "2026-11-21T23:60:00Z",
                           "2026-11-21T23:05:61Z",
                           "2026-11-21T23:05:00.Z",
                           "2026-11-21T23:05:00.1234567Z",
                           "2026-1-21T23:05:00Z",
                           "26-11-21T23:05:00Z",
                           "2026-11-21 23:05:00Z",
                           "2026-11-21T23:05:00Zx"}) {
    CAPTURE(text);
    const auto moment = parse_moment(text);
    REQUIRE_FALSE(moment.has_value());
    CHECK(moment.error().find('"' + std::string(text) + '"') == 0);
  }
}

TEST_CASE("a moment means the last edit that is not later", "[history][moment]") {
  const TempFolder folder;
  SplitMix64 rng(1);
  auto store = *create_world(folder.path(), sample_meta());
  CHECK(*sequence_of(*store, AtTime{5}) == 0);
  CHECK(*sequence_of(*store, BeforeEnd{5}) == 0);
  REQUIRE(store->raise_epoch().has_value());
  auto records = sample_records(rng, 1, 1, 40);
  const TimeUs start = 1'700'000'000 * kSecond;
  for (EditRecord& record : records) {
    record.time_us =
        start + static_cast<TimeUs>(record.version.seq / 2) * kSecond;  // two edits a second
  }
  REQUIRE(store->append({}, records).has_value());
  const auto meant = [&](const NamedMoment& moment) {
    const auto seq = sequence_of(*store, moment);
    return seq ? std::to_string(*seq) : seq.error().what;
  };
  for (TimeUs us = start - kSecond; us <= start + 21 * kSecond; us += kSecond / 4) {
    Sequence last = 0;
    for (const EditRecord& record : records) {
      if (record.time_us <= us) last = record.version.seq;
    }
    CAPTURE(us - start);
    CHECK(meant(AtTime{us}) == std::to_string(last));
    if (us <= records.back().time_us)
      CHECK(meant(BeforeEnd{records.back().time_us - us}) == std::to_string(last));
  }
  CHECK(meant(Sequence{0}) == "0");
  CHECK(meant(Sequence{40}) == "40");
  CHECK(meant(Sequence{41}) == "ends at seq=40, before seq=41");
  CHECK(meant(AtTime{std::numeric_limits<TimeUs>::max()}) == "40");
  CHECK(meant(AtTime{std::numeric_limits<TimeUs>::min()}) == "0");
  store.reset();
  compact_by_hand(folder / "world.sqlite", {records[19].version, records[19].time_us}, {});
  store = *open_world(folder.path(), StoreAccess::read_only);
  CHECK(meant(Sequence{20}) == "20");
  const std::string removed =
      "removed by retention up to seq=20 (" + utc_text(records[19].time_us) + ")";
  CHECK(meant(Sequence{19}) == "begins at seq=21: seq=19 was " + removed);
  CHECK(meant(AtTime{records[19].time_us}) == "21");
  CHECK(meant(AtTime{records[19].time_us - 1}) ==
        "begins at seq=21: what was before that time was " + removed);
}
