#include "server/history/find_action.hpp"

#include <catch2/catch.hpp>

#include "tests/support/core/temp_folder.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {
namespace {

/// A world whose log the test writes.
struct ActionLog {
  ActionLog() {
    REQUIRE(create_world(folder.path(), sample_meta()).has_value());
    store = *open_world(folder.path(), StoreAccess::read_write);
    epoch = *store->raise_epoch();
  }
  void add(AuthorId author, ClientInstance instance, ClientSequence seq, Sequence subject = 0,
           Cause cause = Cause::player) {
    EditRecord record;
    record.version = {epoch, records.size() + 1};
    record.op = {author, instance, seq};
    record.time_us = static_cast<TimeUs>(records.size());
    record.cause = cause;
    record.edit = {SetVoxel{{static_cast<std::int32_t>(records.size()), 0, 0}}, {}, 1};
    record.subject = subject;
    records.push_back(record);
  }
  FoundAction find(AuthorId author, ClientInstance instance, ClientSequence seq) {
    if (!records.empty()) {
      const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
      REQUIRE(store->append(players, records).has_value());
      records.clear();
    }
    const auto found = find_action(*store, {author, instance, seq});
    REQUIRE(found.has_value());
    return *found;
  }
  TempFolder folder;
  std::unique_ptr<Store> store;
  Epoch epoch = 0;
  std::vector<EditRecord> records;
};

}  // namespace

TEST_CASE("an action is found by the operation of its first edit", "[history][undo]") {
  ActionLog log;
  log.add(1, 7, 3);      // 1
  log.add(1, 7, 5);      // 2
  log.add(2, 7, 5);      // 3: another player
  log.add(1, 7, 6, 2);   // 4
  log.add(1, 7, 8);      // 5
  log.add(1, 7, 9, 5);   // 6: another action
  log.add(1, 7, 10, 2);  // 7
  log.add(1, 8, 5);      // 8: another client
  CHECK(log.find(1, 7, 5).first == 2);
  CHECK(log.find(1, 7, 8).first == 5);
  CHECK(log.find(1, 7, 3).first == 1);
  CHECK(log.find(2, 7, 5).first == 3);
  CHECK(log.find(1, 8, 5).first == 8);
  CHECK(log.find(1, 7, 4).first == 0);
  CHECK(log.find(1, 7, 6).first == 0);  // an edit of another action begins none
}

TEST_CASE("an action whose last toggle is an undo is undone", "[history][undo]") {
  ActionLog log;
  log.add(1, 7, 5);
  log.add(1, 7, 6, 1);
  SECTION("undo") {
    log.add(1, 99, 1, 1, Cause::undo);
    log.add(1, 99, 2, 1, Cause::undo);
    CHECK(log.find(1, 7, 5).is_undone);
  }
  SECTION("undo and redo") {
    log.add(1, 99, 1, 1, Cause::undo);
    log.add(1, 99, 2, 1, Cause::redo);
    CHECK_FALSE(log.find(1, 7, 5).is_undone);
  }
  SECTION("of another action") {
    log.add(1, 7, 7);
    log.add(1, 99, 1, 3, Cause::undo);
    CHECK_FALSE(log.find(1, 7, 5).is_undone);
  }
  SECTION("by another player") {
    log.add(2, 99, 1, 1, Cause::undo);
    CHECK_FALSE(log.find(1, 7, 5).is_undone);
  }
  CHECK(log.find(1, 7, 5).first == 1);
}

}  // namespace runstone::test
