#include "server/repair/world_rebuild.hpp"

#include <algorithm>
#include <utility>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/materials/look_on_shape.hpp"
#include "server/repair/built_in_materials.hpp"
#include "server/repair/table_folds.hpp"
#include "server/store/build_table.hpp"
#include "server/store/durable_mark.hpp"
#include "server/store/name_table.hpp"
#include "server/store/player_table.hpp"
#include "server/store/segment_table.hpp"
#include "server/store/sql_result.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {
namespace {

constexpr const char* kMaterialsKey = "materials";

std::uint64_t counter_in(const MetaRows& rows, const char* key) {
  const auto row = rows.find(key);
  const auto* value = row == rows.end() ? nullptr : std::get_if<std::int64_t>(&row->second);
  return value == nullptr || *value < 0 ? 0 : static_cast<std::uint64_t>(*value);
}

}  // namespace

StoreResult<void> WorldRebuild::find_rows(
    const std::function<void(std::uint64_t, std::uint64_t)>& on_progress) {
  auto proof = RowProof::open(*database_);
  if (!proof) return failed(proof.error());
  ScanEvents events;
  events.on_row = [&](FoundTable table, const StoredRow& row, RowOrigin origin) {
    return found_->add(table, row, origin);
  };
  events.on_damaged_row = [&](FoundTable table, const StoredRow& row) -> StoreResult<void> {
    found_->add_damaged(table, row);
    return {};
  };
  events.on_progress = on_progress;
  const auto lines = scan_world(pages_, *proof, events);
  if (!lines) return failed(lines.error());
  report_.damage = pages_.damage();
  report_.damage.insert(report_.damage.end(), lines->begin(), lines->end());
  report_.damage.insert(report_.damage.end(), found_->damage().begin(), found_->damage().end());
  return {};
}

StoreResult<void> WorldRebuild::find_pinned_values() {
  const MetaRows& there = found_->meta();
  MetaRows from_backup;
  if (backup_ != nullptr) {
    from_backup = rows_of(backup_->meta());
    const auto id = there.find("world_id");
    if (id != there.end() && id->second != from_backup.at("world_id")) {
      return failure(StoreError{StoreError::Kind::bad_request, backup_->file(), "",
                                "is a backup of another world"});
    }
  }
  for (const auto& [key, unused] : rows_of(WorldMeta{})) {
    if (const auto row = there.find(key); row != there.end()) {
      meta_[key] = row->second;
    } else if (const auto kept = from_backup.find(key); kept != from_backup.end()) {
      meta_[key] = kept->second;
      report_.taken.push_back("meta key=" + key + " from the backup");
    } else if (key == kMaterialsKey) {
      are_materials_lost_ = true;
      meta_[key] = to_toml(MaterialTable());  // until the log is known
    } else {
      return failure(StoreError{StoreError::Kind::corrupt, folder_, "meta key=" + key,
                                "is lost, and nothing else in the world has it. Give the folder of "
                                "an older backup with --from"});
    }
  }
  if (const auto meta = meta_of(meta_); !meta) {
    return failure(StoreError{StoreError::Kind::corrupt, folder_, "meta key=" + meta.error(),
                              "has an impossible value"});
  }
  return {};
}

StoreResult<void> WorldRebuild::find_materials() {
  if (!are_materials_lost_) return {};
  const auto meta = meta_of(meta_);
  const bool has_shapes = found_->meta().contains(kShapesKey);
  auto found = find_built_in_materials(*database_, {meta->generator, meta->chunk_edge, has_shapes});
  if (!found) return failed(found.error());
  if (found->name.empty()) {
    return failure(StoreError{
        StoreError::Kind::corrupt, folder_, std::string("meta key=") + kMaterialsKey,
        "is lost, and nothing else in the world has it. The built-in table is not that of this "
        "world: " +
            found->fault + ". Give the folder of an older backup with --from"});
  }
  report_.taken.push_back(
      std::string("meta key=") + kMaterialsKey + ": " + found->name + " with " +
      std::to_string(found->table.size()) +
      " rows. All of base and log fits it. If the world was created with --materials, take the "
      "table from a backup instead: repair it with --from");
  if (head_.version.seq != 0) {
    report_.losses.push_back(
        std::string("meta key=") + kMaterialsKey + ": materials that were added up to seq=" +
        std::to_string(head_.version.seq) + ", and that no voxel has, are lost if there were any");
  }
  meta_[kMaterialsKey] = to_toml(found->table);
  if (found->table.has_shapes() || has_silhouettes(found->table))
    meta_[kShapesKey] = std::int64_t{1};
  return {};
}

