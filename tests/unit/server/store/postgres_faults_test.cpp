// Each statement that a store sends to PostgreSQL fails once, or from then on: no durable edit is
// lost, nothing is written twice, and every error says why. The cases need a server, as those of
// postgres_database_test.cpp.
#include <catch2/catch.hpp>
#include <chrono>
#include <functional>
#include <set>

#include "common/core/digest.hpp"
#include "server/store/store.hpp"
#include "tests/support/sql/temp_place.hpp"
#include "tests/support/store/sample_world.hpp"
#include "tests/unit/server/store/postgres_faults.hpp"

namespace runstone::test {
namespace {

constexpr std::uint64_t kStatementsMax = 2'000;
constexpr ChunkKey kChunk{0, {1, 0, -3}};
const NameClaim kClaim{"ana", "Ana", sample_player(2).key};

/// A lease that is not renewed: a renewal is a statement, too.
LeaseTerms long_lease() {
  LeaseTerms terms{"faulty", std::chrono::minutes(10)};
  terms.waits = false;
  return terms;
}

/// A world that must be sound, and the operator's own connection to it.
class WatchedWorld {
 public:
  const std::string& place() const { return place_; }
  /// Lets the next program take the world without waiting.
  void end_lease() {
    static_cast<void>(operator_.run("UPDATE lease SET expires_us = 0").has_value());
  }
  /// Opens the world for reading, without a fault. Returns null if there is none.
  std::unique_ptr<Store> sound_world() const {
    auto store = open_world(place_, StoreAccess::read_only);
    if (!store && store.error().kind == StoreError::Kind::not_a_world) return nullptr;
    INFO((store ? "" : store.error().message()));
    REQUIRE(store.has_value());
    const auto sound = (*store)->check();
    INFO((sound ? "" : sound.error().message()));
    REQUIRE(sound.has_value());
    return *std::move(store);
  }

 private:
  TempPlace temp_;
  const std::string place_ = temp_.path();
  sql::Database operator_ = *sql::open_postgres(place_, sql::PostgresMode::write);
};

/// What a world must have: what was reported as written. `next` may be there or not.
struct Written {
  std::vector<EditRecord> log;        // from the first one, compacted or not
  std::vector<EditRecord> next;       // of the append whose answer did not arrive
  Sequence head = 0, checkpoint = 0;  // at least
  Epoch epoch = 0;                    // at least
  std::set<AuthorId> players;
  bool has_claim = false;
};

/// The same world through many lives, each of which meets one fault.
class FaultyLives {
 public:
  explicit FaultyLives(const ProxyFault& fault) : proxy_(world_.place()), fault_(fault) {
    REQUIRE(create_world(world_.place(), sample_meta()).has_value());
  }

  /// Runs a life with the fault at this statement. Returns false if the life has not so many.
  bool live(std::uint64_t statement) {
    CAPTURE(statement, text_of(fault_));
    world_.end_lease();
    proxy_.fail(statement, fault_);
    serve();
    const bool has_failed = proxy_.has_failed();
    proxy_.heal();
    proxy_.wait_for_ends();
    verify();
    return has_failed;
  }

 private:
  void serve() {
    const auto store = open();
    if (!store) return;
    Epoch epoch = 0;
    const auto raise = [&]() -> StoreResult<void> {
      const auto raised = store->raise_epoch();
      if (!raised) return failure(raised.error());
      epoch = *raised;
      return {};
    };
    if (!write(*store, raise)) return;
    written_.epoch = epoch;
    if (!append(*store, epoch, true)) return;
    // The claim is in the world at the end of the transaction, whether it was there before or not.
    const std::vector<NameChange> names = {{kClaim, true}, {kClaim, false}};
    if (!write(*store, [&] { return store->change_names(names); })) return;
    written_.has_claim = true;
    if (!append(*store, epoch, false)) return;

    const EditRecord& last = written_.log.back();
    const std::vector<std::pair<ChunkKey, ChunkPtr>> chunks = {
        {kChunk, sample_chunk(rng_, last.version)}};
    const Sequence seq = last.version.seq;
    if (!write(*store, [&] { return store->save_snapshots(chunks, seq); })) return;
    written_.checkpoint = seq;
    if (!write(*store, [&] { return store->save_tiles({}); })) return;
    const Keyframe keyframe{
        {last.version, last.time_us},
        1,
        world_digest_term(kChunk, chunks[0].second->digest) - world_digest_term(kChunk, {})};
    if (!write(*store, [&] { return store->save_keyframe(chunks, keyframe); })) return;
    if (!write(*store, [&] { return store->compact(seq); })) return;
    written_.head = seq;
    append(*store, epoch, false);
  }

