#include "server/store/log_table.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "server/store/index_hint.hpp"
#include "server/store/record_checksum.hpp"
#include "server/store/sql_result.hpp"

namespace runstone {

namespace {

/// Returns the statement that selects the records ?1 to ?2.
std::string select_text() {
  return std::string("SELECT ") + LogTable::kRecordColumns +
         " FROM edit_log WHERE log = 0 AND seq BETWEEN ?1 AND ?2 ORDER BY seq";
}

// The rows that rows_of_author() finds with one statement. PostgreSQL returns all of them at once.
constexpr std::size_t kRowsPortion = 16'384;
constexpr int kColumns = 16;  // of a row, but for `log`
// The rows that one statement inserts. PostgreSQL takes less than half the time for a row then; with
// SQLite the time does not change.
constexpr std::size_t kManyRows = 16;

/// Returns the statement that inserts so many rows.
std::string insert_text(std::size_t rows) {
  std::string text =
      "INSERT INTO edit_log(log, seq, epoch, author, instance, client_seq, time_us, cause, "
      "subject, min_x, min_y, min_z, max_x, max_y, max_z, descriptor, checksum) VALUES";
  int parameter = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    text += row == 0 ? "(0" : ", (0";
    for (int column = 0; column < kColumns; ++column) text += ", ?" + std::to_string(++parameter);
    text += ")";
  }
  return text;
}

/// Binds the columns of a record to the parameters behind `before`.
void bind_record(sql::Statement& into, int before, const EditRecord& record, ByteView descriptor) {
  const VoxelBox box = bounding_box(record.edit);
  into.bind(before + 1, static_cast<std::int64_t>(record.version.seq))
      .bind(before + 2, std::int64_t{record.version.epoch})
      .bind(before + 3, std::int64_t{record.op.author})
      .bind(before + 4, static_cast<std::int64_t>(record.op.instance))
      .bind(before + 5, static_cast<std::int64_t>(record.op.seq))
      .bind(before + 6, record.time_us)
      .bind(before + 7, static_cast<std::int64_t>(record.cause))
      .bind(before + 8, static_cast<std::int64_t>(record.subject))
      .bind(before + 9, std::int64_t{box.min.x})
      .bind(before + 10, std::int64_t{box.min.y})
      .bind(before + 11, std::int64_t{box.min.z})
      .bind(before + 12, std::int64_t{box.max.x})
      .bind(before + 13, std::int64_t{box.max.y})
      .bind(before + 14, std::int64_t{box.max.z})
      .bind(before + 15, descriptor)
      .bind(before + 16, static_cast<std::int64_t>(record_checksum(record)));
}

bool in_range(std::int64_t value, std::uint64_t max) {
  return value >= 0 && static_cast<std::uint64_t>(value) <= max;
}

}  // namespace

StoreResult<LogTable> LogTable::open(sql::Database& database) {
  // The statements below do not find a row with a damaged log id. Such a row lies at one of the two
  // ends of the key order.
  const auto misplaced_rows = database.integer(
      "SELECT (SELECT count(*) FROM (SELECT 1 FROM edit_log WHERE log < 0 LIMIT 1) AS below) + "
      "(SELECT count(*) FROM (SELECT 1 FROM edit_log WHERE log > 0 LIMIT 1) AS above)");
  if (!misplaced_rows) return failed(misplaced_rows.error());
  if (*misplaced_rows != 0) {
    return failure(StoreError{StoreError::Kind::corrupt, database.file(), "edit_log",
                              "holds rows of a log other than 0"});
  }
  auto first = database.prepare("SELECT seq FROM edit_log WHERE log = 0 ORDER BY seq LIMIT 1");
  if (!first) return failed(first.error());
  auto last = database.prepare(
      "SELECT seq, epoch, time_us FROM edit_log WHERE log = 0 ORDER BY seq DESC LIMIT 1");
  if (!last) return failed(last.error());
  auto insert = database.prepare(insert_text(1));
  if (!insert) return failed(insert.error());
  sql::Statement insert_many;
  if (database.dialect() == sql::Dialect::postgres) {
    auto prepared = database.prepare(insert_text(kManyRows));
    if (!prepared) return failed(prepared.error());
    insert_many = *std::move(prepared);
  }
  return LogTable(database, *std::move(first), *std::move(last), *std::move(insert),
                  std::move(insert_many));
}

