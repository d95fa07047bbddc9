// Every call of the system under a store fails once, or from then on: no durable edit is lost, nothing
// is taken for damaged, and every error says why.
#include <catch2/catch.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "server/store/sqlite_backend.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/sql/fault_vfs.hpp"
#include "tests/support/store/sample_world.hpp"

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

/// One error at one call, and what a server does then.
class FaultRun {
 public:
  FaultRun(FaultVfs& vfs, const std::string& folder, int system_error)
      : vfs_(vfs), folder_(folder), system_error_(system_error) {}

  void run() {
    auto store = open_sqlite_world(folder_, StoreAccess::read_write, {vfs_.name(), true});
    if (!store) return check(store.error());
    serve(**store);
  }
  /// The last edit that was reported as durable.
  Sequence durable() const { return durable_; }

 private:
  void serve(Store& store) {
    Epoch epoch = 0;
    const auto raise = [&]() -> StoreResult<void> {
      const auto raised = store.raise_epoch();
      if (!raised) return failure(raised.error());
      epoch = *raised;
      return {};
    };
    if (!write(raise)) return;
    for (int batch = 0; batch < 3; ++batch) {
      const auto records = sample_records(rng_, epoch, durable_ + 1, 2);
      const PlayerRow player = sample_player(static_cast<AuthorId>(batch + 2));
      if (!write([&] { return store.append({&player, 1}, records); })) return;
      durable_ += 2;
    }
    const NameChange name{{"ana", "Ana", sample_player(2).key}, false};
    if (!write([&] { return store.change_names({&name, 1}); })) return;
    if (!write([&] { return store.save_snapshots({}, durable_); })) return;
    if (const auto done = store.complete_file(); !done) check(done.error());
  }
  /// Calls `call`, and once more if there was no room. Returns false if the server would end.
  template <class Call>
  bool write(const Call& call) {
    const StoreResult<void> done = call();
    if (done) return true;
    check(done.error());
    if (done.error().kind != StoreError::Kind::full) return false;
    vfs_.heal();
    const StoreResult<void> again = call();
    INFO((again ? "" : again.error().message()));
    REQUIRE(again.has_value());
    return true;
  }
  void check(const StoreError& error) const {
    INFO(error.message());
    CHECK(error.may_pass());
    CHECK(error.kind != StoreError::Kind::locked);
    CHECK(says_why(error.what));
    if (system_error_ == EIO) CHECK(error.kind == StoreError::Kind::io);
  }

  bool says_why(const std::string& what) const {
    const auto has = [&](const char* part) { return what.find(part) != std::string::npos; };
    if (has(std::strerror(system_error_))) return true;
    // SQLite keeps no error of the system in these cases.
    if (system_error_ == ENOSPC && has("database or disk is full")) return true;
    if (has("cannot be opened for writing: it or its file system is read-only, or the disk failed"))
      return system_error_ == EROFS || system_error_ == EIO;
    return has("cannot be made: the disk is full or read-only");
  }

  FaultVfs& vfs_;
  const std::string folder_;
  const int system_error_;
  SplitMix64 rng_{17};
  Sequence durable_ = kFirstEdits;
};

/// Returns how many calls can have this error until the world is closed.
std::uint64_t fail_at_every_call(const std::string& world, int system_error, Lasts lasts) {
  FaultVfs vfs;
  for (std::uint64_t call = 1; call < kCallsMax; ++call) {
    const TempFolder folder;
    const std::string copy = folder / "world";
    std::filesystem::copy(world, copy);
    vfs.fail(call, system_error, lasts);
    INFO("call " << call << ", error " << std::strerror(system_error)
                 << (lasts == Lasts::once ? ", once" : ", for ever"));
    FaultRun run(vfs, copy, system_error);
    run.run();
    const bool has_failed = vfs.has_failed();
    vfs.heal();
    const auto store = open_world(copy, StoreAccess::read_write);
    INFO((store ? "" : store.error().message()));
    REQUIRE(store.has_value());
    REQUIRE(*(*store)->last_sequence() >= run.durable());
    const auto sound = (*store)->check();
    INFO((sound ? "" : sound.error().message()));
    REQUIRE(sound.has_value());
    if (!has_failed) return call - 1;
  }
  FAIL("the calls never end");
  return 0;
}

}  // namespace

TEST_CASE("no error of the disk at any call of SQLite loses a durable edit or has wrong words",
          "[store][sqlite][faults]") {
  const TempFolder folder;
  const std::string world = folder / "world";
  make_first_edits(world);
  for (const int system_error : {ENOSPC, EDQUOT, EFBIG, EROFS, EIO}) {
    for (const Lasts lasts : {Lasts::once, Lasts::for_ever})
      CHECK(fail_at_every_call(world, system_error, lasts) > 20);
  }
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
