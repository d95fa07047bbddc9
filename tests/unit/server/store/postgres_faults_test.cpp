// Each statement that a store sends to PostgreSQL fails once, or from then on: no durable edit is
// lost, nothing is written twice, and every error says why. The cases need a server, as those of
// postgres_database_test.cpp.
#include <catch2/catch.hpp>
#include <chrono>
#include <functional>

#include "common/core/digest.hpp"
#include "server/store/store.hpp"
#include "tests/support/sql/temp_place.hpp"
#include "tests/support/store/sample_world.hpp"
#include "tests/unit/server/store/postgres_faults.hpp"

namespace runstone::test {
namespace {

constexpr std::uint64_t kStatementsMax = 500;  // of a call; it has fewer than 100
constexpr ChunkKey kChunk{0, {1, 0, -3}};
const NameClaim kClaim{"ana", "Ana", sample_player(2).key};

/// A lease that is not renewed: a renewal is a statement, too.
LeaseTerms long_lease() {
  LeaseTerms terms{"faulty", std::chrono::minutes(10)};
  terms.waits = false;
  return terms;
}

/// A world in the database, and the operator's own connection to it.
class WatchedWorld {
 public:
  const std::string& place() const { return place_; }
  /// Lets the next program take the world without waiting.
  void end_lease() {
    static_cast<void>(operator_.run("UPDATE lease SET expires_us = 0").has_value());
  }
  void remove() {
    REQUIRE(operator_
                .run("DO $$ DECLARE name text := current_schema(); BEGIN "
                     "EXECUTE format('DROP SCHEMA %I CASCADE', name); "
                     "EXECUTE format('CREATE SCHEMA %I', name); END $$")
                .has_value());
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
  bool has_players = false, has_claim = false;

  LogEnd end() const { return {log.back().version, log.back().time_us}; }
};

void require_sound(Store& store) {
  const auto sound = store.check();
  INFO((sound ? "" : sound.error().message()));
  REQUIRE(sound.has_value());
}

/// Verifies a world that was opened after a fault. What the log has of `written.next` counts as
/// written from then on.
void verify(Store& store, Written& written) {
  require_sound(store);
  const auto range = *store.log_range();
  const Sequence last = range.last.version.seq;
  if (last == written.log.size() + written.next.size())
    written.log.insert(written.log.end(), written.next.begin(), written.next.end());
  written.next.clear();
  REQUIRE(last == written.log.size());
  REQUIRE(range.first > written.head);
  written.head = range.first - 1;
  std::vector<EditRecord> read;
  REQUIRE(store.read_log(range.first, last, [&](const EditRecord& record) {
    read.push_back(record);
    return true;
  }));
  const auto kept = written.log.begin() + static_cast<std::ptrdiff_t>(written.head);
  CHECK(read == std::vector(kept, written.log.end()));
  CHECK(store.epoch() >= written.epoch);
  CHECK(*store.checkpoint() >= written.checkpoint);
  const auto players = *store.players();
  CHECK(players.size() <= 2);
  if (written.has_players) CHECK(players.size() == 2);
  const auto claims = *store.name_claims();
  CHECK(claims.size() <= 1);
  if (written.has_claim) CHECK(claims == std::vector{kClaim});
}

/// A server's life with one world, in which each kind of call meets a fault at each of its statements.
class FaultyLife {
 public:
  explicit FaultyLife(const ProxyFault& fault)
      : proxy_(world_.place()), name_(place_name(proxy_.through(world_.place()))), fault_(fault) {
    REQUIRE(create_world(world_.place(), sample_meta()).has_value());
  }

  /// Returns the number of faults.
  std::uint64_t run() {
    const auto nothing = [] {};
    const auto edit = [&] { require(append(true)); };
    const auto edit_and_keyframe = [&] {
      // An interrupted compaction leaves its records to the next one. Each would have more
      // statements than the one before, and the test would never end.
      if (written_.head < written_.end().version.seq) require(compact());
      edit();
      require(save_keyframe());
    };
    std::uint64_t faults = meet_faults("open", [&] { close(); }, [&] { return open(); });
    faults += meet_faults("epoch", nothing, [&] { return raise_epoch(); });
    faults += meet_faults("append", nothing, [&] { return append(false); });
    faults += meet_faults("names", nothing, [&] { return change_names(); });
    faults += meet_faults("snapshots", nothing, [&] { return save_snapshots(); });
    faults += meet_faults("keyframe", edit, [&] { return save_keyframe(); });
    faults += meet_faults("compaction", edit_and_keyframe, [&] { return compact(); });
    faults += meet_faults("append", nothing, [&] { return append(false); });
    faults += meet_faults("close", nothing, [&]() -> StoreResult<void> {
      store_.reset();
      return {};
    });
    return faults;
  }

 private:
  using Call = std::function<StoreResult<void>()>;

  /// Makes a fault strike each statement of a call in turn. `prepare` comes before each call and meets no
  /// fault. Returns the number of faults.
  std::uint64_t meet_faults(const std::string& name, const std::function<void()>& prepare,
                            const Call& call) {
    for (std::uint64_t statement = 1; statement < kStatementsMax; ++statement) {
      CAPTURE(name, statement, text_of(fault_));
      prepare();
      proxy_.fail(statement, fault_);
      meet_fault(call);
      const bool has_failed = proxy_.has_failed();
      if (has_failed && fault_.kind != ProxyFault::Kind::error && store_) {
        check_refuses();
        store_.reset();
      }
      proxy_.heal();
      verify_anew();
      if (!has_failed) return statement - 1;
    }
    FAIL("the statements never end: " << name << ", " << text_of(fault_));
    return 0;
  }

