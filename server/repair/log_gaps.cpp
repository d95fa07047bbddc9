#include "server/repair/log_gaps.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "server/store/log_table.hpp"
#include "server/store/sql_result.hpp"

namespace runstone {
namespace {

StoreResult<void> remove_record(sql::Database& database, Sequence seq) {
  const std::string text = "DELETE FROM edit_log WHERE log = 0 AND seq = " + std::to_string(seq);
  return store_result(database.run(text.c_str()));
}

/// Returns the epoch of the record before or behind `seq`, or nullopt if there is none.
StoreResult<std::optional<std::int64_t>> neighbour_epoch(sql::Database& database, Sequence seq,
                                                         bool is_before) {
  auto row = database.prepare("SELECT epoch FROM edit_log WHERE log = 0 AND seq " +
                              std::string(is_before ? "<" : ">") + " ?1 ORDER BY seq " +
                              (is_before ? "DESC" : "ASC") + " LIMIT 1");
  if (!row) return failed(row.error());
  const auto found = row->bind(1, static_cast<std::int64_t>(seq)).step();
  if (!found) return failed(found.error());
  if (!*found) return std::optional<std::int64_t>();
  return std::optional(row->integer(0));
}

StoreResult<std::int64_t> epoch_of(sql::Database& database, Sequence seq) {
  return store_result(database.integer("SELECT epoch FROM edit_log WHERE log = 0 AND seq = " +
                                       std::to_string(seq)));
}

/// Makes the records that stand for lost ones.
class GapPlan {
 public:
  GapPlan(const LogEnd& head, const std::map<Sequence, LostRecord>& known, std::size_t materials,
          ClientInstance instance)
      : before_(head), known_(known), materials_(materials), instance_(instance) {}

  /// Adds the gaps between the record of the call before and this one. Call it for all records that
  /// are there, ascending. Returns false if the record needs more materials than gaps can add.
  bool add(const EditRecord& record) {
    const bool has_gap = before_.version.seq + 1 < record.version.seq;
    const bool has_past = before_.version.seq != 0;
    if (!has_past) before_.time_us = record.time_us;
    add_up_to(record.version.seq - 1);
    if (has_gap && has_past && record.time_us < before_.time_us && !corrects_time(record)) {
      EditRecord& last = gaps_.back();
      last.edit = gap_edit({gap_of(last.edit)->author, true});
      last.time_us = record.time_us;
    }
    before_ = {record.version, record.time_us};
    if (const AddedMaterials* added = added_materials_of(record.edit)) {
      if (added->first > materials_ && !add_materials(added->first - materials_)) return false;
      materials_ = std::max(materials_, added->first + added->rows.size());
      newest_materials_ = record.version.seq;
    } else if (const std::size_t needed =
                   has_voxels(record.edit) ? material_max(record.edit) + 1U : 0;
               needed > materials_) {
      return add_materials(needed - materials_);
    }
    return true;
  }
  /// Adds the gaps up to the end of the log.
  void add_up_to(Sequence last) {
    while (before_.version.seq < last) {
      const Sequence seq = before_.version.seq + 1;
      const auto known = known_.find(seq);
      EditRecord gap;
      gap.version = {std::max<Epoch>(before_.version.epoch, 1), seq};
      gap.op = {0, instance_, ++client_seq_};
      gap.time_us = before_.time_us;
      gap.cause = Cause::gap;
      gap.edit = gap_edit({known == known_.end() ? 0 : known->second.author, false});
      before_.version = gap.version;
      gaps_.push_back(std::move(gap));
    }
  }
  const std::vector<EditRecord>& gaps() const { return gaps_; }
  std::size_t materials_made() const { return made_; }

 private:
  /// Makes gaps add `count` rows. Returns false if there are too few gaps.
  bool add_materials(std::size_t count) {
    while (count > 0) {
      // Rows are added in the order of their ids, so a gap before the newest added rows cannot add
      // some. Of the others the first is taken: a later record may need the rest.
      const auto first = std::ranges::find_if(gaps_, [&](const EditRecord& gap) {
        const GapEdit* edit = gap_of(gap.edit);
        return gap.version.seq > newest_materials_ && edit != nullptr && !edit->begins_era;
      });
      if (first == gaps_.end()) return false;
      AddedMaterials added = lost_materials(materials_, materials_ + count);
      materials_ += added.rows.size();
      made_ += added.rows.size();
      count -= added.rows.size();
      first->edit = materials_edit(std::move(added));
      first->cause = Cause::materials;
      newest_materials_ = first->version.seq;
    }
    return true;
  }