std::optional<EditRecord> LogTable::record_in(const sql::Statement& row) {
  const std::int64_t seq = row.integer(0);
  const std::int64_t epoch = row.integer(1);
  const std::int64_t author = row.integer(2);
  const std::int64_t client_seq = row.integer(4);
  const std::int64_t cause = row.integer(6);
  const std::int64_t subject = row.integer(7);
  auto edit = decode_descriptor(row.blob(kDescriptorColumn));
  // The checksum is that of the record's bytes. Numbers that these bytes cannot hold are refused
  // before it is computed.
  if (!in_range(client_seq, kSequenceMax) ||
      !in_range(subject, static_cast<std::uint64_t>(seq - 1)) ||
      !in_range(epoch, std::numeric_limits<Epoch>::max()) ||
      !in_range(author, std::numeric_limits<AuthorId>::max()) || !in_range(cause, kCauseMax) ||
      !edit) {
    return std::nullopt;
  }
  const VoxelBox box = bounding_box(*edit);
  const std::array<std::int64_t, 6> sides = {box.min.x, box.min.y, box.min.z,
                                             box.max.x, box.max.y, box.max.z};
  for (int i = 0; i < 6; ++i) {
    if (row.integer(kBoxColumn + i) != sides[static_cast<std::size_t>(i)]) return std::nullopt;
  }
  EditRecord record{{static_cast<Epoch>(epoch), static_cast<Sequence>(seq)},
                    {static_cast<AuthorId>(author), static_cast<ClientInstance>(row.integer(3)),
                     static_cast<ClientSequence>(client_seq)},
                    row.integer(5),
                    static_cast<Cause>(cause),
                    *std::move(edit),
                    static_cast<Sequence>(subject),
                    LogId{0}};
  if (!validate_fields(record)) return std::nullopt;
  if (static_cast<std::uint64_t>(row.integer(15)) != record_checksum(record)) return std::nullopt;
  return record;
}

Unexpected<StoreError> LogTable::corrupt(Sequence seq, std::string what) const {
  return {{StoreError::Kind::corrupt, database_->file(), "edit_log seq=" + std::to_string(seq),
           std::move(what)}};
}

StoreResult<LogRange> LogTable::range(const LogEnd& head) {
  const LogRange compacted{head.version.seq + 1, head};
  const sql::ResetAtEnd reset_first_at_end(first_);
  auto found = first_.step();
  if (!found) return failed(found.error());
  if (!*found) return compacted;
  const std::int64_t first = first_.integer(0);
  if (first < 1 || static_cast<Sequence>(first) < compacted.first) {
    return corrupt(static_cast<Sequence>(first),
                   "is there, but the log begins at " + std::to_string(compacted.first));
  }
  if (static_cast<Sequence>(first) > compacted.first) return corrupt(compacted.first, "is missing");
  const sql::ResetAtEnd reset_last_at_end(last_);
  found = last_.step();
  if (!found) return failed(found.error());
  const auto last = static_cast<Sequence>(last_.integer(0));
  const std::int64_t epoch = last_.integer(1);
  if (!*found || !in_range(epoch, std::numeric_limits<Epoch>::max())) {
    return corrupt(last, "has an impossible epoch");
  }
  return LogRange{compacted.first, {{static_cast<Epoch>(epoch), last}, last_.integer(2)}};
}

StoreResult<void> LogTable::insert(std::span<const EditRecord> records) {
  std::array<Bytes, kManyRows> descriptors;  // until the statement has run
  const bool has_many = database_->dialect() == sql::Dialect::postgres;
  while (!records.empty()) {
    const std::size_t count = has_many && records.size() >= kManyRows ? kManyRows : 1;
    sql::Statement& into = count == 1 ? insert_ : insert_many_;
    for (std::size_t i = 0; i < count; ++i) {
      descriptors[i] = encode(records[i].edit);
      bind_record(into, static_cast<int>(i) * kColumns, records[i], descriptors[i]);
    }
    if (auto inserted = into.run(); !inserted) return failed(inserted.error());
    records = records.subspan(count);
  }
  return {};
}

