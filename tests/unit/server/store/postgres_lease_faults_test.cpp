// A cut connection while a lease is renewed never makes two owners. The cases need a server, as those of
// postgres_database_test.cpp.
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>

#include "server/store/store.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/sql/temp_place.hpp"
#include "tests/support/store/sample_world.hpp"
#include "tests/unit/server/store/comes_true.hpp"
#include "tests/unit/server/store/postgres_faults.hpp"

namespace runstone::test {
namespace {

using std::chrono::milliseconds;

constexpr std::uint64_t kRenewalStatements = 2;

/// An owner behind a proxy that has renewed its lease.
struct OwnerBehindProxy {
  explicit OwnerBehindProxy(milliseconds length) {
    store = *create_world(proxy.through(place.path()), sample_meta(), "", {"first", length});
    REQUIRE(*store->raise_epoch() == 1);
    REQUIRE(renews());
  }
  bool renews() const {
    const auto end = [&] { return raw_sql(place.path(), "SELECT expires_us FROM lease"); };
    const std::string before = end();
    return comes_true([&] { return end() != before; });
  }
  StoreResult<std::unique_ptr<Store>> open_as_second(bool waits) const {
    LeaseTerms terms{"second", std::chrono::minutes(10)};
    terms.waits = waits;
    return open_world(place.path(), StoreAccess::read_write, "", terms);
  }

  TempPlace place;
  FaultProxy proxy{place.path()};
  SplitMix64 rng{1};
  std::unique_ptr<Store> store;
};

}  // namespace

TEST_CASE("an owner whose renewal was cut off once renews again, and nobody else gets the world",
          "[.postgres-server]") {
  for (const ProxyFault& fault : cut_connections()) {
    for (std::uint64_t statement = 1; statement <= kRenewalStatements; ++statement) {
      CAPTURE(statement, text_of(fault));
      OwnerBehindProxy bench(milliseconds(1'500));
      bench.proxy.fail(statement, fault);
      REQUIRE(comes_true([&] { return bench.proxy.has_failed(); }));
      const auto second = bench.open_as_second(false);
      REQUIRE_FALSE(second.has_value());
      CHECK(second.error().kind == StoreError::Kind::locked);
      CHECK(bench.renews());
      CHECK(comes_true([&] { return bench.store->is_owned(); }));
      CHECK(bench.store->append({}, sample_records(bench.rng, 1, 1, 2)).has_value());
      CHECK(*bench.store->last_sequence() == 2);
    }
  }
}

TEST_CASE("an owner that is cut off while it renews stops before another one begins",
          "[.postgres-server]") {
  for (ProxyFault fault : cut_connections()) {
    fault.is_for_ever = true;
    for (std::uint64_t statement = 1; statement <= kRenewalStatements; ++statement) {
      CAPTURE(statement, text_of(fault));
      OwnerBehindProxy bench(milliseconds(300));
      std::atomic<bool> is_lost{false};
      bench.store->watch_ownership([&](const StoreError&) { is_lost = true; });
      bench.proxy.fail(statement, fault);
      REQUIRE(comes_true([&] { return bench.proxy.has_failed(); }));
      // The first try fails if it begins before the last renewal has reached the server.
      auto second = bench.open_as_second(true);
      if (!second) second = bench.open_as_second(true);
      CHECK_FALSE(bench.store->is_owned());
      INFO((second ? "" : second.error().message()));
      REQUIRE(second.has_value());
      REQUIRE(*(*second)->raise_epoch() == 2);
      REQUIRE((*second)->append({}, sample_records(bench.rng, 2, 1, 2)).has_value());
      bench.proxy.heal();
      CHECK(comes_true([&] { return is_lost.load(); }));
      CHECK_FALSE(bench.store->is_owned());
      CHECK_FALSE(bench.store->append({}, sample_records(bench.rng, 1, 1, 3)).has_value());
      CHECK((*second)->is_owned());
      CHECK(*(*second)->last_sequence() == 2);
      bench.store->watch_ownership({});
      bench.store.reset();  // does not give the lease of the other back
      CHECK((*second)->append({}, sample_records(bench.rng, 2, 3, 1)).has_value());
      CHECK((*second)->check().has_value());
    }
  }
}

}  // namespace runstone::test
