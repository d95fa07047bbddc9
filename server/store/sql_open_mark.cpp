// The part of SqlStore that says in the main file of a world whether that file alone is the world.
// docs/edit-log.md, "The durable mark".
#include "server/store/sql_result.hpp"
#include "server/store/sql_store.hpp"

namespace runstone {

SqlStore::~SqlStore() { static_cast<void>(complete_file().has_value()); }

StoreResult<void> SqlStore::begin_writing() {
  const bool may_write = access_ != StoreAccess::read_only && !broken_;
  if (!may_write || !backend_->has_mark() || (is_open_ && is_open_in_file_)) return {};
  // A world that needs a mark must have one. The mark may only cover what is on disk, and the fsync
  // of this commit covers what a killed program left in the WAL.
  if (!has_mark_file_) {
    if (auto done = transact([&] { return meta_table_.put_open_epoch({}); }); !done) return done;
    if (auto marked = backend_->write_mark(state_); !marked) return marked;
    if (auto synced = backend_->sync_mark(); !synced) return synced;
    has_mark_file_ = true;
  }
  if (auto done = transact([&] { return meta_table_.put_open_epoch(state_.epoch); }); !done)
    return done;
  is_open_ = true;
  const auto completed = backend_->complete_file(false);
  if (!completed) return failed(completed.error());
  // If a reader is in the way, save_snapshots() tries again, and so does SQLite itself.
  is_open_in_file_ = true;
  is_reader_in_the_way_ = !*completed;
  return {};
}

StoreResult<void> SqlStore::complete_file() {
  if (access_ == StoreAccess::read_only || !is_whole_ || broken_ || !is_open_) return {};
  if (auto done = transact([&] { return meta_table_.put_open_epoch({}); }); !done) return done;
  is_open_ = is_open_in_file_ = false;
  const auto completed = backend_->complete_file(true);
  if (!completed) return failed(completed.error());
  if (*completed) return {};
  return failure(StoreError{
      StoreError::Kind::locked, file(), "",
      "is not complete without world.sqlite-wal, because a program reads the world, such as "
      "runstone-web or a backup. Copy the whole folder, or end the program and start and stop the "
      "server once"});
}

}  // namespace runstone
