// The part of SqlStore that reads, writes and repairs players, names, rights and watermarks.
// `meta` holds a fold of each of these tables, which detects rows that are lost; of `player_name` it
// holds the number of rows.
#include <algorithm>
#include <set>
#include <utility>

#include "common/core/epoch_branch.hpp"
#include "common/names/folded_name.hpp"
#include "server/store/loss_advice.hpp"
#include "server/store/sql_result.hpp"
#include "server/store/sql_store.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {
namespace {

constexpr const char* kPlayers = "player";
constexpr const char* kWatermarks = "player_instance";
constexpr const char* kClaims = "name_claim";
constexpr const char* kRights = "rights_record";
/// A damaged or missing mark does not say how many starts are lost. No more than these, we trust:
/// clients keep chunks by epoch, so an epoch must not be used twice.
constexpr Epoch kEpochsSkipped = 10'000;

std::string fold_key_of(const std::string& table) { return table + "_fold"; }

}  // namespace

StoreResult<void> SqlStore::check_fold(const std::string& table, const RowFold& found,
                                       const std::string& more) {
  const auto expected = meta_table_.fold(fold_key_of(table));
  if (!expected) return failed(expected.error());
  if (found == *expected) return {};
  return failure(StoreError{StoreError::Kind::corrupt, file(), table,
                            "rows vanished, appeared or changed: " + std::to_string(found.count) +
                                " rows, meta counts " + std::to_string(expected->count) + more +
                                ". " + kLossAdvice});
}

StoreResult<void> SqlStore::check_players(const FoldedRows<PlayerRow>& players) {
  if (auto sound = check_fold(kPlayers, players.fold); sound || sound.error().may_pass())
    return sound;
  const auto missing = log_.authors_without(players.rows);
  if (!missing) return failed(missing.error());
  std::string more;
  for (const AuthorId author : *missing) more += ", none for author=" + std::to_string(author);
  return check_fold(kPlayers, players.fold, more);
}

StoreResult<std::vector<PlayerRow>> SqlStore::players() {
  return at_one_moment<std::vector<PlayerRow>>([&]() -> StoreResult<std::vector<PlayerRow>> {
    auto players = player_table_.players();
    if (!players) return failed(players.error());
    if (auto sound = check_players(*players); !sound) return failed(sound.error());
    return std::move(players->rows);
  });
}

StoreResult<std::vector<UsedName>> SqlStore::player_names() { return names_.names(); }

StoreResult<std::vector<NameClaim>> SqlStore::name_claims() {
  if (!claims_) return std::vector<NameClaim>();
  return at_one_moment<std::vector<NameClaim>>([&]() -> StoreResult<std::vector<NameClaim>> {
    auto claims = claims_->claims();
    if (!claims) return failed(claims.error());
    if (auto sound = check_fold(kClaims, claims->fold); !sound) return failed(sound.error());
    return std::move(claims->rows);
  });
}

StoreResult<void> SqlStore::change_names(std::span<const NameChange> changes) {
  return write([&]() -> StoreResult<void> {
    auto fold = meta_table_.fold(fold_key_of(kClaims));
    if (!fold) return failed(fold.error());
    for (const NameChange& change : changes) {
      const auto owner = claims_->owner(change.claim.folded);
      if (!owner) return failed(owner.error());
      if (!change.is_release && *owner && **owner != change.claim.key)
        return refuse("name_claim name=\"" + change.claim.name + "\"", "another key owns it");
      if (change.is_release == owner->has_value()) {
        auto changed = change.is_release ? claims_->remove(change.claim.folded, *fold)
                                         : claims_->add(change.claim, *fold);
        if (!changed) return changed;
      }
    }
    return meta_table_.put_fold(fold_key_of(kClaims), *fold);
  });
}

StoreResult<void> SqlStore::add_claims() {
  const auto players = player_table_.players();
  if (!players) return failed(players.error());
  // A world that lacks players stays as it is, until its losses are accepted.
  if (access_ == StoreAccess::read_write) {
    if (auto sound = check_players(*players); !sound) return sound;
  }
  auto table = ClaimTable::open(database());
  if (!table) return failed(table.error());
  RowFold fold;
  std::set<std::string> claimed;
  for (const PlayerRow& player : players->rows) {  // ascending by author
    const std::string folded = folded_name(player.name);
    if (name_fault(player.name) || !claimed.insert(folded).second) continue;
    if (auto put = table->add({folded, player.name, player.key}, fold); !put) return put;
  }
  claims_ = *std::move(table);
  return meta_table_.put_fold(fold_key_of(kClaims), fold);
}

StoreResult<void> SqlStore::convert_to_format_3() {
  if (auto made = add_tables_of_format_3(database()); !made) return made;
  if (auto added = add_claims(); !added) return added;
  auto kept = KeptRecords::open(database());
  if (!kept) return failed(kept.error());
  kept_ = *std::move(kept);
  return meta_table_.put_fold(fold_key_of(kRights), {});
}

StoreResult<void> SqlStore::read_kept(Cause cause, const EachRecord& each) {
  return at_one_moment<void>([&]() -> StoreResult<void> {
    if (kept_) {
      const auto compacted = kept_->records(cause);
      if (!compacted) return failed(compacted.error());
      if (auto sound = check_fold(kRights, compacted->fold); !sound) return sound;
      for (const EditRecord& record : compacted->rows) {
        if (!each(record)) return {};
      }
    }
    LogQuery in_log;
    in_log.cause = cause;
    return query_log(in_log, each);
  });
}

