// ModelDatabase: PostgreSQL as the servers of a world use it: the tables of a world, transactions
// that write them, and the row of the lease (server/store/postgres_lease.hpp). Everything that is
// committed stays. It throws SimFault when the log becomes one that could never be replayed, or is
// written by a server that has lost the lease.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/edits/descriptor/edit_record.hpp"
#include "common/runs/chunk.hpp"
#include "server/world/environment/player_rows.hpp"
#include "tests/simulation/client/session/sim_server.hpp"
#include "tests/simulation/server/world/protection.hpp"

namespace runstone::test {

/// Identifies an owner of the lease. No term is given twice.
using LeaseTerm = std::int64_t;

class ModelDatabase {
 public:
  struct Lease {
    LeaseTerm term = 0;
    std::string address;  // of the owner; empty: not known yet
    TimeUs expires_us = 0;
  };

  ModelDatabase(const VirtualTime& time, std::optional<Protection> without)
      : time_(time), without_(without) {}

  // The lease. Each call is one statement.
  /// Returns the lease, or nullopt if nobody has it.
  std::optional<Lease> owner() const {
    return lease_.expires_us > time_.now() ? std::optional(lease_) : std::nullopt;
  }
  /// Takes the lease if nobody has it, and ends the transactions of the owner before.
  std::optional<LeaseTerm> take(TimeUs length_us) {
    if (owner() && is_there(Protection::expiry)) return std::nullopt;
    lease_ = {lease_.term + 1, "", time_.now() + length_us};
    if (is_there(Protection::locked_row)) open_.clear();
    return lease_.term;
  }
  /// Returns false if somebody else has taken the lease.
  bool renew(LeaseTerm term, TimeUs length_us) {
    if (term != lease_.term && is_there(Protection::renewal)) return false;
    if (term != lease_.term) lease_.term = term;  // its owner goes on as if nothing had happened
    lease_.expires_us = time_.now() + length_us;
    return true;
  }
  bool publish(LeaseTerm term, const std::string& address) {
    if (term != lease_.term) return false;
    lease_.address = address;
    return true;
  }
  void release(LeaseTerm term) {
    if (term == lease_.term) lease_.expires_us = 0;
  }
  /// Returns true if nobody but the owner of this term can write.
  bool holds(LeaseTerm term) const { return term == lease_.term && owner().has_value(); }

  // Transactions. A program has one at a time. It confirms the lease when it has written, just
  // before it commits.
  using Transaction = std::uint64_t;
  Transaction begin() {
    open_.insert(++transactions_);
    return transactions_;
  }
  /// Returns false if somebody else has taken the lease, or if the transaction was ended.
  bool confirm(Transaction transaction, LeaseTerm term, TimeUs length_us) {
    if (!open_.contains(transaction) || !may_write(term)) return false;
    if (term == lease_.term && !owner()) lease_.expires_us = time_.now() + length_us;
    return true;
  }
  /// Returns false if the transaction was ended: nothing may be written in it.
  bool commit(Transaction transaction) { return open_.erase(transaction) != 0; }
  /// No transaction can write meanwhile.
  bool is_disk_full = false;
  /// All connections end. What was not committed is lost.
  void restart() { open_.clear(); }

  /// Notes what the owner of an epoch has ordered, and not yet written.
  void ordered(std::span<const EditRecord> records) {
    for (const EditRecord& record : records) {
      const auto [found, is_new] = ordered_.emplace(record.version, record.op);
      if (!is_new && found->second != record.op)
        throw SimFault("two edits have the version " + std::to_string(record.version.epoch) + ":" +
                       std::to_string(record.version.seq));
    }
  }

  /// Notes that a server has told a player the reason why an edit is rejected.
  void rejected(AuthorId author, ClientSequence seq) { rejected_.emplace(author, seq); }
  bool was_rejected(AuthorId author, ClientSequence seq) const {
    return rejected_.contains({author, seq});
  }
  bool has(const OperationId& op) const { return operations_.contains(op); }