std::int32_t WorldRebuild::chunk_edge() const {
  return static_cast<std::int32_t>(std::get<std::int64_t>(meta_.at("chunk_edge")));
}

StoreResult<void> WorldRebuild::find_head() {
  const auto row = found_->meta().find("log_head");
  const auto* bytes = row == found_->meta().end() ? nullptr : std::get_if<Bytes>(&row->second);
  if (bytes != nullptr && bytes->size() == 20) {
    ByteReader reader(*bytes);
    head_.version.epoch = reader.u32();
    head_.version.seq = reader.u64();
    head_.time_us = static_cast<TimeUs>(reader.u64());
    return {};
  }
  // Chunks of the base are no newer than the head, and the log begins behind it.
  auto newest = database_->prepare("SELECT epoch, seq FROM base ORDER BY seq DESC LIMIT 1");
  if (!newest) return failed(newest.error());
  const auto has_base = newest->step();
  if (!has_base) return failed(has_base.error());
  if (*has_base)
    head_.version = {static_cast<Epoch>(newest->integer(0)),
                     static_cast<Sequence>(newest->integer(1))};
  auto first = database_->prepare(
      "SELECT epoch, seq, time_us FROM edit_log WHERE log = 0 AND seq > ?1 ORDER BY seq LIMIT 1");
  if (!first) return failed(first.error());
  const auto has_log = first->bind(1, static_cast<std::int64_t>(head_.version.seq)).step();
  if (!has_log) return failed(has_log.error());
  if (*has_log && head_.version.seq != 0) {
    head_.version.epoch = static_cast<Epoch>(first->integer(0));
    head_.version.seq = static_cast<Sequence>(first->integer(1)) - 1;
    head_.time_us = first->integer(2);
  }
  report_.losses.push_back("meta key=log_head: the log is taken to begin behind seq=" +
                           std::to_string(head_.version.seq));
  return {};
}

StoreResult<void> WorldRebuild::read_mark() {
  state_ = {static_cast<Epoch>(counter_in(found_->meta(), "epoch")),
            counter_in(found_->meta(), "log_last"),
            static_cast<AuthorId>(counter_in(found_->meta(), "author_max"))};
  const auto meta = meta_of(meta_);
  DurableMark mark(folder_, meta->world_id, "");
  const auto durable = mark.read();
  if (!durable && durable.error().may_pass()) return failed(durable.error());
  if (durable && *durable) {
    state_.epoch = std::max(state_.epoch, (*durable)->epoch);
    state_.seq = std::max(state_.seq, (*durable)->seq);
    state_.author_max = std::max(state_.author_max, (*durable)->author_max);
  } else if (!durable) {
    report_.damage.push_back("world.durable: " + durable.error().what);
  }
  return {};
}

StoreResult<void> WorldRebuild::report_lost(const std::vector<Sequence>& lost,
                                            const std::map<Sequence, LostRecord>& known) {
  auto before = database_->prepare(
      "SELECT time_us FROM edit_log WHERE log = 0 AND seq < ?1 ORDER BY seq DESC LIMIT 1");
  if (!before) return failed(before.error());
  auto behind = database_->prepare(
      "SELECT time_us FROM edit_log WHERE log = 0 AND seq > ?1 ORDER BY seq LIMIT 1");
  if (!behind) return failed(behind.error());
  for (const Sequence seq : lost) {
    GoneEdit edit;
    edit.seq = seq;
    const auto bound = static_cast<std::int64_t>(seq);
    const sql::ResetAtEnd reset_before_at_end(*before);
    const sql::ResetAtEnd reset_behind_at_end(*behind);
    const auto has_before = before->bind(1, bound).step();
    if (!has_before) return failed(has_before.error());
    const auto has_behind = behind->bind(1, bound).step();
    if (!has_behind) return failed(has_behind.error());
    edit.from_us = *has_before ? before->integer(0) : head_.time_us;
    edit.until_us = *has_behind ? behind->integer(0) : now_us_;
    if (const auto hint = known.find(seq); hint != known.end()) {
      edit.author = hint->second.author;
      edit.cause = hint->second.cause;
    }
    if (const auto damaged = found_->unproven().find(seq); damaged != found_->unproven().end()) {
      if (edit.author == 0) edit.author = damaged->second.author;
      edit.box = damaged->second.box;
    }
    report_.lost.push_back(edit);
  }
  return {};
}

