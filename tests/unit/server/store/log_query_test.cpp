// Queries of the log against a naive scan of it, in worlds that grew in many small commits, were
// opened again, compacted or damaged.
#include <algorithm>
#include <catch2/catch.hpp>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "server/store/sqlite_backend.hpp"
#include "tests/support/edits/builder_session.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/sql/temp_place.hpp"
#include "tests/support/store/compact_by_hand.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

/// Returns builders' edits with some boxes, spheres, rollbacks and console edits among them.
std::vector<EditRecord> mixed_records(std::uint64_t seed, std::size_t count) {
  BuilderSession session(seed, 5);
  SplitMix64 rng(seed);
  std::vector<EditRecord> records;
  for (std::size_t i = 0; i < count; ++i) {
    records.push_back(session.next());
    if (rng.below(10) == 0) records.back().edit = sample_edit(rng);
    if (rng.below(20) == 0) records.back().cause = static_cast<Cause>(1 + rng.below(kVoxelCauses));
    if (records.back().cause == Cause::rights) records.back().edit = sample_rights_edit(rng);
    if (i > 0 && rng.below(8) == 0) records.back().time_us = records[i - 1].time_us;  // equal times
    if (i > 0) records.back().time_us = std::max(records.back().time_us, records[i - 1].time_us);
  }
  return records;
}

/// Writes the records in commits of 1 to 40, and opens the world three times.
void make_world(const std::string& place, std::vector<EditRecord>& records, SplitMix64& rng) {
  REQUIRE(create_world(place, sample_meta()).has_value());
  std::size_t done = 0;
  for (std::size_t part = 1; part <= 3; ++part) {
    auto store = *open_world(place, StoreAccess::read_write);
    const Epoch epoch = *store->raise_epoch();
    const std::size_t end = records.size() * part / 3;
    while (done < end) {
      const std::size_t count = std::min<std::size_t>(1 + rng.below(40), end - done);
      const std::span<EditRecord> batch(records.data() + done, count);
      for (EditRecord& record : batch) record.version.epoch = epoch;
      REQUIRE(store->append({}, batch).has_value());
      done += count;
    }
  }
}

bool answers(const LogQuery& query, const EditRecord& record) {
  const VoxelBox box = bounding_box(record.edit);
  return (!query.author || *query.author == record.op.author) && record.time_us >= query.from_us &&
         record.time_us <= query.until_us && (!query.cause || *query.cause == record.cause) &&
         (!query.box || !intersect(*query.box, box).empty()) && record.version.seq >= query.first &&
         record.version.seq <= query.last;
}

LogQuery random_query(SplitMix64& rng, const std::vector<EditRecord>& records) {
  LogQuery query;
  const auto any = [&]() -> const EditRecord& {
    return records[rng.below(static_cast<std::uint32_t>(records.size()))];
  };
  if (rng.below(2) == 0) query.author = rng.below(7);
  if (rng.below(3) == 0) query.from_us = any().time_us + rng.between(-1, 1);
  if (rng.below(3) == 0) query.until_us = any().time_us + rng.between(-1, 1);
  if (rng.below(2) == 0) {
    const VoxelPos at = bounding_box(any().edit).min;
    const VoxelPos min{at.x + rng.between(-9, 9), at.y + rng.between(-9, 9),
                       at.z + rng.between(-9, 9)};
    query.box = VoxelBox{
        min, {min.x + rng.between(1, 30), min.y + rng.between(1, 30), min.z + rng.between(1, 30)}};
  }
  if (rng.below(4) == 0) query.cause = static_cast<Cause>(rng.below(kCauseMax + 1));
  if (rng.below(4) == 0) query.first = any().version.seq;
  if (rng.below(4) == 0) query.last = any().version.seq;
  return query;
}

std::vector<EditRecord> ask(Store& store, const LogQuery& query) {
  std::vector<EditRecord> found;
  const auto queried = store.query_log(query, [&](const EditRecord& record) {
    found.push_back(record);
    return true;
  });
  if (!queried) FAIL(queried.error().message());
  return found;
}

/// Returns the number of queries that found a record.
std::size_t compare(Store& store, const std::vector<EditRecord>& records, SplitMix64& rng,
                    int questions) {
  std::size_t answered = 0;
  for (int i = 0; i < questions; ++i) {
    const LogQuery query = random_query(rng, records);
    std::vector<EditRecord> naive;
    for (const EditRecord& record : records) {
      if (answers(query, record)) naive.push_back(record);
    }
    CAPTURE(i);
    REQUIRE(ask(store, query) == naive);
    answered += naive.empty() ? 0 : 1;
  }
  return answered;
}

}  // namespace