  // Writes of a transaction. `term` is that of the program that writes.
  void append(LeaseTerm term, std::span<const PlayerRow> players,
              std::span<const EditRecord> records) {
    check_writer(term);
    for (const PlayerRow& row : players) write(row);
    for (const EditRecord& record : records) write(record);
  }
  void change_names(LeaseTerm term, std::span<const NameChange> changes) {
    check_writer(term);
    for (const NameChange& change : changes) {
      const std::string& folded = change.claim.folded;
      if (change.is_release)
        names_.erase(folded);
      else
        names_[folded] = change.claim;
    }
  }
  void save_snapshots(LeaseTerm term, const std::vector<std::pair<ChunkKey, ChunkPtr>>& chunks,
                      Sequence checkpoint) {
    check_writer(term);
    if (checkpoint > last()) throw SimFault("the checkpoint is ahead of the log");
    for (const auto& [key, chunk] : chunks) {
      if (chunk->version.seq > last()) throw SimFault("a snapshot is ahead of the log");
      snapshots_[key] = *chunk;
    }
    checkpoint_ = std::max(checkpoint_, checkpoint);
  }
  Epoch raise_epoch(LeaseTerm term) {
    check_writer(term);
    if (is_there(Protection::epoch) || epoch_ == 0) ++epoch_;
    if (!epochs_.emplace(epoch_, term).second)
      throw SimFault("two owners have the epoch " + std::to_string(epoch_));
    return epoch_;
  }
  bool may_write(LeaseTerm term) const {
    return term == lease_.term || !is_there(Protection::fence);
  }

  // The tables.
  const std::vector<EditRecord>& log() const { return log_; }
  Sequence last() const { return log_.empty() ? 0 : log_.back().version.seq; }
  Epoch epoch() const { return epoch_; }
  Sequence checkpoint() const { return checkpoint_; }
  const std::map<AuthorId, PlayerRow>& players() const { return players_; }
  const std::map<std::string, NameClaim>& names() const { return names_; }
  const std::map<ChunkKey, Chunk>& snapshots() const { return snapshots_; }

  bool is_there(Protection protection) const { return without_ != protection; }

 private:
  void check_writer(LeaseTerm term) const {
    if (term != lease_.term) throw SimFault("a server without the lease has written");
  }
  void write(const PlayerRow& row) {
    const auto [found, is_new] = players_.try_emplace(row.author, row);
    if (!is_new && found->second.key != row.key)
      throw SimFault("two players have the number " + std::to_string(row.author));
    found->second = row;
  }
  void write(const EditRecord& record) {
    const Version& version = record.version;
    const std::string name = "record " + std::to_string(version.seq);
    if (version.seq != last() + 1) throw SimFault(name + " does not continue the log");
    if (version.epoch < epoch_)
      throw SimFault(name + " is of an epoch that was over when another one began");
    // A server that has taken the world over may write what its predecessor ordered.
    if (ordered_.at(version) != record.op)
      throw SimFault(name + " is not what the owner of its epoch has ordered");
    if (!operations_.insert(record.op).second)
      throw SimFault(name + " is an edit that the log has");
    log_.push_back(record);
  }

  const VirtualTime& time_;
  const std::optional<Protection> without_;
  Lease lease_;
  Transaction transactions_ = 0;
  std::set<Transaction> open_;
  std::vector<EditRecord> log_;
  std::set<OperationId> operations_;
  std::map<Version, OperationId> ordered_;  // written or not
  std::set<std::pair<AuthorId, ClientSequence>> rejected_;
  std::map<AuthorId, PlayerRow> players_;
  std::map<std::string, NameClaim> names_;
  std::map<ChunkKey, Chunk> snapshots_;
  std::map<Epoch, LeaseTerm> epochs_;
  Epoch epoch_ = 0;
  Sequence checkpoint_ = 0;
};

}  // namespace runstone::test