StoreResult<void> WorldRebuild::rebuild_log() {
  sql::Database& database = *database_;
  if (auto removed = remove_misfits(database, head_, found_->doubtful()); !removed) return removed;
  if (auto found = find_materials(); !found) return found;
  const auto kept = database.integer("SELECT count(*) FROM edit_log");
  if (!kept) return failed(kept.error());
  report_.records = static_cast<std::uint64_t>(*kept);
  if (backup_ != nullptr) {
    const auto taken = backup_->fill_log(database, head_, state_.epoch);
    if (!taken) return failed(taken.error());
    report_.records_from_backup = *taken;
  }
  const auto newest = database.integer("SELECT coalesce(max(seq), 0) FROM edit_log WHERE log = 0");
  if (!newest) return failed(newest.error());
  state_.seq = std::max({state_.seq, static_cast<Sequence>(*newest), head_.version.seq});
  const auto lost = lost_sequences(database, head_, state_.seq);
  if (!lost) return failed(lost.error());
  const auto known = find_lost_records(database, pages_, *lost);
  if (!known) return failed(known.error());
  if (auto reported = report_lost(*lost, *known); !reported) return reported;
  const auto meta = meta_of(meta_);
  const auto made = fill_gaps(database, head_, *lost, *known, meta->materials.size(), instance());
  if (!made) return failed(made.error());
  report_.materials_made = *made;
  operations_ = lost->size();
  return {};
}

StoreResult<std::uint64_t> WorldRebuild::fill_from_backup(FoundTable table) {
  sql::Database& database = *database_;
  switch (table) {
    case FoundTable::base:
      return backup_->fill_base(database, head_);
    case FoundTable::rights_record:
      return backup_->fill_kept_records(database, head_);
    case FoundTable::player:
      return backup_->fill_players(database);
    case FoundTable::name_claim:
      return backup_->fill_claims(database);
    case FoundTable::player_instance:
      return backup_->fill_watermarks(database);
    default:
      return std::uint64_t{0};  // snapshots are made again
  }
}

StoreResult<void> WorldRebuild::complete(FoundTable table) {
  const std::string name = columns_of(table).name;
  const auto expected = fold_in(found_->meta(), fold_key_of(table));
  auto found = fold_of(*database_, table);
  if (!found) return failed(found.error());
  if (expected == *found) return {};
  if (backup_ != nullptr) {
    const auto taken = fill_from_backup(table);
    if (!taken) return failed(taken.error());
    if (*taken != 0)
      report_.taken.push_back(std::to_string(*taken) + " rows of " + name + " from the backup");
    found = fold_of(*database_, table);
    if (!found) return failed(found.error());
  }
  // Rows of torn frames are newer than the fold.
  const bool is_newer = pages_.has_torn_pages() && expected && found->count >= expected->count;
  if (expected == *found || is_newer) return {};
  std::string loss = name + ": ";
  if (!expected) {
    loss += "it is not known whether rows are missing, because meta key=" + fold_key_of(table) +
            " is lost";
  } else if (found->count == expected->count) {
    loss += "an older row stands for one that is lost";
  } else {
    loss += std::to_string(found->count) + " rows of " + std::to_string(expected->count) +
            " that meta counts";
  }
  if (table == FoundTable::player_instance) {
    are_watermarks_lost_ = true;
    loss +=
        ". Edits of clients that run since before the repair are refused, because the world may "
        "have them: their players start the client again";
  }
  report_.losses.push_back(std::move(loss));
  return {};
}

