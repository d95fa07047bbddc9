// WorldBackend: what a world needs of its database system besides rows: the lock of its writer, the
// number of its format, the mark of how far its log was durable, and the upkeep of the database.
// Threads: the one that owns the store; is_owned() and watch_ownership(): any.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "common/sql/database.hpp"
#include "protocol/codec/messages.hpp"
#include "server/store/durable_state.hpp"
#include "server/store/log_fold.hpp"
#include "server/store/store_error.hpp"

namespace runstone {

/// Makes the tables of a new world and writes its rows, in the transaction that creates the world.
using FillWorld = std::function<StoreResult<void>(sql::Database&)>;

class WorldBackend {
 public:
  virtual ~WorldBackend() = default;

  virtual sql::Database& database() = 0;
  /// See WorldSink.
  virtual bool is_owned() const { return true; }
  virtual void watch_ownership(std::function<void(const StoreError&)> /*on_lost*/) {}
  virtual StoreResult<void> publish_address(const std::string& /*address*/) { return {}; }
  virtual void give_up() {}
  /// Fails (locked) if another program owns the world. Otherwise none does until the caller's
  /// transaction is over.
  virtual StoreResult<void> confirm_ownership() { return {}; }
  /// Returns the world format that the database names.
  virtual StoreResult<std::uint32_t> format() = 0;
  /// Makes it `format`, in the caller's transaction.
  virtual StoreResult<void> set_format(std::uint32_t format) = 0;

  /// Returns true if the backend keeps a mark of how far the log was durable outside the database.
  /// Without it nobody notices that a database was put back from a backup: its rows fit each other.
  virtual bool has_mark() const = 0;
  // These calls do nothing if there is no mark.

  /// Reads the mark of this world, or nullopt if there is none. Call it before the next two.
  virtual StoreResult<std::optional<DurableState>> read_mark(const WorldId& world) = 0;
  /// Writes a state that is on disk. A write that fails leaves the older mark.
  virtual StoreResult<void> write_mark(const DurableState& state) = 0;
  /// Returns when all that was written is on disk.
  virtual StoreResult<void> sync_mark() = 0;

  /// Moves what the database keeps beside its main file into that file, and returns when it is on
  /// disk. Returns false if a reader keeps it from doing so. `is_last` is true if the caller expects
  /// no further write. Does nothing if there is no mark.
  virtual StoreResult<bool> complete_file(bool is_last) = 0;
  /// Returns the names of the files beside the database that a world without a mark lacks.
  virtual std::string missing_files() const = 0;

  /// Returns how rows can come to be a mixture of old and new ones, and what to do then.
  virtual std::string mixture_advice() const = 0;
  /// If `keep` is true, closing the database changes nothing in it.
  virtual void keep_on_close(bool keep) = 0;
  /// Runs the database's own check. Fails (corrupt) with what it found.
  virtual StoreResult<void> check() = 0;
  /// See Store::shrink().
  virtual StoreResult<void> shrink() = 0;
  /// See WorldReader::free_space().
  virtual StoreResult<FreeSpace> free_space() { return FreeSpace{}; }
  /// See WorldSink::give_back_space(). Call it in the caller's transaction.
  virtual StoreResult<bool> give_back(std::uint32_t /*pages*/) { return false; }
};

}  // namespace runstone