  /// Calls `call`, and once more if nothing was written. Ends the store if the server would end although
  /// its connection is alive.
  void meet_fault(const Call& call) {
    const auto done = call();
    if (done) return;
    check_error(done.error(), fault_, name_);
    if (can_be_repeated(done.error())) {
      proxy_.heal();
      if (!store_) close();
      return require(call());
    }
    // Only a request whose answer was lost can have been carried out.
    if (!fault_.is_in_answer()) written_.next.clear();
    if (fault_.kind == ProxyFault::Kind::error) store_.reset();
  }

  /// Checks that a store without a connection writes nothing more, and says why.
  void check_refuses() {
    const auto refused = store_->append({}, {});
    REQUIRE_FALSE(refused.has_value());
    INFO(refused.error().message());
    CHECK(refused.error().kind == StoreError::Kind::io);
    CHECK(has_any(refused.error().what,
                  {"no connection to the server", "an earlier commit failed",
                   "server closed the connection unexpectedly",
                   "could not receive data from server", "could not send data to server"}));
  }

  /// Opens the world without a fault and verifies it.
  void verify_anew() {
    if (store_) {
      auto reader = open_world(world_.place(), StoreAccess::read_only);
      INFO((reader ? "" : reader.error().message()));
      REQUIRE(reader.has_value());
      return verify(**reader, written_);
    }
    close();
    require(open());
    verify(*store_, written_);
    require(raise_epoch());
  }

  static void require(const StoreResult<void>& done) {
    INFO((done ? "" : done.error().message()));
    REQUIRE(done.has_value());
  }

  void close() {
    store_.reset();
    proxy_.wait_for_ends();
    world_.end_lease();
  }
  StoreResult<void> open() {
    auto store =
        open_world(proxy_.through(world_.place()), StoreAccess::read_write, "", long_lease());
    if (!store) return failure(store.error());
    store_ = *std::move(store);
    return {};
  }
  StoreResult<void> raise_epoch() {
    const auto raised = store_->raise_epoch();
    if (!raised) return failure(raised.error());
    written_.epoch = *raised;
    return {};
  }
  StoreResult<void> append(bool with_rights) {
    auto records = sample_records(rng_, written_.epoch, written_.log.size() + 1, 2);
    if (with_rights) {
      records[0].cause = Cause::rights;
      records[0].subject = 0;
      records[0].edit = sample_rights_edit(rng_);
    }
    const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
    written_.next = records;
    auto done = store_->append(players, records);
    if (!done) return done;
    written_.log.insert(written_.log.end(), records.begin(), records.end());
    written_.next.clear();
    written_.has_players = true;
    return {};
  }
  /// The claim is there at the end, whether it was there before or not.
  StoreResult<void> change_names() {
    const std::vector<NameChange> names = {{kClaim, true}, {kClaim, false}};
    auto done = store_->change_names(names);
    if (done) written_.has_claim = true;
    return done;
  }
  StoreResult<void> save_snapshots() {
    const Sequence seq = written_.end().version.seq;
    auto done = store_->save_snapshots(chunks(), seq);
    if (done) written_.checkpoint = seq;
    return done;
  }
  StoreResult<void> save_keyframe() {
    const auto saved = chunks();
    const Digest digest =
        world_digest_term(kChunk, saved[0].second->digest) - world_digest_term(kChunk, {});
    return store_->save_keyframe(saved, Keyframe{written_.end(), 1, digest});
  }
  StoreResult<void> compact() {
    const Sequence seq = written_.end().version.seq;
    auto done = store_->compact(seq);
    if (done) written_.head = seq;
    return done;
  }
  /// Returns a chunk as the last edit left it.
  std::vector<std::pair<ChunkKey, ChunkPtr>> chunks() {
    return {{kChunk, sample_chunk(rng_, written_.end().version)}};
  }

  WatchedWorld world_;
  FaultProxy proxy_;
  const std::string name_;  // of the database, through the proxy
  const ProxyFault fault_;
  SplitMix64 rng_{17};
  Written written_;
  std::unique_ptr<Store> store_;
};

}  // namespace

TEST_CASE("no fault at any statement loses a durable edit, writes one twice or has wrong words",
          "[.postgres-server]") {
  for (const ProxyFault& fault : all_faults()) CHECK(FaultyLife(fault).run() > 100);
}

TEST_CASE("no fault at any statement leaves a part of a new world or has wrong words",
          "[.postgres-server]") {
  for (const ProxyFault& fault : all_faults()) {
    WatchedWorld world;
    FaultProxy proxy(world.place());
    const std::string place = proxy.through(world.place());
    // When the world is there, creating opens it, and the other case has the statements of that.
    for (std::uint64_t statement = 1;; ++statement) {
      REQUIRE(statement < kStatementsMax);
      CAPTURE(statement, text_of(fault));
      world.end_lease();
      proxy.fail(statement, fault);
      bool is_made = false;
      {
        const auto made = create_world(place, sample_meta(), "", long_lease());
        is_made = made.has_value();
        if (!made) check_error(made.error(), fault, place_name(place));
      }
      proxy.heal();
      proxy.wait_for_ends();
      const auto store = open_world(world.place(), StoreAccess::read_only);
      if (store) require_sound(**store);
      CAPTURE(store ? "" : store.error().message());
      CHECK((store.has_value() || store.error().kind == StoreError::Kind::not_a_world));
      CHECK((store.has_value() || !is_made));
      if (store && !is_made) {
        CHECK(statement > 20);
        break;
      }
      if (is_made) world.remove();
    }
  }
}

}  // namespace runstone::test