StoreResult<void> WorldRebuild::complete_names() {
  // The row `row_counts` of `meta` has epoch, head and then the number of names.
  const auto row = found_->meta().find("row_counts");
  const auto* bytes = row == found_->meta().end() ? nullptr : std::get_if<Bytes>(&row->second);
  std::uint64_t expected = 0;
  if (bytes != nullptr && bytes->size() >= 20) {
    ByteReader reader(*bytes);
    reader.u32();
    reader.u64();
    expected = reader.u64();
  }
  const auto count = [&] { return database_->integer("SELECT count(*) FROM player_name"); };
  auto found = count();
  if (!found) return failed(found.error());
  if (static_cast<std::uint64_t>(*found) >= expected) return {};
  if (backup_ != nullptr) {
    const auto taken = backup_->fill_names(*database_);
    if (!taken) return failed(taken.error());
    report_.taken.push_back(std::to_string(*taken) + " rows of player_name from the backup");
    found = count();
    if (!found) return failed(found.error());
  }
  if (static_cast<std::uint64_t>(*found) < expected) {
    report_.losses.push_back("player_name: " + std::to_string(*found) + " rows of " +
                             std::to_string(expected) + " that meta counts");
  }
  return {};
}

StoreResult<void> WorldRebuild::complete_tables() {
  // A snapshot of another level, or of a version behind the end of the log, does not belong to this
  // world.
  const std::string foreign =
      "DELETE FROM snapshot WHERE lod <> 0 OR seq > " + std::to_string(state_.seq);
  if (const auto gone = database_->run(foreign.c_str()); !gone) return failed(gone.error());
  for (const FoundTable table : kFoldedTables) {
    // Snapshots are made again. Watermarks are raised to the log before they are completed.
    if (table == FoundTable::snapshot || table == FoundTable::player_instance) continue;
    if (auto completed = complete(table); !completed) return completed;
  }
  return complete_names();
}

StoreResult<void> WorldRebuild::complete_library() {
  if (found_->meta().contains(kBuildFoldKey)) {
    if (auto made = found_->make_library(); !made) return made;
  }
  if (!found_->has_library()) return {};
  auto table = BuildTable::open(*database_);
  if (!table) return failed(table.error());
  LibraryQuery all;
  all.count_max = SIZE_MAX / 2;
  const auto builds = table->find(all);
  if (!builds) return failed(builds.error());
  RowFold unused, unused_parts;
  for (const StoredBuild& build : *builds) {
    const auto whole = table->read(build, [](ByteView) { return true; });
    if (whole) continue;
    if (whole.error().may_pass()) return whole;
    report_.losses.push_back("build number=" + std::to_string(build.number()) + " \"" +
                             build.build().info.name + "\": its file is damaged");
    if (auto removed = table->remove(build.number(), unused, unused_parts); !removed)
      return removed;
  }
  if (auto removed = table->remove_unused_parts(unused_parts); !removed) return removed;
  const auto folds = table->check();
  if (!folds) return failed(folds.error());
  const auto expected = fold_in(found_->meta(), kBuildFoldKey);
  if (!expected || folds->builds.count < expected->count) {
    report_.losses.push_back("build: " + std::to_string(folds->builds.count) +
                             " builds of the library are left");
  }
  auto meta = MetaTable::open(*database_);
  if (!meta) return failed(meta.error());
  if (auto put = meta->put_fold(kBuildFoldKey, folds->builds); !put) return put;
  return meta->put_fold(kBuildPartFoldKey, folds->parts);
}

