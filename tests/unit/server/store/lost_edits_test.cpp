// Worlds that have lost durable edits, because the WAL is gone or damaged or an older database was
// put back. world.durable reveals it.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "common/core/epoch_branch.hpp"
#include "server/store/store.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/sql/crash_image.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

constexpr Sequence kSavedEdits = 12, kWalEdits = 8;

std::unique_ptr<Store> world_of(const std::string& folder, StoreAccess access) {
  auto store = open_world(folder, access);
  if (!store) FAIL(store.error().message());
  return *std::move(store);
}

/// Makes a world whose WAL holds its second start and its last kWalEdits edits, as kill -9 leaves
/// it. The first kSavedEdits edits and the first start are in the main file.
void make_killed_world(const std::string& folder) {
  const TempFolder live;
  SplitMix64 rng(31);
  {
    const auto store = *create_world(live.path(), sample_meta());
    REQUIRE(*store->raise_epoch() == 1);
    const PlayerRow player = sample_player(1);
    REQUIRE(store->append({&player, 1}, sample_records(rng, 1, 1, kSavedEdits)).has_value());
  }
  const auto store = world_of(live.path(), StoreAccess::read_write);
  REQUIRE(*store->raise_epoch() == 2);
  const PlayerRow player = sample_player(2);
  for (Sequence seq = kSavedEdits + 1; seq <= kSavedEdits + kWalEdits; ++seq)
    REQUIRE(store->append({&player, 1}, sample_records(rng, 2, seq, 1)).has_value());
  copy_crash_image(live.path(), folder);
}

