#include "server/store/meta_table.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "server/store/sql_result.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {

namespace {

std::int64_t checksum_of(std::string_view key, const MetaValue& value) {
  RowChecksum sum("meta");
  sum.text(key);
  if (const auto* integer = std::get_if<std::int64_t>(&value)) {
    sum.text("integer").integer(*integer);
  } else if (const auto* text = std::get_if<std::string>(&value)) {
    sum.text("text").text(*text);
  } else {
    sum.text("blob").blob(*std::get_if<Bytes>(&value));
  }
  return sum.value();
}

template <std::size_t N>
Bytes bytes_of(const std::array<std::uint8_t, N>& value) {
  return {value.begin(), value.end()};
}

/// Reads typed values out of rows, and keeps the first key that is missing or wrong.
class MetaReader {
 public:
  explicit MetaReader(const MetaRows& rows) : rows_(rows) {}

  std::int64_t integer(std::string_view key, std::int64_t low, std::int64_t high) {
    const auto* value = get<std::int64_t>(key);
    if (value == nullptr) return low;
    if (*value < low || *value > high) reject(key);
    return *value;
  }
  std::string text(std::string_view key) {
    const auto* value = get<std::string>(key);
    return value == nullptr ? std::string() : *value;
  }
  template <std::size_t N>
  std::array<std::uint8_t, N> bytes(std::string_view key) {
    std::array<std::uint8_t, N> out{};
    const auto* value = get<Bytes>(key);
    if (value == nullptr) return out;
    if (value->size() != N) {
      reject(key);
    } else {
      std::copy(value->begin(), value->end(), out.begin());
    }
    return out;
  }
  void reject(std::string_view key) {
    if (bad_key_.empty()) bad_key_ = key;
  }
  const std::string& bad_key() const { return bad_key_; }

 private:
  template <class T>
  const T* get(std::string_view key) {
    const auto row = rows_.find(key);
    const T* value = row == rows_.end() ? nullptr : std::get_if<T>(&row->second);
    if (value == nullptr) reject(key);
    return value;
  }
  const MetaRows& rows_;
  std::string bad_key_;
};

// A value as an integer, a text and a blob, two of which are NULL.
constexpr const char* kSqliteValue =
    "CASE typeof(value) WHEN 'integer' THEN value END, CASE typeof(value) WHEN 'text' THEN value "
    "END, CASE typeof(value) WHEN 'blob' THEN value END";
constexpr const char* kPostgresValue = "integer_value, text_value, blob_value";
constexpr const char* kSqliteWrite =
    "INSERT OR REPLACE INTO meta(key, value, checksum) VALUES(?1, coalesce(?2, ?3, ?4), ?5)";
constexpr const char* kPostgresWrite =
    "INSERT INTO meta(key, integer_value, text_value, blob_value, checksum) "
    "VALUES(?1, ?2, ?3, ?4, ?5) ON CONFLICT(key) DO UPDATE SET "
    "integer_value = excluded.integer_value, text_value = excluded.text_value, "
    "blob_value = excluded.blob_value, checksum = excluded.checksum";

constexpr std::int64_t kIntegerMin = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kIntegerMax = std::numeric_limits<std::int64_t>::max();

}  // namespace

Bytes spawn_bytes(const WorldPos& spawn) {
  Bytes bytes;
  ByteWriter writer(bytes);
  for (const double coordinate : {spawn.x, spawn.y, spawn.z}) writer.f64(coordinate);
  return bytes;
}

MetaRows rows_of(const WorldMeta& meta) {
  return {{"world_id", bytes_of(meta.world_id)},
          {"chunk_edge", std::int64_t{meta.chunk_edge}},
          {"generator", meta.generator.name},
          {"generator_version", std::int64_t{meta.generator.version}},
          {"seed", static_cast<std::int64_t>(meta.generator.seed)},
          {"generator_parameters", meta.generator.parameters},
          {"materials", to_toml(meta.materials)},
          {"server_key_seed", bytes_of(meta.server_key_seed)},
          {"spawn", spawn_bytes(meta.spawn)}};
}

Result<WorldMeta, std::string> meta_of(const MetaRows& rows) {
  MetaReader in(rows);
  WorldMeta meta;
  meta.world_id = in.bytes<kWorldIdBytes>("world_id");
  meta.chunk_edge = static_cast<std::uint16_t>(in.integer("chunk_edge", 16, kSideMax));
  if (!std::has_single_bit(meta.chunk_edge)) in.reject("chunk_edge");
  meta.generator.name = in.text("generator");
  meta.generator.version =
      static_cast<std::uint32_t>(in.integer("generator_version", 0, 0xffffffff));
  meta.generator.seed = static_cast<std::uint64_t>(in.integer("seed", kIntegerMin, kIntegerMax));
  meta.generator.parameters = in.text("generator_parameters");
  auto materials = parse_material_table(in.text("materials"), "meta");
  if (materials) {
    meta.materials = *std::move(materials);
  } else {
    in.reject("materials");
  }
  meta.server_key_seed = in.bytes<32>("server_key_seed");
  const auto spawn = in.bytes<24>("spawn");
  ByteReader reader(spawn);
  for (double* coordinate : {&meta.spawn.x, &meta.spawn.y, &meta.spawn.z})
    *coordinate = reader.f64();
  if (!in.bad_key().empty()) return failure(in.bad_key());
  return meta;
}