StoreResult<void> WorldRebuild::follow_log() {
  auto segments = SegmentTable::open(*database_);
  if (!segments) return failed(segments.error());
  std::map<std::pair<AuthorId, ClientInstance>, HighWater> marks;
  auto read = each_record(*database_, [&](const EditRecord& record) -> StoreResult<void> {
    const auto& [author, instance, seq] = record.op;
    HighWater& mark =
        marks.try_emplace({author, instance}, HighWater{author, instance, 0, 0}).first->second;
    mark.resolved = std::max(mark.resolved, seq);
    mark.last_us = std::max(mark.last_us, record.time_us);
    state_.author_max = std::max(state_.author_max, author);
    state_.epoch = std::max(state_.epoch, record.version.epoch);
    if (corrects_time(record)) eras_.push_back({record.version.seq, record.time_us});
    const AddedMaterials* const added = added_materials_of(record.edit);
    if (given_shapes_of(record.edit) != nullptr || (added && has_silhouettes(added->rows)))
      meta_[kShapesKey] = std::int64_t{1};
    if (given_texture_of(record.edit) != nullptr) meta_[kTexturesKey] = std::int64_t{1};
    if (gap_of(record.edit) != nullptr) meta_[kGapsKey] = std::int64_t{1};
    if (grants_for_some_time(record)) meta_[kTimedGrantsKey] = std::int64_t{1};
    return segments->add(record.version.seq, author, bounding_box(record.edit));
  });
  if (!read) return read;
  if (auto flushed = segments->flush(); !flushed) return flushed;
  segments_ = segments->take_added();
  own_mark_ = marks[{0, instance()}];
  marks.erase({0, instance()});
  auto players = PlayerTable::open(*database_);
  if (!players) return failed(players.error());
  RowFold unused;
  for (const auto& [client, mark] : marks) {
    if (auto raised = players->raise(mark, unused); !raised) return raised;
  }
  return {};
}

StoreResult<void> WorldRebuild::raise_own_marks() {
  auto players = PlayerTable::open(*database_);
  if (!players) return failed(players.error());
  RowFold unused;
  if (are_watermarks_lost_) {
    if (auto raised = players->raise(lost_watermarks(state_.author_max, now_us_), unused); !raised)
      return raised;
  }
  if (own_mark_.resolved == 0) return {};
  return players->raise(own_mark_, unused);
}

StoreResult<void> WorldRebuild::write_meta() {
  auto meta = MetaTable::open(*database_);
  if (!meta) return failed(meta.error());
  // These values follow from no other table. The values below are made again.
  for (const char* key :
       {kShapesKey, kTexturesKey, kGapsKey, kTimedGrantsKey, kClockKey, kPlacesKey}) {
    const auto row = found_->meta().find(key);
    if (row != found_->meta().end()) meta_[key] = row->second;
  }
  meta_["epoch"] = std::int64_t{state_.epoch};
  meta_["author_max"] = std::int64_t{state_.author_max};
  meta_["log_last"] = static_cast<std::int64_t>(state_.seq);
  meta_["checkpoint"] = static_cast<std::int64_t>(head_.version.seq);
  for (const auto& [key, value] : meta_) {
    if (auto put = meta->put(key, value); !put) return put;
  }
  if (auto put = meta->put_log_head(head_); !put) return put;
  if (!eras_.empty()) {
    if (auto put = meta->put_log_eras(eras_); !put) return put;
  }
  for (const FoundTable table : kFoldedTables) {
    const auto fold = fold_of(*database_, table);
    if (!fold) return failed(fold.error());
    if (auto put = meta->put_fold(fold_key_of(table), *fold); !put) return put;
  }
  RowCounts counts;
  counts.epoch = state_.epoch;
  counts.head = head_.version.seq;
  counts.segments = segments_;
  const auto names = database_->integer("SELECT count(*) FROM player_name");
  if (!names) return failed(names.error());
  counts.player_names = static_cast<std::uint64_t>(*names);
  return meta->put_row_counts(counts);
}

StoreResult<void> WorldRebuild::fill(
    sql::Database& database, const std::function<void(std::uint64_t, std::uint64_t)>& on_progress) {
  database_ = &database;
  found_.emplace(database);
  if (auto made = create_schema(database); !made) return made;
  if (auto found = find_rows(on_progress); !found) return found;
  if (auto found = find_pinned_values(); !found) return found;
  if (auto found = find_head(); !found) return found;
  if (auto read = read_mark(); !read) return read;
  if (auto rebuilt = rebuild_log(); !rebuilt) return rebuilt;
  if (auto completed = complete_tables(); !completed) return completed;
  if (auto followed = follow_log(); !followed) return followed;
  if (auto completed = complete(FoundTable::player_instance); !completed) return completed;
  if (auto raised = raise_own_marks(); !raised) return raised;
  if (auto completed = complete_library(); !completed) return completed;
  return write_meta();
}

}  // namespace runstone
