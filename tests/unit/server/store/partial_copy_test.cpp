// Worlds that were copied without all of their files, and the file that a clean stop leaves.
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "common/core/epoch_branch.hpp"
#include "server/store/copy_stored_world.hpp"
#include "server/store/sqlite_backend.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/sql/power_loss_vfs.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {
namespace {

namespace fs = std::filesystem;

constexpr Sequence kCopiedEdits = 20;

std::unique_ptr<Store> copied_world(const std::string& folder) {
  auto store = open_world(folder, StoreAccess::read_write);
  if (!store) FAIL(store.error().message());
  return *std::move(store);
}

void append_one(Store& store, Sequence seq) {
  SplitMix64 rng(seq);
  const PlayerRow player = sample_player(1);
  REQUIRE(store.append({&player, 1}, sample_records(rng, store.epoch(), seq, 1)).has_value());
}

/// Returns a running world: each edit is a commit of its own.
std::unique_ptr<Store> running_world(const std::string& folder) {
  auto store = *create_world(folder, sample_meta());
  REQUIRE(store->raise_epoch().has_value());
  for (Sequence seq = 1; seq <= kCopiedEdits; ++seq) append_one(*store, seq);
  return store;
}

/// Copies files of a world, named by what follows "world.".
void copy_files(const std::string& from, const std::string& to,
                const std::vector<std::string>& endings) {
  fs::create_directories(to);
  for (const std::string& ending : endings)
    fs::copy_file(from + "/world." + ending, to + "/world." + ending);
}

/// Returns the error of a server's open, or "opens".
std::string opening_error(const std::string& folder) {
  const auto store = open_world(folder, StoreAccess::read_write);
  return store ? "opens" : store.error().message();
}

std::string part_error(const std::string& folder, const std::string& missing, Sequence last) {
  return folder +
         "/world.sqlite: is only a part of a world: a server was writing it when it was copied, or "
         "did not stop cleanly, and " +
         missing + " missing. The log ends here at seq=" + std::to_string(last) +
         ", and it is not known how many later edits are lost. Put world.sqlite, world.sqlite-wal "
         "and world.durable of one moment together into the folder. Put the world back from a "
         "backup, or run `runstone-server repair`, or start the server once with --accept-losses";
}

constexpr const char* kBothMissing = "world.sqlite-wal and world.durable are";

}  // namespace

TEST_CASE("the database alone, copied from a running server, is refused with words",
          "[store][loss][sqlite]") {
  const TempFolder folder;
  const std::string live = folder / "live", copy = folder / "copy";
  const auto store = running_world(live);
  copy_files(live, copy, {"sqlite"});
  CHECK(opening_error(copy) == part_error(copy, kBothMissing, 0));
  CHECK(opening_error(copy) ==
        part_error(copy, kBothMissing, 0));  // the refused start changed nothing
  const auto reader = open_world(copy, StoreAccess::read_only);
  REQUIRE(reader.has_value());
  REQUIRE((*reader)->loss().has_value());
  CHECK((*reader)->loss()->message() == part_error(copy, kBothMissing, 0));
}

TEST_CASE("a killed world without WAL and mark, or without its mark, is refused with words",
          "[store][loss][sqlite]") {
  const TempFolder folder;
  const std::string live = folder / "live", neither = folder / "neither",
                    unmarked = folder / "unmarked", whole = folder / "whole";
  const auto store = running_world(live);
  copy_files(live, whole, {"sqlite", "sqlite-wal", "durable"});
  copy_files(live, unmarked, {"sqlite", "sqlite-wal"});
  copy_files(live, neither, {"sqlite"});
  CHECK(opening_error(whole) == "opens");
  CHECK(opening_error(unmarked) == part_error(unmarked, "world.durable is", kCopiedEdits));
  CHECK(opening_error(neither) == part_error(neither, kBothMissing, 0));
}

TEST_CASE("an accepted part of a world goes on as a new branch", "[store][loss][sqlite]") {
  const TempFolder folder;
  const std::string live = folder / "live", copy = folder / "copy";
  const auto original = running_world(live);
  copy_files(live, copy, {"sqlite"});
  {
    auto store = *open_world(copy, StoreAccess::repair);
    const auto lost = store->accept_losses();
    REQUIRE(lost.has_value());
    REQUIRE(lost->size() == 1);
    CHECK(lost->front() == part_error(copy, kBothMissing, 0));
    CHECK_FALSE(is_same_branch(*store->raise_epoch(), original->epoch()));
    append_one(*store, 1);
  }
  CHECK(opening_error(copy) == "opens");
  fs::remove(copy + "/world.durable");
  CHECK(opening_error(copy) == "opens");  // it was closed cleanly
}