TEST_CASE("queries of the log find the same records as a naive scan", "[store][query]") {
  TempPlace place;
  SplitMix64 rng(1);
  auto records = mixed_records(1, 1500);
  make_world(place.path(), records, rng);
  auto store = *open_world(place.path(), StoreAccess::read_only);
  CHECK(compare(*store, records, rng, 400) > 150);
  CHECK(ask(*store, {}) == records);
  CHECK(store->check().has_value());
  for (AuthorId author = 0; author <= 6; ++author) {
    const Sequence last = 1 + rng.below(static_cast<std::uint32_t>(records.size()));
    std::vector<LogRow> rows, naive;
    const auto read = store->rows_of_author(author, last, [&](const LogRow& row) {
      rows.push_back(row);
      return rows.size() < 100;
    });
    REQUIRE(read.has_value());
    for (Sequence seq = last; seq > 0 && naive.size() < 100; --seq) {
      const EditRecord& record = records[seq - 1];
      if (record.op.author == author)
        naive.push_back({record.version, record.op, record.cause, record.subject});
    }
    CHECK(rows == naive);
  }
  std::size_t seen = 0;
  REQUIRE(store->query_log({}, [&](const EditRecord&) { return ++seen < 7; }).has_value());
  CHECK(seen == 7);
}

TEST_CASE("queries find the edits of a stretch that one author filled", "[store][query]") {
  // The griefer's segments follow each other without a gap, so they are read in the order of the log;
  // later another author's edits lie between them. Their descriptors are short and long.
  TempPlace place;
  SplitMix64 rng(7);
  auto records = mixed_records(7, 1200);
  for (std::size_t i = 300; i < 1000; ++i) {
    if (i >= 600 && rng.below(3) == 0) continue;
    records[i].op.author = 6;
    records[i].cause = Cause::player;
    records[i].subject = 0;
    records[i].edit = sample_edit(rng);
  }
  make_world(place.path(), records, rng);
  auto store = *open_world(place.path(), StoreAccess::read_only);
  CHECK(compare(*store, records, rng, 300) > 100);
  std::size_t seen = 0;
  LogQuery query;
  query.box = VoxelBox{{-60, -60, -60}, {60, 60, 60}};
  REQUIRE(store->query_log(query, [&](const EditRecord&) { return ++seen < 400; }).has_value());
  CHECK(seen == 400);
}