  std::unique_ptr<Store> open() {
    const std::string place = proxy_.through(world_.place());
    name_ = place_name(place);
    const auto tried = [&] { return open_world(place, StoreAccess::read_write, "", long_lease()); };
    auto store = tried();
    if (!store) check_error(store.error(), fault_, name_);
    if (!store && can_be_repeated(store.error())) {
      proxy_.heal();
      proxy_.wait_for_ends();
      world_.end_lease();
      store = tried();
      INFO((store ? "" : store.error().message()));
      REQUIRE(store.has_value());
    }
    return store ? *std::move(store) : nullptr;
  }

  bool append(Store& store, Epoch epoch, bool with_rights) {
    auto records = sample_records(rng_, epoch, written_.log.size() + 1, 2);
    if (with_rights) {
      records[0].cause = Cause::rights;
      records[0].subject = 0;
      records[0].edit = sample_rights_edit(rng_);
    }
    const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
    written_.next = records;
    const bool done = write(store, [&] { return store.append(players, records); });
    if (!done) return false;
    written_.log.insert(written_.log.end(), records.begin(), records.end());
    written_.next.clear();
    for (const PlayerRow& player : players) written_.players.insert(player.author);
    return true;
  }

  /// Calls `call`, and once more if nothing was written. Returns false if the server would end.
  template <class Call>
  bool write(Store& store, const Call& call) {
    const StoreResult<void> done = call();
    if (done) return true;
    check_error(done.error(), fault_, name_);
    if (!can_be_repeated(done.error())) {
      // Only a request whose answer was lost can have been carried out.
      if (!fault_.is_in_answer()) written_.next.clear();
      if (!store.is_usable()) check_refuses(store);
      return false;
    }
    proxy_.heal();
    const StoreResult<void> again = call();
    INFO((again ? "" : again.error().message()));
    REQUIRE(again.has_value());
    return true;
  }

  void check_refuses(Store& store) const {
    const auto refused = store.append({}, {});
    REQUIRE_FALSE(refused.has_value());
    INFO(refused.error().message());
    CHECK(refused.error().kind == StoreError::Kind::io);
    CHECK(
        has_any(refused.error().what, {"no connection to the server", "an earlier commit failed"}));
  }

  void verify() {
    const auto store = world_.sound_world();
    REQUIRE(store != nullptr);
    const auto range = *store->log_range();
    const Sequence last = range.last.version.seq;
    if (last == written_.log.size() + written_.next.size())
      written_.log.insert(written_.log.end(), written_.next.begin(), written_.next.end());
    written_.next.clear();
    REQUIRE(last == written_.log.size());
    REQUIRE(range.first > written_.head);
    written_.head = range.first - 1;
    std::vector<EditRecord> read;
    REQUIRE(store->read_log(range.first, last, [&](const EditRecord& record) {
      read.push_back(record);
      return true;
    }));
    const auto kept = written_.log.begin() + static_cast<std::ptrdiff_t>(written_.head);
    CHECK(read == std::vector(kept, written_.log.end()));
    CHECK(store->epoch() >= written_.epoch);
    CHECK(*store->checkpoint() >= written_.checkpoint);
    std::set<AuthorId> players;
    for (const PlayerRow& player : *store->players()) CHECK(players.insert(player.author).second);
    CHECK(std::includes(players.begin(), players.end(), written_.players.begin(),
                        written_.players.end()));
    const auto claims = *store->name_claims();
    CHECK(claims.size() <= 1);
    if (written_.has_claim) CHECK(claims == std::vector{kClaim});
  }

  WatchedWorld world_;
  FaultProxy proxy_;
  const ProxyFault fault_;
  std::string name_;  // of the database, through the proxy
  SplitMix64 rng_{17};
  Written written_;
};

}  // namespace

TEST_CASE("no fault at any statement loses a durable edit, writes one twice or has wrong words",
          "[.postgres-server]") {
  for (const ProxyFault& fault : all_faults()) {
    FaultyLives lives(fault);
    std::uint64_t statement = 1;
    while (statement < kStatementsMax && lives.live(statement)) ++statement;
    CHECK(statement > 100);
    CHECK(statement < kStatementsMax);
  }
}

TEST_CASE("no fault at any statement leaves a part of a new world or has wrong words",
          "[.postgres-server]") {
  for (const ProxyFault& fault : all_faults()) {
    WatchedWorld world;
    FaultProxy proxy(world.place());
    const std::string place = proxy.through(world.place());
    // When the world is there, creating opens it; the other case has the statements of that.
    bool is_there = false;
    std::uint64_t statement = 0;
    while (!is_there && ++statement < kStatementsMax) {
      CAPTURE(statement, text_of(fault));
      world.end_lease();
      proxy.fail(statement, fault);
      {
        const auto made = create_world(place, sample_meta(), "", long_lease());
        if (!made) check_error(made.error(), fault, place_name(place));
        is_there = made.has_value();
      }
      proxy.heal();
      proxy.wait_for_ends();
      const auto store = world.sound_world();
      if (is_there) REQUIRE(store != nullptr);
      is_there = store != nullptr;
    }
    CHECK(statement > 30);
    CHECK(is_there);
  }
}

}  // namespace runstone::test