TEST_CASE("a clean stop leaves one file that is the world, also while a reader has it open",
          "[store][loss][sqlite]") {
  const TempFolder folder;
  const std::string live = folder / "live", copy = folder / "copy";
  std::unique_ptr<Store> reader;
  {
    const auto store = running_world(live);
    reader = *open_world(live, StoreAccess::read_only);
    REQUIRE(*reader->last_sequence() == kCopiedEdits);
    CHECK(store->complete_file().has_value());
  }
  CHECK(fs::exists(live + "/world.sqlite-wal"));
  copy_files(live, copy, {"sqlite"});
  const auto store = copied_world(copy);
  CHECK(*store->last_sequence() == kCopiedEdits);
  CHECK(store->check().has_value());
}

TEST_CASE("a reader in the middle of its reads keeps the WAL, and the stop says so",
          "[store][loss][sqlite]") {
  const TempFolder folder;
  const std::string live = folder / "live", alone = folder / "alone", both = folder / "both";
  auto store = running_world(live);
  const auto reader = *open_world(live, StoreAccess::read_only);
  REQUIRE(reader->begin_reads().has_value());
  REQUIRE(*reader->last_sequence() == kCopiedEdits);
  append_one(*store, kCopiedEdits + 1);
  const auto complete = store->complete_file();
  REQUIRE_FALSE(complete.has_value());
  CHECK(complete.error().message() ==
        live +
            "/world.sqlite: is not complete without world.sqlite-wal, because a program reads the "
            "world, such as runstone-web or a backup. Copy the whole folder, or end the program "
            "and start and stop the server once");
  store.reset();
  copy_files(live, alone, {"sqlite"});
  copy_files(live, both, {"sqlite", "sqlite-wal"});
  CHECK(opening_error(alone).find("is only a part of a world") != std::string::npos);
  CHECK(opening_error(both) == "opens");
  CHECK(*copied_world(both)->last_sequence() == kCopiedEdits + 1);
  REQUIRE(reader->end_reads().has_value());
}

TEST_CASE("a world that was opened after a kill and closed without an edit is one file",
          "[store][loss][sqlite]") {
  const TempFolder folder;
  const std::string live = folder / "live", killed = folder / "killed", copy = folder / "copy";
  const auto store = running_world(live);
  copy_files(live, killed, {"sqlite", "sqlite-wal", "durable"});
  CHECK(opening_error(killed) == "opens");
  copy_files(killed, copy, {"sqlite"});
  CHECK(*copied_world(copy)->last_sequence() == kCopiedEdits);
}

TEST_CASE("a copy row by row is complete without a mark", "[store][loss][sqlite]") {
  const TempFolder folder;
  const std::string live = folder / "live", copy = folder / "copy";
  const auto store = running_world(live);
  REQUIRE(copy_stored_world(live, copy, {}).has_value());
  CHECK(opening_error(copy) == "opens");
}

TEST_CASE("a power failure at any operation around the first edit of a run loses nothing",
          "[store][loss][sqlite]") {
  SplitMix64 chance(4);
  int cut = 0;
  for (std::uint64_t operation = 1; operation < 60; ++operation) {
    CAPTURE(operation);
    const TempFolder folder;
    PowerLossVfs vfs;
    const SqliteOptions options{vfs.name(), true};
    {
      const auto store = *create_sqlite_world(folder.path(), sample_meta(), options);
      REQUIRE(store->raise_epoch().has_value());
      append_one(*store, 1);
    }
    Sequence durable = 1;
    vfs.cut_after(operation);
    {
      auto store = open_sqlite_world(folder.path(), StoreAccess::read_write, options);
      if (store && (*store)->raise_epoch()) {
        SplitMix64 rng(2);
        for (Sequence seq = 2; seq < 5; ++seq) {
          if ((*store)->append({}, sample_records(rng, (*store)->epoch(), seq, 1))) durable = seq;
        }
      }
    }
    cut += vfs.is_cut() ? 1 : 0;
    vfs.power_loss(chance);
    const auto store = open_sqlite_world(folder.path(), StoreAccess::read_write, options);
    INFO((store ? "" : store.error().message()));
    REQUIRE(store.has_value());
    CHECK(*(*store)->last_sequence() >= durable);
    CHECK((*store)->check().has_value());
  }
  CHECK(cut > 10);
}

TEST_CASE("a commit of edits syncs once", "[store][loss][sqlite]") {
  const TempFolder folder;
  PowerLossVfs vfs;
  const auto store = *create_sqlite_world(folder.path(), sample_meta(), {vfs.name(), true});
  REQUIRE(store->raise_epoch().has_value());
  append_one(*store, 1);
  for (Sequence seq = 2; seq < 10; ++seq) {
    const std::uint64_t before = vfs.syncs();
    append_one(*store, seq);
    CHECK(vfs.syncs() == before + 1);
  }
}

}  // namespace runstone::test
