// Order: the ordered log of the world: what is queued, ordered, appended and durable. It owns the
// Authority, the names and numbers of players that the log refers to, the materials, the rounds of
// snapshots, and the feed of the log.
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/materials/material_table.hpp"
#include "server/world/environment/world_config.hpp"
#include "server/world/environment/world_counters.hpp"
#include "server/world/environment/world_environment.hpp"
#include "server/world/environment/world_start.hpp"
#include "server/world/order/authority.hpp"
#include "server/world/order/checkpointer.hpp"
#include "server/world/order/large_edit_pace.hpp"
#include "server/world/order/library.hpp"
#include "server/world/order/log_feed.hpp"
#include "server/world/order/name_claims.hpp"
#include "server/world/order/ownership.hpp"
#include "server/world/order/players.hpp"
#include "server/world/order/world_memory.hpp"
#include "server/world/order/world_textures.hpp"

namespace runstone {

/// Why edits are rejected, for players and operators: while the disk is full, while the database
/// takes no writes, and while Order::is_memory_full().
inline constexpr const char* kDiskIsFull = "the world's disk is full or read-only";
inline constexpr const char* kDatabaseIsReadOnly = "the world's database is read-only";
inline constexpr const char* kMemoryIsFull = "the server's memory is full (memory_mib)";

/// The large edits that a commit may have.
enum class LargeEdits { paced, all };

class Order {
 public:
  /// `config`, `environment` and `counters` must outlive the object. `random` gives the client
  /// instance of the server's own edits.
  Order(const WorldConfig& config, const WorldStart& start, WorldEnvironment& environment,
        WorldCounters& counters, const RandomBytes& random);

  Authority& authority() { return authority_; }
  const Authority& authority() const { return authority_; }
  WorldChunks& chunks() { return authority_.chunks(); }
  const WorldChunks& chunks() const { return authority_.chunks(); }
  Players& players() { return players_; }
  const Players& players() const { return players_; }
  NameClaims& names() { return names_; }
  const NameClaims& names() const { return names_; }
  LargeEditPace& large_edits() { return large_edits_; }
  LogFeed& feed() { return feed_; }
  const LogFeed& feed() const { return feed_; }
  Ownership& ownership() { return ownership_; }
  const Ownership& ownership() const { return ownership_; }
  /// Returns the materials in force.
  const MaterialTable& materials() const { return materials_; }

  // Edits.
  Epoch epoch() const { return authority_.epoch(); }
  Sequence head() const { return authority_.head(); }
  /// Returns the last record that this server has.
  Version last_record() const { return {authority_.last_epoch(), authority_.head()}; }
  /// Returns the highest resolved client sequence of the instance, 0 if there is none.
  ClientSequence resolved(AuthorId author, ClientInstance instance) const {
    return authority_.resolved().of(author, instance);
  }
  /// Returns true if an accepted edit of the author is not ordered yet: a large edit, or one behind
  /// it, waits until there is room to send it (EditQueue).
  bool has_waiting_edit(AuthorId author) const { return authority_.queue().has_of(author); }
  /// Returns true if commit() would order edits that are paced.
  bool has_ready_edits(std::size_t sessions, TimeUs now_us) const;
  /// Orders the queued edits of one commit. Returns nullopt if no edit is queued that may be
  /// ordered now. `sessions`: the number of sessions that may see a large edit.
  std::optional<OrderedBatch> commit(LargeEdits large, std::size_t sessions, const Clocks& now);
  /// Appends the materials of these records, which were ordered just now, and gives the shapes.
  /// Returns true if there are any.
  bool apply_materials(const std::vector<EditRecord>& records);
  /// Returns the materials that got their shape in this run, in the order of the log.
  std::span<const Material> shaped() const { return shaped_; }
  /// Returns true if a material is no cube. Cost: O(materials).
  bool has_shapes() const;
  /// Returns the record that added materials or gave shapes last in this run, or 0.
  Sequence newest_materials() const { return materials_seq_; }
  /// Returns the builds of the world. The caller applies records to it as to the materials.
  Library& library() { return library_; }
  const Library& library() const { return library_; }
  /// Returns the textures of the world. The caller applies records to it as to the materials.
  WorldTextures& textures() { return textures_; }
  const WorldTextures& textures() const { return textures_; }
  /// Returns the operation of the next edit that this server makes for an author.
  OperationId next_own_operation(AuthorId author) { return {author, own_instance_, ++own_seq_}; }