StoreResult<void> SqlStore::keep_records(Cause cause, Sequence last) {
  auto fold = meta_table_.fold(fold_key_of(kRights));
  if (!fold) return failed(fold.error());
  LogQuery in_log;
  in_log.cause = cause;
  in_log.last = last;
  StoreResult<void> kept;
  auto read = query_log(in_log, [&](const EditRecord& record) {
    kept = kept_->add(record, *fold);
    return kept.has_value();
  });
  if (!read) return read;
  if (!kept) return kept;
  return meta_table_.put_fold(fold_key_of(kRights), *fold);
}

StoreResult<std::vector<HighWater>> SqlStore::high_waters() {
  return at_one_moment<std::vector<HighWater>>([&]() -> StoreResult<std::vector<HighWater>> {
    auto marks = player_table_.high_waters();
    if (!marks) return failed(marks.error());
    if (auto sound = check_fold(kWatermarks, marks->fold); !sound) return failed(sound.error());
    return std::move(marks->rows);
  });
}

StoreResult<void> SqlStore::put_players(std::span<const PlayerRow> players) {
  if (players.empty()) return {};
  auto fold = meta_table_.fold(fold_key_of(kPlayers));
  if (!fold) return failed(fold.error());
  std::int64_t new_names = 0;
  for (const PlayerRow& player : players) {
    if (player.author == 0) return refuse("player author=0", "is the server itself");
    if (auto put = player_table_.put(player, *fold); !put) return put;
    const auto added = names_.add({player.author, player.name});
    if (!added) return failed(added.error());
    new_names += *added;
  }
  if (new_names != 0) {
    auto counted = change_counts([&](RowCounts& counts) {
      counts.player_names += static_cast<std::uint64_t>(new_names);  // may be negative
    });
    if (!counted) return counted;
  }
  return meta_table_.put_fold(fold_key_of(kPlayers), *fold);
}

void SqlStore::raise(Watermarks& marks, const EditRecord& record) {
  const auto [author, instance, seq] = record.op;
  HighWater& mark =
      marks.try_emplace({author, instance}, HighWater{author, instance, seq, record.time_us})
          .first->second;
  mark.resolved = std::max(mark.resolved, seq);
  mark.last_us = std::max(mark.last_us, record.time_us);
}

StoreResult<void> SqlStore::raise_watermarks(const Watermarks& marks) {
  if (marks.empty()) return {};
  auto fold = meta_table_.fold(fold_key_of(kWatermarks));
  if (!fold) return failed(fold.error());
  for (const auto& [client, mark] : marks) {
    if (auto raised = player_table_.raise(mark, *fold); !raised) return raised;
  }
  return meta_table_.put_fold(fold_key_of(kWatermarks), *fold);
}

StoreResult<void> SqlStore::accept_lost_rows(std::vector<std::string>& lost) {
  if (auto accepted = accept_lost_chunks(lost); !accepted) return accepted;
  if (auto accepted = accept_lost_counts(lost); !accepted) return accepted;
  if (auto accepted = accept_lost_builds(lost); !accepted) return accepted;
  const auto players = player_table_.players();
  if (!players) return failed(players.error());
  if (auto sound = check_players(*players); !sound) {
    if (sound.error().may_pass()) return sound;
    lost.push_back(sound.error().message());
    if (auto put = meta_table_.put_fold(fold_key_of(kPlayers), players->fold); !put) return put;
  }
  const auto claims = claims_->claims();
  if (!claims) return failed(claims.error());
  if (auto sound = check_fold(kClaims, claims->fold); !sound) {
    if (sound.error().may_pass()) return sound;
    lost.push_back(sound.error().message());
    if (auto put = meta_table_.put_fold(fold_key_of(kClaims), claims->fold); !put) return put;
  }
  const auto kept = kept_->records();
  if (!kept) return failed(kept.error());
  if (auto sound = check_fold(kRights, kept->fold); !sound) {
    if (sound.error().may_pass()) return sound;
    lost.push_back(sound.error().message());
    if (auto put = meta_table_.put_fold(fold_key_of(kRights), kept->fold); !put) return put;
  }
  const auto found = player_table_.high_waters();
  if (!found) return failed(found.error());
  auto sound = check_fold(kWatermarks, found->fold);
  if (sound || sound.error().may_pass()) return sound;
  lost.push_back(sound.error().message());
  if (auto put = meta_table_.put_fold(fold_key_of(kWatermarks), found->fold); !put) return put;
  Watermarks marks;
  const auto read = read_log(1, kSequenceMax, [&](const EditRecord& record) {
    raise(marks, record);
    return true;
  });
  return read ? raise_watermarks(marks) : read;
}

StoreResult<std::vector<std::string>> SqlStore::accept_losses() {
  std::vector<std::string> lost;
  if (loss_) lost.push_back(loss_->message());
  if (is_mark_unknown_) state_.epoch += kEpochsSkipped;
  // The lost sequences go to other edits. Every epoch that is lost is on the old branch.
  if (loss_ || !backend_->has_mark()) state_.epoch = next_branch(state_.epoch, 0);
  const auto written = transact([&]() -> StoreResult<void> {
    if (auto accepted = accept_lost_rows(lost); !accepted) return accepted;
    if (auto put = put_epoch(state_.epoch); !put) return put;
    if (auto put = meta_table_.put("author_max", std::int64_t{state_.author_max}); !put) return put;
    return delete_tiles();
  });
  if (!written) return failed(written.error());
  backend_->keep_on_close(false);
  return lost;
}

}  // namespace runstone
