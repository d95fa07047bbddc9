// PostgresLease: the right of one program at a time to write a world in PostgreSQL (Gray and
// Cheriton, "Leases", 1989). A row of the table `lease` says who has it and until when, by the
// clock of the database alone.
//   - Whoever takes the lease raises its `term`. Every transaction confirms before its commit that
//     the row still has the term of its program, and holds the row until it is over. So a program
//     that was stopped for too long, or cut off, changes nothing afterwards.
//   - A thread renews the lease on a connection of its own three times in its length.
//   - The owner counts the time of its lease from before it asks, on a clock that no operator sets
//     and that goes on while the machine is suspended. So is_valid() is false before the lease can
//     have run out.
//   - The writer's connection holds an advisory lock. Whoever takes over ends that connection: a
//     transaction that its program never finished would else keep its rows locked. An owner whose
//     connection was ended notices it with the next renewal, also if it has nothing to write.
//   - The owner writes its address to the row, so that other servers of the world find it. Whoever
//     takes the lease removes the address of the earlier owner.
// Threads: take(), confirm(), publish(), release() and the destructor: the one that owns the store.
// Others: any.
#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "common/core/ids.hpp"
#include "common/sql/database.hpp"
#include "server/store/lease_terms.hpp"
#include "server/store/store_error.hpp"

namespace runstone {

class PostgresLease {
 public:
  /// Takes the lease of the world in the first schema of `writer`, a connection to `url`. Waits if
  /// the lease of an earlier owner has still to run out. Fails (locked) if that owner renews it.
  static StoreResult<std::unique_ptr<PostgresLease>> take(const std::string& url,
                                                          sql::Database& writer,
                                                          const LeaseTerms& terms);
  /// Ends the renewals. The lease then runs out, unless release() was called.
  ~PostgresLease();
  PostgresLease(const PostgresLease&) = delete;
  PostgresLease& operator=(const PostgresLease&) = delete;

  /// Returns true if nobody else can have the lease now.
  bool is_valid() const;
  /// `on_lost` is called once, when somebody else has the lease, the writer's connection has ended,
  /// or the database was away for LeaseTerms::alone_max: on the thread of renewals, or in this call
  /// if it happened before. An empty function ends the watch; no call is under way when this
  /// returns.
  void watch(std::function<void(const StoreError&)> on_lost);
  /// Confirms in the caller's transaction that this program has the lease, and keeps others from
  /// taking it until the transaction is over. A lease that ran out and that nobody took is renewed.
  /// Fails (locked) if somebody else has taken it.
  StoreResult<void> confirm(sql::Database& writer);
  /// Writes the address at which other servers of the world reach this one: HOST:PORT. Fails
  /// (locked) and writes nothing if somebody else has taken the lease.
  StoreResult<void> publish(sql::Database& writer, const std::string& address);
  /// Ends renewals and lease, so that the next program need not wait.
  void release(sql::Database& writer);

 private:
  PostgresLease(std::string url, std::int64_t term, std::int64_t writer, LeaseTerms terms,
                TimeUs asked_us);
  void stop_renewals();
  void run();
  /// Renews once and returns the time until the next renewal, or nullopt if the lease is lost.
  std::optional<std::chrono::milliseconds> renew();
  /// Returns the time until the next try, or nullopt if the database was away for too long.
  std::optional<std::chrono::milliseconds> try_again(const StoreError& error);
  void on_renewed(TimeUs asked_us);
  void on_lost(const StoreError& error);

  const std::string url_;
  const std::int64_t term_, writer_;  // the process of PostgreSQL that serves the writer
  const LeaseTerms terms_;
  std::atomic<TimeUs> valid_until_us_;  // boot_now_us()
  // When the last renewal that succeeded was asked for, boot_now_us(). Used by the thread of
  // renewals.
  TimeUs renewed_us_ = 0;
  std::mutex mutex_;
  std::condition_variable stop_;
  bool is_stopping_ = false;                        // guarded by mutex_
  std::function<void(const StoreError&)> on_lost_;  // guarded by mutex_, also while it is called
  std::optional<StoreError> lost_;                  // guarded by mutex_
  std::optional<sql::Database> connection_;         // of the thread of renewals, while it runs
  std::thread renewals_;
};

/// The program that has the lease of a world.
struct LeaseOwner {
  std::string name;     // for messages
  std::string address;  // HOST:PORT for other servers of the world; empty: not known yet
  std::int64_t term = 0;
  friend bool operator==(const LeaseOwner&, const LeaseOwner&) = default;
};

/// Asks who has the lease of a world, again and again. Thread: one at a time.
class LeaseWatch {
 public:
  /// `url` is the address of a database.
  explicit LeaseWatch(std::string url) : url_(std::move(url)) {}
  /// Returns the program that has the lease, or nullopt if none has. Connects if it has no
  /// connection.
  StoreResult<std::optional<LeaseOwner>> owner();

 private:
  StoreResult<std::optional<LeaseOwner>> ask(sql::Database& database);

  std::string url_;
  std::optional<sql::Database> connection_;
};

}  // namespace runstone