TEST_CASE("a query leaves out the edits that its condition does not want", "[store][query]") {
  TempPlace place;
  SplitMix64 rng(8);
  auto records = mixed_records(8, 900);
  make_world(place.path(), records, rng);
  auto store = *open_world(place.path(), StoreAccess::read_only);
  std::size_t found = 0, left_out = 0;
  for (int i = 0; i < 100; ++i) {
    // Some boxes want the edits from a sequence on.
    std::vector<std::pair<VoxelBox, Sequence>> wanted(1 + rng.below(4));
    for (auto& [box, from] : wanted) {
      const VoxelPos at = bounding_box(records[rng.below(900)].edit).min;
      box = {at, {at.x + rng.between(1, 40), at.y + rng.between(1, 40), at.z + rng.between(1, 40)}};
      from = 1 + rng.below(900);
    }
    LogQuery query;
    query.first = kSequenceMax;
    for (const auto& [box, from] : wanted) {
      query.box = query.box ? bounding_box(*query.box, box) : box;
      query.first = std::min(query.first, from);
    }
    query.wants = [&](const VoxelBox& box, Sequence last) {
      return std::any_of(wanted.begin(), wanted.end(), [&](const auto& one) {
        return !intersect(one.first, box).empty() && one.second <= last;
      });
    };
    std::vector<EditRecord> naive;
    for (const EditRecord& record : records) {
      if (!answers(query, record)) continue;
      if (query.wants(bounding_box(record.edit), record.version.seq)) {
        naive.push_back(record);
      } else {
        ++left_out;
      }
    }
    CAPTURE(i);
    REQUIRE(ask(*store, query) == naive);
    found += naive.size();
  }
  CHECK(found > 1'000);
  CHECK(left_out > 1'000);
}

TEST_CASE("a damaged record is named when its turn comes", "[store][query][sqlite]") {
  TempPlace place;
  SplitMix64 rng(9);
  auto records = mixed_records(9, 200);
  for (std::size_t i = 148; i <= 149; ++i) {
    records[i].cause = Cause::player;
    records[i].subject = 0;
    records[i].edit = {SetVoxel{{1, 2, 3}}, {}, 1};
  }
  make_world(place.path(), records, rng);
  REQUIRE(
      raw_sql(place / "world.sqlite", "UPDATE edit_log SET checksum = checksum + 1 WHERE seq = 150")
          .empty());
  auto store = *open_world(place.path(), StoreAccess::read_only);
  const VoxelBox everywhere{{-kWorldLimit, -kWorldLimit, -kWorldLimit},
                            {kWorldLimit - 1, kWorldLimit - 1, kWorldLimit - 1}};
  for (const bool has_box : {false, true}) {
    LogQuery query;
    if (has_box) query.box = everywhere;
    std::vector<EditRecord> found;
    const auto queried = store->query_log(query, [&](const EditRecord& record) {
      found.push_back(record);
      return true;
    });
    CAPTURE(has_box);
    REQUIRE_FALSE(queried.has_value());
    CHECK(queried.error().where == "edit_log seq=150");
    REQUIRE_FALSE(found.empty());
    CHECK(found.back().version.seq == 149);
  }
}

TEST_CASE("queries reach no further back than the log", "[store][query]") {
  TempPlace place;
  SplitMix64 rng(3);
  auto records = mixed_records(3, 300);
  make_world(place.path(), records, rng);
  compact_by_hand(place / "world.sqlite", {records[99].version, records[99].time_us}, {});
  records.erase(records.begin(), records.begin() + 100);
  auto store = *open_world(place.path(), StoreAccess::read_only);
  CHECK(compare(*store, records, rng, 100) > 20);
}

TEST_CASE("a segment that misses an edit is damage that the check names", "[store][query]") {
  TempPlace place;
  SplitMix64 rng(4);
  auto records = mixed_records(4, 300);
  make_world(place.path(), records, rng);
  const std::string file = place / "world.sqlite";
  const std::string change = GENERATE(
      std::string("DELETE FROM log_box WHERE first_seq = (SELECT max(first_seq) FROM log_box)"),
      std::string("UPDATE log_box SET max_x = min_x WHERE first_seq = (SELECT max(first_seq) "
                  "FROM log_box)"),
      std::string(
          "UPDATE log_box SET author = 77 WHERE first_seq = (SELECT max(first_seq) FROM log_box)"));
  REQUIRE(raw_sql(file, change).find("ERROR") == std::string::npos);
  const auto checked = (*open_world(place.path(), StoreAccess::read_only))->check();
  REQUIRE_FALSE(checked.has_value());
  CHECK(checked.error().where == "log_box");
}

TEST_CASE("a commit that was refused leaves the segments as they were", "[store][query]") {
  TempPlace place;
  SplitMix64 rng(5);
  auto store = *create_world(place.path(), sample_meta());
  REQUIRE(store->raise_epoch().has_value());
  auto records = mixed_records(5, 40);
  REQUIRE(store->append({}, std::span(records).first(20)).has_value());
  const PlayerRow one = sample_player(1);
  PlayerRow other = sample_player(2);
  other.key = one.key;  // the table refuses a second player with that key
  CHECK_FALSE(store->append(std::vector<PlayerRow>{one, other}, std::span(records).subspan(20))
                  .has_value());
  CHECK(store->check().has_value());
  REQUIRE(store->append({}, std::span(records).subspan(20)).has_value());
  CHECK(store->check().has_value());
  CHECK(compare(*store, records, rng, 50) > 10);
}

TEST_CASE("a builders' edit costs at most 120 bytes of database, five edits a commit",
          "[store][query][sqlite]") {
  TempPlace place;
  auto store = *create_world(place.path(), sample_meta());
  REQUIRE(store->raise_epoch().has_value());
  const auto bytes_of_file = [&] {
    return std::stol(raw_sql(
        store->file(), "SELECT page_count * page_size FROM pragma_page_count, pragma_page_size"));
  };
  const long before = bytes_of_file();
  BuilderSession session(6);
  constexpr int kEdits = 20'000;
  std::vector<EditRecord> batch;
  for (int i = 0; i < kEdits; ++i) {
    batch.push_back(session.next());
    if (batch.size() < 5) continue;
    REQUIRE(store->append({}, batch).has_value());
    batch.clear();
  }
  const double bytes = static_cast<double>(bytes_of_file() - before) / kEdits;
  CAPTURE(bytes);
  CHECK(bytes < 120);
  CHECK(bytes > 60);
}