  LogEnd before_;  // the record before the next one
  const std::map<Sequence, LostRecord>& known_;
  std::size_t materials_;
  const ClientInstance instance_;
  ClientSequence client_seq_ = 0;
  Sequence newest_materials_ = 0;  // the record that added rows last
  std::size_t made_ = 0;
  std::vector<EditRecord> gaps_;
};

}  // namespace

AddedMaterials lost_materials(std::size_t first, std::size_t end) {
  AddedMaterials added;
  added.first = static_cast<Material>(first);
  for (std::size_t id = first; id < end && added.rows.size() < kAddedMaterialsMax; ++id) {
    MaterialRow row;
    row.name = "lost_" + std::to_string(id);
    row.colour = {128, 128, 128, 255};
    row.visibility = Visibility::opaque;
    added.rows.push_back(std::move(row));
  }
  return added;
}

StoreResult<void> each_record(sql::Database& database,
                              const std::function<StoreResult<void>(const EditRecord&)>& each) {
  auto rows = database.prepare(std::string("SELECT ") + LogTable::kRecordColumns +
                               " FROM edit_log WHERE log = 0 ORDER BY seq");
  if (!rows) return failed(rows.error());
  for (;;) {
    const auto more = rows->step();
    if (!more) return failed(more.error());
    if (!*more) return {};
    const auto record = LogTable::record_in(*rows);
    if (!record) {
      return failure(StoreError{StoreError::Kind::corrupt, database.file(),
                                "edit_log seq=" + std::to_string(rows->integer(0)),
                                "was sound when it was found"});
    }
    if (auto taken = each(*record); !taken) return taken;
  }
}

StoreResult<void> remove_misfits(sql::Database& database, const LogEnd& head,
                                 const std::map<Sequence, RowOrigin>& doubtful) {
  const std::string text =
      "DELETE FROM edit_log WHERE log = 0 AND seq <= " + std::to_string(head.version.seq);
  if (const auto gone = database.run(text.c_str()); !gone) return failed(gone.error());
  std::vector<Sequence> left;
  for (auto row = doubtful.rbegin(); row != doubtful.rend(); ++row) {
    const auto& [seq, origin] = *row;
    if (seq <= head.version.seq) continue;
    const auto epoch = epoch_of(database, seq);
    if (!epoch) return failed(epoch.error());
    const auto behind = neighbour_epoch(database, seq, false);
    if (!behind) return failed(behind.error());
    const bool fits = *behind ? *epoch <= **behind : origin == RowOrigin::torn;
    if (fits) {
      left.push_back(seq);
    } else if (auto removed = remove_record(database, seq); !removed) {
      return removed;
    }
  }
  for (auto seq = left.rbegin(); seq != left.rend(); ++seq) {
    const auto epoch = epoch_of(database, *seq);
    if (!epoch) return failed(epoch.error());
    const auto before = neighbour_epoch(database, *seq, true);
    if (!before) return failed(before.error());
    if (*epoch >= before->value_or(head.version.epoch)) continue;
    if (auto removed = remove_record(database, *seq); !removed) return removed;
  }
  return {};
}

StoreResult<std::vector<Sequence>> lost_sequences(sql::Database& database, const LogEnd& head,
                                                  Sequence last) {
  std::vector<Sequence> lost;
  auto rows = database.prepare("SELECT seq FROM edit_log WHERE log = 0 ORDER BY seq");
  if (!rows) return failed(rows.error());
  Sequence next = head.version.seq + 1;
  for (;;) {
    const auto more = rows->step();
    if (!more) return failed(more.error());
    const Sequence there = *more ? static_cast<Sequence>(rows->integer(0)) : last + 1;
    for (; next < there; ++next) lost.push_back(next);
    if (!*more) return lost;
    next = there + 1;
  }
}

StoreResult<std::map<Sequence, LostRecord>> find_lost_records(sql::Database& database,
                                                              PageFile& pages,
                                                              const std::vector<Sequence>& lost) {
  std::map<Sequence, LostRecord> known;
  if (lost.empty()) return known;
  auto row = database.prepare("SELECT author, cause FROM edit_log WHERE log = 0 AND seq = ?1");
  if (!row) return failed(row.error());
  auto read =
      scan_index_pages(pages, [&](const std::vector<IndexEntry>& entries) -> StoreResult<void> {
        const auto is_lost = [&](const IndexEntry& entry) {
          return std::ranges::binary_search(lost, entry.seq);
        };
        if (std::ranges::none_of(entries, is_lost)) return {};
        // The sound records of the page show which of the two indexes it belongs to.
        std::size_t by_author = 0, by_cause = 0;
        for (const IndexEntry& entry : entries) {
          const sql::ResetAtEnd reset_at_end(*row);
          const auto found = row->bind(1, static_cast<std::int64_t>(entry.seq)).step();
          if (!found) return failed(found.error());
          if (!*found) continue;
          by_author += row->integer(0) == entry.value ? 1 : 0;
          by_cause += row->integer(1) == entry.value ? 1 : 0;
        }
        if (by_author == by_cause) return {};
        for (const IndexEntry& entry : entries) {
          if (!is_lost(entry) || entry.value < 0) continue;
          if (by_cause > by_author && entry.value <= kCauseMax) {
            known[entry.seq].cause = static_cast<Cause>(entry.value);
          } else if (by_author > by_cause && entry.value <= std::numeric_limits<AuthorId>::max()) {
            known[entry.seq].author = static_cast<AuthorId>(entry.value);
          }
        }
        return {};
      });
  if (!read) return failed(read.error());
  return known;
}

StoreResult<std::size_t> fill_gaps(sql::Database& database, const LogEnd& head,
                                   const std::vector<Sequence>& lost,
                                   const std::map<Sequence, LostRecord>& known,
                                   std::size_t materials, ClientInstance instance) {
  if (lost.empty()) return std::size_t{0};
  GapPlan plan(head, known, materials, instance);
  auto read = each_record(database, [&](const EditRecord& record) -> StoreResult<void> {
    if (plan.add(record)) return {};
    return failure(StoreError{StoreError::Kind::corrupt, database.file(),
                              "edit_log seq=" + std::to_string(record.version.seq),
                              "has materials that the material table lacks"});
  });
  if (!read) return failed(read.error());
  plan.add_up_to(lost.back());
  auto log = LogTable::open(database);
  if (!log) return failed(log.error());
  if (auto inserted = log->insert(plan.gaps()); !inserted) return failed(inserted.error());
  return plan.materials_made();
}

}  // namespace runstone