  // The log.
  /// Returns true if the log takes another edit, besides those that are queued.
  bool log_has_room(std::size_t records = 1) const {
    return environment_.log_has_room(authority_.queue().size() + records);
  }
  /// Returns true if a record of power may be ordered, such as a ban: also while the disk is full.
  bool log_has_queue_room() const {
    return environment_.log_has_queue_room(authority_.queue().size() + 1);
  }
  /// Appends the records of a batch, and the rows of their authors that the store lacks.
  void append(OrderedBatch& batch);
  void append_players(std::vector<PlayerRow> players) {
    feed_.append_players(epoch(), std::move(players));
  }
  void append_names(std::vector<NameChange> changes) {
    feed_.append_names(epoch(), std::move(changes));
  }
  Sequence durable() const { return durable_; }
  /// Sets the durable watermark. Returns false if it is not higher than before.
  bool set_durable(Sequence seq);
  /// Edits are rejected busy, with the reason disk_reason(), until there is space again. A database
  /// that takes no writes counts as a full disk.
  bool is_disk_full() const { return disk_is_full_; }
  const char* disk_reason() const { return disk_reason_; }
  void set_disk_is_full(bool is_full, const char* why = kDiskIsFull) {
    disk_is_full_ = is_full;
    disk_reason_ = why;
  }
  /// Returns false if the server stops, or the log has failed.
  bool log_accepts() const { return !is_stopping() && !ownership_.is(OwnershipState::log_lost); }
  /// Returns true if another server orders the edits, or is to do so.
  bool is_following() const { return !owns(ownership_.state()); }
  /// Returns false if this server orders no edits: it stops, its log has failed, or another server
  /// owns the world.
  bool accepts_edits() const { return log_accepts() && !is_following(); }
  /// Returns true if this server is the owner, and no other one can be it.
  bool owns_world() const { return !is_following() && environment_.owns_world(); }

  // Players.
  /// Reports that a session of the author has ended, or that the author got a number in vain.
  void author_left(AuthorId author) { gone_authors_.push_back(author); }
  /// Removes authors that have left without a row, except those in `present`. Does nothing for an
  /// author of whom an edit is queued.
  void forget_gone_authors(const std::set<AuthorId>& present);
  bool has_gone_authors() const { return !gone_authors_.empty(); }

  // Snapshots and memory.
  /// Advances the round of snapshots (Checkpointer). Returns the chunks that must be loaded for it.
  std::vector<ChunkKey> step_checkpointer(const Clocks& now);
  void snapshots_saved() { checkpointer_.saved(chunks()); }
  Sequence checkpoint() const { return checkpointer_.checkpoint(); }
  /// Returns the number of chunks with edits that only the log has. Quarantined chunks do not
  /// count.
  std::size_t dirty_chunks() const { return chunks().dirty().size(); }
  /// Cost: O(1).
  WorldMemory memory() const;
  /// Returns true if no chunk may be loaded for any session now.
  bool do_views_wait_for_memory() const { return memory().total() > config_.memory.view_bytes_max; }
  /// Returns true if edits must be rejected now.
  bool is_memory_full() const { return memory().total() > config_.memory.edit_bytes_max; }

  // The end.
  /// Accepts no edits any more, and begins snapshots until `due_us`.
  void begin_stop(TimeUs due_us);
  bool is_stopping() const { return stop_due_us_.has_value(); }
  /// Returns true if a stop is under way and begins no more snapshots.
  bool is_stop_overdue() const { return checkpointer_.is_abandoned(); }
  /// Returns true if a stop is under way whose time for snapshots has passed.
  bool is_stop_due(TimeUs now_us) const { return stop_due_us_ && now_us >= *stop_due_us_; }
  /// Returns true if every ordered edit is durable and either contained in snapshots, except those
  /// of quarantined chunks, or left to the next start because is_stop_overdue().
  bool is_flushed() const;

  /// Orders from now on, behind a log that another server has written up to its end.
  void begin_owning(Sequence checkpoint, AuthorId author_max);

 private:
  std::uint64_t large_room(std::size_t sessions, TimeUs now_us) const;

  const WorldConfig& config_;
  WorldEnvironment& environment_;
  WorldCounters& counters_;
  Ownership ownership_;
  Authority authority_;
  Checkpointer checkpointer_;
  LargeEditPace large_edits_;
  MaterialTable materials_;
  Sequence materials_seq_ = 0;
  std::vector<Material> shaped_;  // at most one entry a row
  Library library_;
  WorldTextures textures_;
  Players players_;
  NameClaims names_;
  std::vector<AuthorId> gone_authors_;
  LogFeed feed_;
  Sequence durable_ = 0;
  bool disk_is_full_ = false;
  const char* disk_reason_ = kDiskIsFull;
  std::optional<TimeUs> stop_due_us_;
  ClientInstance own_instance_ = 0;  // of the server's own edits of this run
  ClientSequence own_seq_ = 0;       // of the last one
};

}  // namespace runstone