StoreResult<std::vector<AuthorId>> LogTable::authors_without(
    const std::vector<PlayerRow>& players) {
  auto next =
      database_->prepare("SELECT author FROM edit_log" + indexed_by(*database_, "edit_log_author") +
                         " WHERE author > ?1 ORDER BY author LIMIT 1");
  if (!next) return failed(next.error());
  std::vector<AuthorId> missing;
  for (std::int64_t author = 0;;) {
    const sql::ResetAtEnd reset_at_end(*next);
    const auto found = next->bind(1, author).step();
    if (!found) return failed(found.error());
    if (!*found) return missing;
    author = next->integer(0);
    const bool has_row = std::any_of(players.begin(), players.end(), [&](const PlayerRow& player) {
      return std::int64_t{player.author} == author;
    });
    if (!has_row) missing.push_back(static_cast<AuthorId>(author));
  }
}

StoreResult<void> LogTable::rows_of_author(const LogRange& range, AuthorId author, Sequence last,
                                           const std::function<bool(const LogRow&)>& each) {
  auto rows = database_->prepare(
      "SELECT seq, epoch, instance, client_seq, cause, subject FROM edit_log" +
      indexed_by(*database_, "edit_log_author") +
      " WHERE log = 0 AND author = ?1 AND seq BETWEEN ?2 AND ?3 ORDER BY seq DESC LIMIT " +
      std::to_string(kRowsPortion));
  if (!rows) return failed(rows.error());
  rows->bind(1, std::int64_t{author}).bind(2, static_cast<std::int64_t>(range.first));
  Sequence until = std::min(last, range.last.version.seq);
  for (std::size_t found = kRowsPortion; found == kRowsPortion;) {
    rows->rewind();
    rows->bind(3, static_cast<std::int64_t>(until));
    for (found = 0;; ++found) {
      const auto more = rows->step();
      if (!more) return failed(more.error());
      if (!*more) break;
      LogRow row;
      row.version = {static_cast<Epoch>(rows->integer(1)), static_cast<Sequence>(rows->integer(0))};
      row.op = {author, static_cast<ClientInstance>(rows->integer(2)),
                static_cast<ClientSequence>(rows->integer(3))};
      if (!in_range(rows->integer(4), kCauseMax))
        return corrupt(row.version.seq, "has an unknown cause");
      row.cause = static_cast<Cause>(rows->integer(4));
      row.subject = static_cast<Sequence>(rows->integer(5));
      until = row.version.seq - 1;
      if (!each(row)) return {};
    }
  }
  return {};
}

StoreResult<sql::Statement> LogTable::reader() {
  return store_result(database_->prepare(select_text()));
}

StoreResult<EditRecord> LogTable::read_one(sql::Statement& reader, Sequence seq) {
  const sql::ResetAtEnd reset_at_end(reader);
  const auto there =
      reader.bind(1, static_cast<std::int64_t>(seq)).bind(2, static_cast<std::int64_t>(seq)).step();
  if (!there) return failed(there.error());
  if (!*there) return corrupt(seq, "is missing");
  const auto record = record_in(reader);
  if (!record) return corrupt(seq, "checksum is wrong");
  return *record;
}

StoreResult<void> LogTable::read(const LogRange& range, Sequence first, Sequence last_wanted,
                                 const std::function<bool(const EditRecord&)>& each) {
  const Sequence until = std::min(last_wanted, range.last.version.seq);
  // `each` may read the log too, so this call has a statement for itself.
  auto rows = database_->prepare(select_text());
  if (!rows) return failed(rows.error());
  // PostgreSQL returns all rows of a statement at once, so it is asked for some at a time.
  const Sequence portion = database_->dialect() == sql::Dialect::sqlite ? kSequenceMax : 4'096;
  Sequence next = std::max(first, range.first);
  Sequence asked = next - 1;  // the last one of the portion
  Epoch epoch = 0;
  for (; next <= until; ++next) {
    if (next > asked) {
      asked = until - next < portion ? until : next + portion - 1;
      rows->rewind();
      rows->bind(1, static_cast<std::int64_t>(next)).bind(2, static_cast<std::int64_t>(asked));
    }
    const auto more = rows->step();
    if (!more) return failed(more.error());
    if (!*more || static_cast<Sequence>(rows->integer(0)) != next)
      return corrupt(next, "is missing");
    const auto record = record_in(*rows);
    if (!record) return corrupt(next, "checksum is wrong");
    if (record->version.epoch < epoch)
      return corrupt(next, "has an older epoch than the edit before it");
    epoch = record->version.epoch;
    if (!each(*record)) return {};
  }
  return {};
}

}  // namespace runstone