StoreResult<MetaTable> MetaTable::open(sql::Database& database) {
  const bool is_sqlite = database.dialect() == sql::Dialect::sqlite;
  const std::string rows = std::string("SELECT key, ") +
                           (is_sqlite ? kSqliteValue : kPostgresValue) + ", checksum FROM meta ";
  auto all = database.prepare(rows + "ORDER BY key");
  if (!all) return failed(all.error());
  auto one = database.prepare(rows + "WHERE key = ?1");
  if (!one) return failed(one.error());
  auto write = database.prepare(is_sqlite ? kSqliteWrite : kPostgresWrite);
  if (!write) return failed(write.error());
  return MetaTable(database.file(), *std::move(all), *std::move(one), *std::move(write));
}

Unexpected<StoreError> MetaTable::corrupt(std::string_view key, std::string what) const {
  return {{StoreError::Kind::corrupt, file_, "meta key=" + std::string(key), std::move(what)}};
}

StoreResult<MetaValue> MetaTable::read_row(sql::Statement& row, std::string_view key) {
  MetaValue value;
  if (row.type(1) == sql::Type::integer) {
    value = row.integer(1);
  } else if (row.type(2) == sql::Type::text) {
    value = std::string(row.text(2));
  } else if (row.type(3) == sql::Type::blob) {
    value = Bytes(row.blob(3).begin(), row.blob(3).end());
  } else {
    return corrupt(key, "has a value of an unknown type");
  }
  if (row.integer(4) != checksum_of(key, value)) return corrupt(key, "checksum is wrong");
  return value;
}

StoreResult<MetaRows> MetaTable::read_all() {
  const sql::ResetAtEnd reset_at_end(all_);
  MetaRows rows;
  for (;;) {
    const auto more = all_.step();
    if (!more) return failed(more.error());
    if (!*more) return rows;
    const std::string key(all_.text(0));
    auto value = read_row(all_, key);
    if (!value && (key == kPlacesKey || key == kClockKey)) continue;
    if (!value) return failed(value.error());
    rows.insert_or_assign(key, *std::move(value));
  }
}

StoreResult<void> MetaTable::put(const std::string& key, const MetaValue& value) {
  write_.bind(1, std::string_view(key));
  if (const auto* integer = std::get_if<std::int64_t>(&value)) {
    write_.bind(2, *integer);
  } else if (const auto* text = std::get_if<std::string>(&value)) {
    write_.bind(3, std::string_view(*text));
  } else {
    write_.bind(4, ByteView(*std::get_if<Bytes>(&value)));
  }
  return store_result(write_.bind(5, checksum_of(key, value)).run());
}

StoreResult<std::optional<MetaValue>> MetaTable::find(const std::string& key) {
  const sql::ResetAtEnd reset_at_end(one_);
  const auto found = one_.bind(1, std::string_view(key)).step();
  if (!found) return failed(found.error());
  if (!*found) return std::optional<MetaValue>();
  auto value = read_row(one_, key);
  if (!value) return failed(value.error());
  return std::optional(*std::move(value));
}

StoreResult<MetaValue> MetaTable::get(const std::string& key) {
  auto found = find(key);
  if (!found) return failed(found.error());
  if (!*found) return corrupt(key, "is missing");
  return **std::move(found);
}

StoreResult<std::uint64_t> MetaTable::counter(const std::string& key) {
  const auto value = get(key);
  if (!value) return failed(value.error());
  const auto* integer = std::get_if<std::int64_t>(&*value);
  if (integer == nullptr || *integer < 0) return corrupt(key, "is no counter");
  return static_cast<std::uint64_t>(*integer);
}

StoreResult<RowFold> MetaTable::fold(const std::string& key) {
  const auto value = get(key);
  if (!value) return failed(value.error());
  const auto* bytes = std::get_if<Bytes>(&*value);
  if (bytes == nullptr || bytes->size() != 16) return corrupt(key, "is no fold");
  ByteReader reader(*bytes);
  const std::uint64_t count = reader.u64();
  return RowFold{count, reader.u64()};
}