std::string text_of_file(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Returns the cause of the error of a server's open, or "opens".
std::string refusal(const std::string& folder) {
  const auto store = open_world(folder, StoreAccess::read_write);
  return store ? "opens" : store.error().what;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

constexpr const char* kAllOfWalLost =
    "ends at seq=12, but seq=20 was durable: the edits seq=13 to seq=20 are lost, because "
    "world.sqlite-wal was lost or damaged, or an older world.sqlite was put back. Put the world "
    "back from a backup, or run `runstone-server repair`, or start the server once with "
    "--accept-losses";

}  // namespace

TEST_CASE("a killed world with its WAL has lost nothing", "[store][loss][sqlite]") {
  const TempFolder folder;
  make_killed_world(folder.path());
  {
    const auto reader = world_of(folder.path(), StoreAccess::read_only);
    CHECK_FALSE(reader->loss().has_value());
    CHECK(*reader->last_sequence() == kSavedEdits + kWalEdits);
  }
  CHECK(refusal(folder.path()) == "opens");
}

TEST_CASE("a deleted WAL is noticed, and the world stays as it is", "[store][loss][sqlite]") {
  const TempFolder folder;
  make_killed_world(folder.path());
  std::filesystem::remove(folder / "world.sqlite-wal");
  const std::string before = text_of_file(folder / "world.sqlite");
  const std::string mark = text_of_file(folder / "world.durable");
  CHECK(refusal(folder.path()) == kAllOfWalLost);
  {
    const auto reader = world_of(folder.path(), StoreAccess::read_only);
    REQUIRE(reader->loss().has_value());
    CHECK(reader->loss()->message() == folder / "world.sqlite: edit_log: " + kAllOfWalLost);
    CHECK(*reader->last_sequence() == kSavedEdits);  // what is left can be read
    CHECK(reader->check().has_value());
  }
  CHECK(refusal(folder.path()) == kAllOfWalLost);
  CHECK(text_of_file(folder / "world.sqlite") == before);
  CHECK(text_of_file(folder / "world.durable") == mark);
}

TEST_CASE("a flipped bit anywhere in the WAL is noticed, and the WAL is left for a repair",
          "[store][loss][sqlite]") {
  const TempFolder folder;
  make_killed_world(folder.path());
  const std::string wal = folder / "world.sqlite-wal";
  const std::string before = text_of_file(wal);
  REQUIRE(before.size() > 30'000);
  // The steps hit the WAL's header, the headers of frames and their pages.
  for (std::uintmax_t at = 5; at < before.size(); at += 1 + before.size() / 97) {
    CAPTURE(at);
    flip_bit(wal, at);
    const std::string text = refusal(folder.path());
    INFO(text);
    CHECK(has(text, " are lost, because world.sqlite-wal was lost or damaged"));
    CHECK(has(text, "seq=20 was durable"));
    {
      const auto reader = open_world(folder.path(), StoreAccess::read_only);
      CHECK((reader.has_value() && (*reader)->loss().has_value()));
    }
    flip_bit(wal, at);
    REQUIRE(text_of_file(wal) == before);
    std::filesystem::remove(folder / "world.sqlite-shm");
  }
  CHECK(refusal(folder.path()) == "opens");
  CHECK(*world_of(folder.path(), StoreAccess::read_only)->last_sequence() ==
        kSavedEdits + kWalEdits);
}

TEST_CASE("a damaged WAL that hides newer pages of the main file is noticed",
          "[store][loss][sqlite]") {
  const TempFolder live, folder;
  SplitMix64 rng(41);
  {
    const auto store = *create_world(live.path(), sample_meta());
    REQUIRE(store->raise_epoch().has_value());
    for (Sequence seq = 1; seq <= 60; ++seq)
      REQUIRE(store->append({}, sample_records(rng, 1, seq, 1)).has_value());
    // The whole WAL is written into the main file and stays, because the store is open.
    REQUIRE(raw_sql(live / "world.sqlite", "PRAGMA wal_checkpoint(PASSIVE)") == "0");
    copy_crash_image(live.path(), folder.path());
  }
  const std::uintmax_t bytes = std::filesystem::file_size(folder / "world.sqlite-wal");
  int opened = 0;
  for (std::uintmax_t at = 40; at < bytes; at += 1 + bytes / 41) {
    CAPTURE(at);
    const TempFolder damaged;
    copy_crash_image(folder.path(), damaged.path());
    flip_bit(damaged / "world.sqlite-wal", at);
    const std::string text = refusal(damaged.path());
    INFO(text);
    if (text != "opens") {
      CHECK((has(text, "are lost") || has(text, "malformed") || has(text, "hides newer pages")));
      continue;
    }
    // No complete commit precedes the damage, so the main file alone counts.
    ++opened;
    const auto reader = world_of(damaged.path(), StoreAccess::read_only);
    CHECK(*reader->last_sequence() == 60);
    CHECK(reader->check().has_value());
  }
  CHECK(opened < 5);
  std::filesystem::remove(folder / "world.sqlite-wal");
  CHECK(refusal(folder.path()) == "opens");
}

TEST_CASE("a log that ends elsewhere than meta says is not written, with or without a mark",
          "[store][loss][sqlite]") {
  const TempFolder folder;
  make_killed_world(folder.path());
  REQUIRE(raw_sql(folder / "world.sqlite", "DELETE FROM edit_log WHERE seq = 20").empty());
  std::filesystem::remove(folder / "world.durable");
  CHECK(has(refusal(folder.path()), "ends at seq=19, but meta says seq=20"));
  const auto repaired = open_world(folder.path(), StoreAccess::repair);
  REQUIRE_FALSE(repaired.has_value());
  CHECK(repaired.error().kind == StoreError::Kind::corrupt);
  CHECK(world_of(folder.path(), StoreAccess::read_only)->loss().has_value());
}

TEST_CASE("an accepted loss raises the epoch above every lost start, and ends",
          "[store][loss][sqlite]") {
  const TempFolder folder;
  make_killed_world(folder.path());
  std::filesystem::remove(folder / "world.sqlite-wal");
  {
    const auto store = world_of(folder.path(), StoreAccess::repair);
    const auto lost = store->accept_losses();
    REQUIRE(lost.has_value());
    REQUIRE(lost->size() == 1);
    CHECK(has(lost->front(), "the edits seq=13 to seq=20 are lost"));
    CHECK(store->author_max() == 2);  // the row of author 2 is lost with the WAL
  }
  // Before the start that goes on, the loss is still reported.
  CHECK(has(refusal(folder.path()), "seq=13 to seq=20 are lost"));
  {
    const auto store = world_of(folder.path(), StoreAccess::repair);
    REQUIRE(store->accept_losses().has_value());
    const Epoch epoch = *store->raise_epoch();
    CHECK(epoch > 2);  // epoch 2 is lost
    CHECK_FALSE(is_same_branch(epoch, 2));
    SplitMix64 rng(5);
    REQUIRE(store->append({}, sample_records(rng, epoch, kSavedEdits + 1, 2)).has_value());
  }
  const auto store = world_of(folder.path(), StoreAccess::read_write);
  CHECK_FALSE(store->loss().has_value());
  CHECK_FALSE(is_same_branch(store->epoch(), 2));
  CHECK(store->author_max() == 2);
  CHECK(*store->last_sequence() == kSavedEdits + 2);
  CHECK(store->check().has_value());
}

TEST_CASE("nothing is accepted where nothing is lost", "[store][loss][sqlite]") {
  const TempFolder folder;
  make_killed_world(folder.path());
  const auto store = world_of(folder.path(), StoreAccess::repair);
  CHECK(store->accept_losses()->empty());
  CHECK(store->epoch() == 2);
  CHECK(*store->last_sequence() == kSavedEdits + kWalEdits);
}

TEST_CASE("a lost start is noticed although no edit is lost", "[store][loss][sqlite]") {
  const TempFolder live, folder;
  {
    const auto store = *create_world(live.path(), sample_meta());
    REQUIRE(*store->raise_epoch() == 1);
  }
  const auto store = world_of(live.path(), StoreAccess::read_write);
  REQUIRE(*store->raise_epoch() == 2);
  copy_crash_image(live.path(), folder.path());
  std::filesystem::remove(folder / "world.sqlite-wal");
  CHECK(has(refusal(folder.path()), "epoch=2 was durable: the database has epoch=1"));
}

TEST_CASE("an older database that was put back is noticed", "[store][loss][sqlite]") {
  const TempFolder folder;
  make_killed_world(folder.path());
  std::filesystem::copy_file(folder / "world.sqlite", folder / "old");
  CHECK(refusal(folder.path()) == "opens");  // the WAL is written into the main file and deleted
  REQUIRE_FALSE(std::filesystem::exists(folder / "world.sqlite-wal"));
  std::filesystem::rename(folder / "old", folder / "world.sqlite");
  CHECK(refusal(folder.path()) == kAllOfWalLost);
}

TEST_CASE("a checkpoint of the WAL and a compaction lose nothing", "[store][loss][sqlite]") {
  const TempFolder folder;
  make_killed_world(folder.path());
  REQUIRE(raw_sql(folder / "world.sqlite", "PRAGMA wal_checkpoint(TRUNCATE)") == "0");
  std::filesystem::remove(folder / "world.sqlite-wal");
  CHECK(refusal(folder.path()) == "opens");
  {
    const auto store = world_of(folder.path(), StoreAccess::read_write);
    const LogEnd end = store->log_range()->last;
    REQUIRE(store->save_keyframe({}, Keyframe{end, 0, {}}).has_value());
    REQUIRE(store->compact(end.version.seq).has_value());
  }
  CHECK(refusal(folder.path()) == "opens");
}

TEST_CASE("a world of an older program without a mark opens without a word and gets one",
          "[store][loss][sqlite]") {
  const TempFolder folder;
  make_killed_world(folder.path());
  std::filesystem::remove(folder / "world.sqlite-wal");
  REQUIRE(raw_sql(folder / "world.sqlite", "DELETE FROM meta WHERE key = 'open_epoch'").empty());
  const auto mark = text_of_file(folder / "world.durable");
  std::filesystem::remove(folder / "world.durable");
  {
    const auto store = world_of(folder.path(), StoreAccess::read_write);
    CHECK_FALSE(store->loss().has_value());
    CHECK_FALSE(std::filesystem::exists(folder / "world.durable"));  // opening writes none
    REQUIRE(store->raise_epoch().has_value());
  }
  CHECK(std::filesystem::exists(folder / "world.durable"));
  CHECK(text_of_file(folder / "world.durable") != mark);
  CHECK(refusal(folder.path()) == "opens");
}

TEST_CASE("a damaged mark is reported until the loss is accepted", "[store][loss][sqlite]") {
  const TempFolder folder;
  make_killed_world(folder.path());
  flip_bit(folder / "world.durable", 20);
  flip_bit(folder / "world.durable", 4096 + 20);
  CHECK(has(refusal(folder.path()), "it is not known whether the log still has all of its edits"));
  CHECK(has(refusal(folder.path()), "--accept-losses"));
  {
    const auto store = world_of(folder.path(), StoreAccess::repair);
    CHECK(store->accept_losses()->size() == 1);
    CHECK(*store->raise_epoch() > 10'000);  // nobody knows how many starts are lost
  }
  CHECK(refusal(folder.path()) == "opens");
}
