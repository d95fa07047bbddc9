#include "server/history/log_marks.hpp"

#include <catch2/catch.hpp>

#include "tests/support/core/temp_folder.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {
namespace {

/// A world with this many records.
struct MarksWorld {
  explicit MarksWorld(Sequence count) {
    store = *create_world(folder.path(), sample_meta());
    REQUIRE(store->raise_epoch().has_value());
    SplitMix64 rng(3);
    const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
    if (count == 0) return;
    records = sample_records(rng, 1, 1, count);
    REQUIRE(store->append(players, records).has_value());
  }
  FoundLogMarks read(Sequence first, Sequence last, std::uint8_t count) {
    const auto found = read_log_marks(*store, {1, first, last, count});
    REQUIRE(found.has_value());
    for (const LogMark& mark : found->marks) {
      const EditRecord& record = records.at(mark.seq - 1);
      CHECK(mark == LogMark{record.version.seq, record.time_us, record.op.author, record.cause,
                            kind_of(record.edit)});
    }
    return *found;
  }
  static std::vector<Sequence> sequences(const FoundLogMarks& found) {
    std::vector<Sequence> out;
    for (const LogMark& mark : found.marks) out.push_back(mark.seq);
    return out;
  }

  TempFolder folder;
  std::unique_ptr<Store> store;
  std::vector<EditRecord> records;
};

using Sequences = std::vector<Sequence>;

}  // namespace

TEST_CASE("marks are evenly spaced, with both ends", "[history]") {
  MarksWorld world(101);
  CHECK(world.sequences(world.read(1, 101, 5)) == Sequences{1, 26, 51, 76, 101});
  CHECK(world.sequences(world.read(10, 12, 3)) == Sequences{10, 11, 12});
  CHECK(world.sequences(world.read(50, 100, 1)) == Sequences{100});
  CHECK(world.sequences(world.read(7, 7, 128)) == Sequences{7});
}

TEST_CASE("more marks than records are each record once", "[history]") {
  MarksWorld world(6);
  CHECK(world.sequences(world.read(1, 6, 128)) == Sequences{1, 2, 3, 4, 5, 6});
}

TEST_CASE("records that the log does not have are left out", "[history]") {
  MarksWorld world(20);
  CHECK(world.sequences(world.read(15, kSequenceMax, 6)) == Sequences{15, 16, 17, 18, 19, 20});
  CHECK(world.read(21, 30, 10).marks.empty());
  CHECK(world.read(1, kSequenceMax, 128).marks.size() == 20);
  MarksWorld empty(0);
  CHECK(empty.read(1, 100, 10).marks.empty());
  CHECK(empty.read(1, 100, 10).first == 1);
}

}  // namespace runstone::test