StoreResult<void> MetaTable::put_fold(const std::string& key, const RowFold& fold) {
  Bytes bytes;
  ByteWriter writer(bytes);
  writer.u64(fold.count);
  writer.u64(fold.sum);
  return put(key, bytes);
}

StoreResult<LogEnd> MetaTable::log_head() {
  const std::string key = "log_head";
  const auto value = get(key);
  if (!value) return failed(value.error());
  const auto* bytes = std::get_if<Bytes>(&*value);
  if (bytes == nullptr || bytes->size() != 20) return corrupt(key, "is no place in a log");
  ByteReader reader(*bytes);
  LogEnd head;
  head.version.epoch = reader.u32();
  head.version.seq = reader.u64();
  head.time_us = static_cast<TimeUs>(reader.u64());
  if (head.version.seq > kSequenceMax) return corrupt(key, "is no place in a log");
  return head;
}

StoreResult<void> MetaTable::put_log_head(const LogEnd& head) {
  Bytes bytes;
  ByteWriter writer(bytes);
  writer.u32(head.version.epoch);
  writer.u64(head.version.seq);
  writer.u64(static_cast<std::uint64_t>(head.time_us));
  return put("log_head", bytes);
}

StoreResult<std::vector<LogEra>> MetaTable::log_eras() {
  const auto value = find(kLogErasKey);
  if (!value) return failed(value.error());
  std::vector<LogEra> eras;
  if (!*value) return eras;
  const auto* bytes = std::get_if<Bytes>(&**value);
  if (bytes == nullptr || bytes->size() % 16 != 0)
    return corrupt(kLogErasKey, "is no list of eras");
  ByteReader reader(*bytes);
  while (reader.offset() < bytes->size()) {
    const Sequence first = reader.u64();
    if (first == 0 || first > kSequenceMax || (!eras.empty() && first <= eras.back().first))
      return corrupt(kLogErasKey, "is no list of eras");
    eras.push_back({first, static_cast<TimeUs>(reader.u64())});
  }
  return eras;
}

StoreResult<void> MetaTable::put_log_eras(const std::vector<LogEra>& eras) {
  Bytes bytes;
  ByteWriter writer(bytes);
  for (const LogEra& era : eras) {
    writer.u64(era.first);
    writer.u64(static_cast<std::uint64_t>(era.time_us));
  }
  return put(kLogErasKey, bytes);
}

StoreResult<std::optional<RowCounts>> MetaTable::row_counts() {
  const auto value = find("row_counts");
  if (!value) return failed(value.error());
  if (!*value) return std::optional<RowCounts>();
  const auto* bytes = std::get_if<Bytes>(&**value);
  // A row of kBytesBefore is from a program that did not count segments.
  constexpr std::size_t kBytes = 44, kBytesBefore = 36;
  if (bytes != nullptr && bytes->size() == kBytesBefore) return std::optional<RowCounts>();
  if (bytes == nullptr || bytes->size() != kBytes)
    return corrupt("row_counts", "is no list of counts");
  ByteReader reader(*bytes);
  RowCounts counts;
  counts.epoch = reader.u32();
  counts.head = reader.u64();
  counts.player_names = reader.u64();
  counts.keyframes = reader.u64();
  counts.lost_edits = reader.u64();
  counts.segments = reader.u64();
  const auto epoch = counter("epoch");
  if (!epoch) return failed(epoch.error());
  const auto head = log_head();
  if (!head) return failed(head.error());
  if (counts.epoch != *epoch || counts.head != head->version.seq) return std::optional<RowCounts>();
  return std::optional(counts);
}

StoreResult<void> MetaTable::put_row_counts(const RowCounts& counts) {
  Bytes bytes;
  ByteWriter writer(bytes);
  writer.u32(counts.epoch);
  for (const std::uint64_t value :
       {counts.head, counts.player_names, counts.keyframes, counts.lost_edits, counts.segments})
    writer.u64(value);
  return put("row_counts", bytes);
}

StoreResult<std::optional<Epoch>> MetaTable::open_epoch() {
  const auto value = find("open_epoch");
  if (!value) return failed(value.error());
  if (!*value) return std::optional<Epoch>();
  const auto* written = std::get_if<std::int64_t>(&**value);
  if (written == nullptr) return corrupt("open_epoch", "is no epoch");
  const auto epoch = counter("epoch");
  if (!epoch) return failed(epoch.error());
  if (*written < 0 || static_cast<std::uint64_t>(*written) < *epoch) return std::optional<Epoch>();
  return std::optional(static_cast<Epoch>(*written));
}

StoreResult<void> MetaTable::put_open_epoch(std::optional<Epoch> epoch) {
  return put("open_epoch", epoch ? std::int64_t{*epoch} : std::int64_t{-1});
}

}  // namespace runstone
