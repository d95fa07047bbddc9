#include "server/chat/chat_database.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <optional>
#include <system_error>

#include "common/core/text.hpp"
#include "common/sql/transaction.hpp"
#include "common/sqlite/sqlite_file.hpp"
#include "protocol/limits.hpp"
#include "protocol/rules/chat_text.hpp"

namespace runstone {
namespace {

constexpr std::int64_t kLayout = 1;  // PRAGMA user_version
constexpr mode_t kMode = 0600;

// A number is never used twice, so that at most lines_max lines have numbers that append() keeps.
constexpr const char* kSchema =
    "CREATE TABLE line(id INTEGER PRIMARY KEY AUTOINCREMENT, utc_us INTEGER NOT NULL, "
    "kind INTEGER NOT NULL, key BLOB NOT NULL, name TEXT NOT NULL, text TEXT NOT NULL)";

// A column that files of earlier versions lack, and that those versions ignore.
constexpr const char* kHasWithdrawn =
    "SELECT COUNT(*) FROM pragma_table_info('line') WHERE name = 'withdrawn'";
constexpr const char* kAddWithdrawn = "ALTER TABLE line ADD COLUMN withdrawn INTEGER";

// The world strand withdraws only lines that it keeps in memory, so each of them is among the
// newest lines of the database.
constexpr std::int64_t kWithdrawnAmongNewest = 4'096;

// A commit waits for no fsync, which would delay those of the edit log: only a checkpoint does, once
// in some thousand lines. The file shrinks when lines are removed.
constexpr const char* kPragmas =
    "PRAGMA auto_vacuum = FULL; PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL; "
    "PRAGMA secure_delete = ON; PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON";

/// Makes the file for its owner only, or takes what others may do with it.
sql::Result<void> make_private(const std::string& file) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, kMode);
  if (descriptor >= 0 && ::fchmod(descriptor, kMode) == 0) {
    ::close(descriptor);
    return {};
  }
  const std::string why = std::generic_category().message(errno);
  if (descriptor >= 0) ::close(descriptor);
  return failure(sql::Error{sql::Error::Kind::io, file, "cannot be written: " + why});
}

/// Returns the line of a row, or nullopt if no line has these values.
std::optional<ChatEntry> entry_of(const sql::Statement& row) {
  ChatEntry entry;
  ChatLine& line = entry.line;
  line.utc_us = row.integer(0);
  if (line.utc_us < -kWireTimeUsMax || line.utc_us > kWireTimeUsMax) return std::nullopt;
  const std::int64_t kind = row.integer(1);
  const bool is_of_player = kind == static_cast<std::int64_t>(ChatLineKind::player);
  if (!is_of_player && kind != static_cast<std::int64_t>(ChatLineKind::server)) return std::nullopt;
  line.kind = is_of_player ? ChatLineKind::player : ChatLineKind::server;
  const ByteView key = row.blob(2);
  if (key.size() != entry.key.size()) return std::nullopt;
  std::copy(key.begin(), key.end(), entry.key.begin());
  line.name = row.text(3);
  const bool has_name = is_plain_name(line.name) && line.name.size() <= kPlayerNameBytesMax;
  if (is_of_player ? !has_name : !line.name.empty()) return std::nullopt;
  const auto text = chat_text(row.text(4));
  if (!text) return std::nullopt;
  line.text = *text;
  entry.is_withdrawn = row.integer(5) != 0;
  return entry;
}

}  // namespace

bool is_damage(const sql::Error& error) {
  using enum sql::Error::Kind;
  return error.kind == corrupt || error.kind == constraint || error.kind == bad_statement;
}

sql::Result<ChatDatabase> ChatDatabase::open(const std::string& file, std::uint64_t lines_max) {
  if (auto made = make_private(file); !made) return failure(made.error());
  auto opened = sql::open_sqlite(file, sql::SqliteMode::create);
  if (!opened) return failure(opened.error());
  ChatDatabase database(*std::move(opened), lines_max);
  if (auto ready = database.prepare(); !ready) return failure(ready.error());
  return database;
}

