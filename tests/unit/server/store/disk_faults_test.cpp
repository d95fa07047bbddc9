// Every call of the system under a store fails once, or from then on: no durable edit is lost, nothing
// is taken for damaged, and every error says why.
#include <catch2/catch.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "server/store/sqlite_backend.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/sql/disk_fault.hpp"
#include "tests/support/store/sample_world.hpp"
#include "tests/unit/server/store/faulty_writer.hpp"

namespace runstone::test {
namespace {

constexpr Sequence kFirstEdits = 10;
constexpr std::uint64_t kCallsMax = 2'000;
using Lasts = FaultVfs::Lasts;

void make_first_edits(const std::string& folder) {
  SplitMix64 rng(3);
  const auto store = *create_world(folder, sample_meta());
  REQUIRE(store->raise_epoch().has_value());
  const PlayerRow player = sample_player(1);
  REQUIRE(store->append({&player, 1}, sample_records(rng, 1, 1, kFirstEdits)).has_value());
}

/// Opens a world, edits it and closes it, as a server does. Returns the last edit that was reported as
/// durable.
Sequence edit_on_faulty_disk(const std::string& folder, FaultyWriter& writer) {
  Sequence durable = kFirstEdits;
  const auto opened = open_sqlite_world(folder, StoreAccess::read_write, {FaultVfs::name(), true});
  if (!opened) {
    writer.check(opened.error());
    return durable;
  }
  Store& store = **opened;
  SplitMix64 rng(17);
  if (!writer.does([&] { return store.raise_epoch(); })) return durable;
  for (int batch = 0; batch < 3; ++batch) {
    const auto records = sample_records(rng, store.epoch(), durable + 1, 2);
    const PlayerRow player = sample_player(static_cast<AuthorId>(batch + 2));
    if (!writer.does([&] { return store.append({&player, 1}, records); })) return durable;
    durable += 2;
  }
  const NameChange name{{"ana", "Ana", sample_player(2).key}, false};
  if (!writer.does([&] { return store.change_names({&name, 1}); })) return durable;
  if (!writer.does([&] { return store.save_snapshots({}, durable); })) return durable;
  if (const auto done = store.complete_file(); !done) writer.check(done.error());
  return durable;
}

/// Edits copies of a world while every `stride`-th call fails. Returns the number of copies.
std::uint64_t edit_on_faulty_disks(std::uint64_t stride) {
  const TempFolder folder;
  const std::string world = folder / "world";
  make_first_edits(world);
  return meet_disk_faults(stride, [&](FaultVfs& vfs, const DiskFault& fault) {
    const TempFolder run;
    const std::string copy = run / "world";
    std::filesystem::copy(world, copy);
    FaultyWriter writer(vfs, fault);
    const Sequence durable = edit_on_faulty_disk(copy, writer);
    vfs.heal();
    CHECK(*sound_world(copy)->last_sequence() >= durable);
  });
}

}  // namespace

TEST_CASE("no error of the disk loses a durable edit or has wrong words",
          "[store][sqlite][faults]") {
  CHECK(edit_on_faulty_disks(10) > 20);  // each call meets one of the ten errors
}

TEST_CASE("no error of the disk at any call of SQLite loses a durable edit or has wrong words",
          "[.long][store][sqlite][faults]") {
  CHECK(edit_on_faulty_disks(1) > 10 * 20);
}

TEST_CASE("a full quota at COMMIT is a full disk", "[store][sqlite][faults]") {
  for (const int system_error : {EDQUOT, EFBIG, EROFS}) {
    const TempFolder folder;
    const std::string world = folder / "world";
    make_first_edits(world);
    FaultVfs vfs;
    auto store = *open_sqlite_world(world, StoreAccess::read_write, {vfs.name(), true});
    REQUIRE(*store->raise_epoch() == 2);
    SplitMix64 rng(5);
    REQUIRE(store->append({}, sample_records(rng, 2, kFirstEdits + 1, 1)).has_value());
    const auto records = sample_records(rng, 2, kFirstEdits + 2, 3);
    // Everything that a small transaction writes, it writes when it is committed.
    vfs.fail(1, system_error, Lasts::for_ever);
    for (int attempt = 0; attempt < 3; ++attempt) {
      const auto refused = store->append({}, records);
      REQUIRE_FALSE(refused.has_value());
      CHECK(refused.error().kind == StoreError::Kind::full);
      CHECK(refused.error().what.find(std::strerror(system_error)) != std::string::npos);
    }
    vfs.heal();
    CHECK(store->append({}, records).has_value());
    CHECK(store->check().has_value());
    store.reset();
  }
}

TEST_CASE("a reader that meets an error of the disk never calls the world damaged",
          "[store][sqlite][faults]") {
  const TempFolder folder;
  const std::string world = folder / "world";
  make_first_edits(world);
  FaultVfs vfs;
  std::uint64_t failures = 0;
  for (std::uint64_t call = 1; call < kCallsMax; ++call) {
    vfs.fail(call, EIO, Lasts::once);
    StoreResult<void> read;
    {
      const auto reader = open_sqlite_world(world, StoreAccess::read_only, {vfs.name(), true});
      if (!reader) read = failure(reader.error());
      if (read) read = (*reader)->read_log(1, kFirstEdits, [](const EditRecord&) { return true; });
      if (read) {
        if (const auto players = (*reader)->players(); !players) read = failure(players.error());
      }
      if (read) {
        const auto chunk = (*reader)->load_snapshot({});
        if (!chunk) read = failure(chunk.error());
      }
      if (read) read = (*reader)->check();
    }
    const bool has_failed = vfs.has_failed();
    vfs.heal();
    if (!has_failed) break;
    CAPTURE(call);
    if (read) continue;  // SQLite did without the call
    ++failures;
    INFO(read.error().message());
    CHECK(read.error().kind == StoreError::Kind::io);
    CHECK(read.error().what.find(std::strerror(EIO)) != std::string::npos);
  }
  CHECK(failures > 10);
}

}  // namespace runstone::test