sql::Result<void> ChatDatabase::prepare() {
  const auto layout = database_.integer("PRAGMA user_version");
  if (!layout) return failure(layout.error());
  if (auto set = database_.run(kPragmas); !set) return set;
  if (*layout == 0) {
    auto transaction = sql::Transaction::begin(database_);
    if (!transaction) return failure(transaction.error());
    if (auto made = database_.run(kSchema); !made) return made;
    const std::string mark = "PRAGMA user_version = " + std::to_string(kLayout);
    if (auto marked = database_.run(mark.c_str()); !marked) return marked;
    if (auto committed = transaction->commit(); !committed) return committed;
  } else if (*layout != kLayout) {
    return failure(sql::Error{sql::Error::Kind::corrupt, database_.file(), "has another layout"});
  }
  const auto has_withdrawn = database_.integer(kHasWithdrawn);
  if (!has_withdrawn) return failure(has_withdrawn.error());
  if (*has_withdrawn == 0) {
    if (auto added = database_.run(kAddWithdrawn); !added) return added;
  }
  const auto take = [this](const char* text, sql::Statement& into) -> sql::Result<void> {
    auto statement = database_.prepare(text);
    if (!statement) return failure(statement.error());
    into = *std::move(statement);
    return {};
  };
  if (auto ok = take("INSERT INTO line(utc_us, kind, key, name, text) VALUES(?1, ?2, ?3, ?4, ?5)",
                     insert_);
      !ok)
    return ok;
  if (auto ok = take("DELETE FROM line WHERE id <= (SELECT MAX(id) FROM line) - ?1", trim_); !ok)
    return ok;
  // The times of lines fall where the time of the log was corrected.
  if (auto ok = take("DELETE FROM line WHERE id <= (SELECT MAX(id) FROM line WHERE utc_us < ?1)",
                     forget_);
      !ok)
    return ok;
  if (auto ok = take("UPDATE line SET withdrawn = 1 WHERE id > (SELECT MAX(id) FROM line) - ?1 "
                     "AND kind = ?2 AND key = ?3 AND utc_us = ?4",
                     withdraw_);
      !ok)
    return ok;
  return take("SELECT utc_us, kind, key, name, text, withdrawn FROM line ORDER BY id DESC",
              newest_);
}

sql::Result<void> ChatDatabase::insert(const ChatEntry& entry) {
  const ChatLine& line = entry.line;
  return insert_.bind(1, line.utc_us)
      .bind(2, static_cast<std::int64_t>(line.kind))
      .bind(3, ByteView(entry.key))
      .bind(4, std::string_view(line.name))
      .bind(5, std::string_view(line.text))
      .run();
}

sql::Result<void> ChatDatabase::append(std::span<const ChatEntry> entries) {
  auto transaction = sql::Transaction::begin(database_);
  if (!transaction) return failure(transaction.error());
  for (const ChatEntry& entry : entries) {
    if (auto inserted = insert(entry); !inserted) return inserted;
  }
  trim_.bind(1, static_cast<std::int64_t>(lines_max_));
  if (auto trimmed = trim_.run(); !trimmed) return trimmed;
  return transaction->commit();
}

sql::Result<void> ChatDatabase::withdraw(const PublicKey& key, std::span<const TimeUs> times) {
  auto transaction = sql::Transaction::begin(database_);
  if (!transaction) return failure(transaction.error());
  for (const TimeUs utc_us : times) {
    auto marked = withdraw_.bind(1, kWithdrawnAmongNewest)
                      .bind(2, static_cast<std::int64_t>(ChatLineKind::player))
                      .bind(3, ByteView(key))
                      .bind(4, utc_us)
                      .run();
    if (!marked) return marked;
  }
  return transaction->commit();
}

sql::Result<void> ChatDatabase::forget_before(TimeUs utc_us) {
  forget_.bind(1, utc_us);
  if (auto forgotten = forget_.run(); !forgotten) return forgotten;
  if (database_.changes() == 0) return {};
  return database_.run("PRAGMA wal_checkpoint(TRUNCATE)");  // the WAL has the lines too
}

sql::Result<std::vector<ChatEntry>> ChatDatabase::search(const ChatQuery& query) {
  const sql::ResetAtEnd reset_at_end(newest_);
  std::vector<ChatEntry> found;
  while (found.size() < query.limit) {
    const auto row = newest_.step();
    if (!row) return failure(row.error());
    if (!*row) break;
    auto entry = entry_of(newest_);
    if (!entry) continue;
    if (query.since_us && entry->line.utc_us < *query.since_us) break;
    if (entry->is_withdrawn && !query.with_withdrawn) continue;
    if (!is_written_by(*entry, query.by)) continue;
    found.push_back(*std::move(entry));
  }
  std::reverse(found.begin(), found.end());
  return found;
}

}  // namespace runstone
