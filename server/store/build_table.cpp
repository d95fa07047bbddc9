#include "server/store/build_table.hpp"

#include <xxhash.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string_view>

#include "common/names/folded_name.hpp"
#include "server/store/record_checksum.hpp"
#include "server/store/sql_result.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {
namespace {

/// The text of a build in which a search looks. Texts of a build have no line feed.
struct BuildWords {
  std::string name, author, tags;
};

BuildWords words_of(const BuildInfo& info) {
  BuildWords words{folded_name(info.name), folded_name(info.author), "\n"};
  for (const std::string& tag : info.tags) words.tags += folded_name(tag) + "\n";
  return words;
}

struct BuildRow {
  std::int64_t number = 0, added_by = 0, file_bytes = 0, content = 0;
  std::string_view name, author, tags;
  ByteView record;
};

std::int64_t build_checksum(const BuildRow& row) {
  return RowChecksum("build")
      .integer(row.number)
      .integer(row.added_by)
      .integer(row.file_bytes)
      .integer(row.content)
      .text(row.name)
      .text(row.author)
      .text(row.tags)
      .blob(row.record)
      .value();
}

std::int64_t part_checksum(std::uint64_t content, std::int64_t part, ByteView data) {
  return RowChecksum("build_part")
      .integer(static_cast<std::int64_t>(content))
      .integer(part)
      .blob(data)
      .value();
}

struct DigestDeleter {
  void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
};

constexpr const char* kBuildColumns =
    "number, added_by, file_bytes, content, name, author, tags, record, checksum";

}  // namespace

StoreResult<BuildTable> BuildTable::open(sql::Database& database) {
  // Both return the place of the second text in the first one, and 0 if it is not there.
  const std::string place = database.dialect() == sql::Dialect::sqlite ? "instr(" : "strpos(";
  const std::string columns = std::string("SELECT ") + kBuildColumns + " FROM build";
  // In SQLite the index build_search has all columns of this statement.
  const std::string hint =
      database.dialect() == sql::Dialect::sqlite ? " INDEXED BY build_search" : "";
  auto find = database.prepare("SELECT number FROM build" + hint + " WHERE number < ?1 AND " +
                               place + "name, ?2) > 0 AND " + place + "author, ?3) > 0 AND " +
                               place + "tags, ?4) > 0 ORDER BY number DESC LIMIT ?5");
  if (!find) return failed(find.error());
  auto one = database.prepare(columns + " WHERE number = ?1");
  if (!one) return failed(one.error());
  auto rows = database.prepare("SELECT number, added_by, file_bytes FROM build ORDER BY number");
  if (!rows) return failed(rows.error());
  auto add = database.prepare(std::string("INSERT INTO build(") + kBuildColumns +
                              ") VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9)");
  if (!add) return failed(add.error());
  auto remove = database.prepare("DELETE FROM build WHERE number = ?1");
  if (!remove) return failed(remove.error());
  auto part =
      database.prepare("SELECT data, checksum FROM build_part WHERE content = ?1 AND part = ?2");
  if (!part) return failed(part.error());
  auto parts =
      database.prepare("SELECT part, checksum FROM build_part WHERE content = ?1 ORDER BY part");
  if (!parts) return failed(parts.error());
  auto all_parts = database.prepare("SELECT checksum FROM build_part");
  if (!all_parts) return failed(all_parts.error());
  auto part_sums = database.prepare(
      "SELECT CAST(coalesce(sum(length(data)), 0) AS BIGINT) FROM build_part WHERE content = ?1");
  if (!part_sums) return failed(part_sums.error());
  auto put_part = database.prepare(
      "INSERT INTO build_part(content, part, checksum, data) VALUES(?1, ?2, ?3, ?4)");
  if (!put_part) return failed(put_part.error());
  auto remove_part = database.prepare("DELETE FROM build_part WHERE content = ?1 AND part = ?2");
  if (!remove_part) return failed(remove_part.error());
  auto unused = database.prepare(
      "SELECT DISTINCT content FROM build_part WHERE content NOT IN (SELECT content FROM build)");
  if (!unused) return failed(unused.error());
  auto used = database.prepare("SELECT 1 FROM build WHERE content = ?1");
  if (!used) return failed(used.error());
  return BuildTable(
      database.file(),
      {*std::move(find), *std::move(one), *std::move(rows), *std::move(add), *std::move(remove),
       *std::move(part), *std::move(parts), *std::move(all_parts), *std::move(part_sums),
       *std::move(put_part), *std::move(remove_part), *std::move(unused), *std::move(used)});
}

Unexpected<StoreError> BuildTable::corrupt(std::string where, std::string what) const {
  return {{StoreError::Kind::corrupt, file_, std::move(where), std::move(what)}};
}

StoreResult<StoredBuild> BuildTable::build_of(const sql::Statement& row) const {
  const BuildRow found{row.integer(0), row.integer(1), row.integer(2), row.integer(3),
                       row.text(4),    row.text(5),    row.text(6),    row.blob(7)};
  auto record = decode_record(found.record);
  const LibraryChange* change = record ? library_change_of(record->edit) : nullptr;
  const AddBuild* add = change == nullptr ? nullptr : std::get_if<AddBuild>(change);
  if (row.integer(8) != build_checksum(found) || add == nullptr ||
      static_cast<std::int64_t>(record->version.seq) != found.number ||
      std::int64_t{record->op.author} != found.added_by ||
      static_cast<std::int64_t>(add->file_bytes) != found.file_bytes ||
      static_cast<std::int64_t>(add->content) != found.content) {
    return corrupt("build number=" + std::to_string(found.number), "checksum or encoding is wrong");
  }
  return StoredBuild{*std::move(record)};
}

StoreResult<std::vector<StoredBuild>> BuildTable::find(const LibraryQuery& query) {
  std::vector<Sequence> numbers;
  const std::string name = folded_name(query.name), author = folded_name(query.author);
  const std::string tag = query.tag.empty() ? "" : "\n" + folded_name(query.tag) + "\n";
  {
    const sql::ResetAtEnd reset_at_end(s_.find);
    s_.find.bind(1, static_cast<std::int64_t>(query.before))
        .bind(2, std::string_view(name))
        .bind(3, std::string_view(author))
        .bind(4, std::string_view(tag))
        .bind(5, static_cast<std::int64_t>(query.count_max));
    for (;;) {
      const auto more = s_.find.step();
      if (!more) return failed(more.error());
      if (!*more) break;
      numbers.push_back(static_cast<Sequence>(s_.find.integer(0)));
    }
  }
  std::vector<StoredBuild> builds;
  for (const Sequence number : numbers) {
    auto build = one(number);
    if (!build) return failed(build.error());
    if (*build) builds.push_back(**std::move(build));
  }
  return builds;
}

StoreResult<std::optional<StoredBuild>> BuildTable::one(Sequence number) {
  const sql::ResetAtEnd reset_at_end(s_.one);
  const auto found = s_.one.bind(1, static_cast<std::int64_t>(number)).step();
  if (!found) return failed(found.error());
  if (!*found) return std::optional<StoredBuild>();
  auto build = build_of(s_.one);
  if (!build) return failed(build.error());
  return std::optional<StoredBuild>(*std::move(build));
}

StoreResult<std::vector<LibraryRow>> BuildTable::rows() {
  const sql::ResetAtEnd reset_at_end(s_.rows);
  std::vector<LibraryRow> rows;
  for (;;) {
    const auto more = s_.rows.step();
    if (!more) return failed(more.error());
    if (!*more) return rows;
    rows.push_back({static_cast<Sequence>(s_.rows.integer(0)),
                    static_cast<AuthorId>(s_.rows.integer(1)),
                    static_cast<std::uint64_t>(s_.rows.integer(2))});
  }
}

StoreResult<void> BuildTable::read_from(const StoredBuild& build, std::uint64_t first,
                                        const EachPart& each) {
  const AddBuild& add = build.build();
  std::uint64_t left = add.file_bytes - std::min(add.file_bytes, first * kBuildPartBytes);
  for (auto part = static_cast<std::int64_t>(first); left > 0; ++part) {
    const std::string where = "build_part content=" + std::to_string(add.content) +
                              " part=" + std::to_string(part) + " of build " +
                              std::to_string(build.number());
    const sql::ResetAtEnd reset_at_end(s_.part);
    const auto found = s_.part.bind(1, static_cast<std::int64_t>(add.content)).bind(2, part).step();
    if (!found) return failed(found.error());
    if (!*found) return corrupt(where, "is missing");
    const ByteView data = s_.part.blob(0);
    if (s_.part.integer(1) != part_checksum(add.content, part, data) ||
        data.size() != std::min<std::uint64_t>(left, kBuildPartBytes))
      return corrupt(where, "checksum or length is wrong");
    left -= data.size();
    if (!each(data)) return {};
  }
  return {};
}

StoreResult<Bytes> BuildTable::piece(const StoredBuild& build, std::uint64_t offset,
                                     std::size_t bytes_max) {
  Bytes piece;
  std::uint64_t skipped = offset % kBuildPartBytes;  // of the first part
  const auto read = read_from(build, offset / kBuildPartBytes, [&](ByteView part) {
    part = part.subspan(static_cast<std::size_t>(std::min<std::uint64_t>(skipped, part.size())));
    skipped = 0;
    part = part.first(std::min(part.size(), bytes_max - piece.size()));
    piece.insert(piece.end(), part.begin(), part.end());
    return piece.size() < bytes_max;
  });
  if (!read) return failed(read.error());
  return piece;
}

StoreResult<bool> BuildTable::is_used(std::uint64_t content) {
  const sql::ResetAtEnd reset_at_end(s_.used);
  const auto found = s_.used.bind(1, static_cast<std::int64_t>(content)).step();
  if (!found) return failed(found.error());
  return *found;
}

StoreResult<std::uint64_t> BuildTable::content_bytes(std::uint64_t content) {
  const sql::ResetAtEnd reset_at_end(s_.part_sums);
  const auto found = s_.part_sums.bind(1, static_cast<std::int64_t>(content)).step();
  if (!found) return failed(found.error());
  return *found ? static_cast<std::uint64_t>(s_.part_sums.integer(0)) : 0;
}

StoreResult<void> BuildTable::add(const EditRecord& record, RowFold& fold) {
  const AddBuild& build = *std::get_if<AddBuild>(library_change_of(record.edit));
  const BuildWords words = words_of(build.info);
  const Bytes bytes = encode_record(record);
  const BuildRow row{static_cast<std::int64_t>(record.version.seq),
                     record.op.author,
                     static_cast<std::int64_t>(build.file_bytes),
                     static_cast<std::int64_t>(build.content),
                     words.name,
                     words.author,
                     words.tags,
                     bytes};
  const std::int64_t checksum = build_checksum(row);
  add_row(fold, checksum);
  return store_result(s_.add.bind(1, row.number)
                          .bind(2, row.added_by)
                          .bind(3, row.file_bytes)
                          .bind(4, row.content)
                          .bind(5, row.name)
                          .bind(6, row.author)
                          .bind(7, row.tags)
                          .bind(8, row.record)
                          .bind(9, checksum)
                          .run());
}

StoreResult<void> BuildTable::remove(Sequence number, RowFold& fold, RowFold& part_fold) {
  std::uint64_t content = 0;
  {
    const sql::ResetAtEnd reset_at_end(s_.one);
    const auto found = s_.one.bind(1, static_cast<std::int64_t>(number)).step();
    if (!found) return failed(found.error());
    if (!*found) return {};
    content = static_cast<std::uint64_t>(s_.one.integer(3));
    remove_row(fold, s_.one.integer(8));
  }
  if (auto removed = s_.remove.bind(1, static_cast<std::int64_t>(number)).run(); !removed)
    return failed(removed.error());
  return remove_parts(content, part_fold);
}

StoreResult<void> BuildTable::remove_parts(std::uint64_t content, RowFold& part_fold) {
  std::vector<std::pair<std::int64_t, std::int64_t>> parts;  // and their checksums
  {
    const sql::ResetAtEnd reset_at_end(s_.parts);
    s_.parts.bind(1, static_cast<std::int64_t>(content));
    for (;;) {
      const auto more = s_.parts.step();
      if (!more) return failed(more.error());
      if (!*more) break;
      parts.emplace_back(s_.parts.integer(0), s_.parts.integer(1));
    }
  }
  for (const auto& [part, checksum] : parts) {
    auto removed = s_.remove_part.bind(1, static_cast<std::int64_t>(content)).bind(2, part).run();
    if (!removed) return failed(removed.error());
    remove_row(part_fold, checksum);
  }
  return {};
}

StoreResult<void> BuildTable::put_part(std::uint64_t content, std::uint32_t part, ByteView data,
                                       RowFold& part_fold) {
  const std::int64_t checksum = part_checksum(content, part, data);
  {
    const sql::ResetAtEnd reset_at_end(s_.part);
    const auto found =
        s_.part.bind(1, static_cast<std::int64_t>(content)).bind(2, std::int64_t{part}).step();
    if (!found) return failed(found.error());
    if (*found) remove_row(part_fold, s_.part.integer(1));
  }
  auto removed =
      s_.remove_part.bind(1, static_cast<std::int64_t>(content)).bind(2, std::int64_t{part}).run();
  if (!removed) return failed(removed.error());
  add_row(part_fold, checksum);
  return store_result(s_.put_part.bind(1, static_cast<std::int64_t>(content))
                          .bind(2, std::int64_t{part})
                          .bind(3, checksum)
                          .bind(4, data)
                          .run());
}

StoreResult<void> BuildTable::remove_unused_parts(RowFold& part_fold) {
  std::vector<std::uint64_t> contents;
  {
    const sql::ResetAtEnd reset_at_end(s_.unused);
    for (;;) {
      const auto more = s_.unused.step();
      if (!more) return failed(more.error());
      if (!*more) break;
      contents.push_back(static_cast<std::uint64_t>(s_.unused.integer(0)));
    }
  }
  for (const std::uint64_t content : contents) {
    if (auto removed = remove_parts(content, part_fold); !removed) return removed;
  }
  return {};
}

StoreResult<BuildTable::Folds> BuildTable::check() {
  Folds folds;
  const auto all = rows();
  if (!all) return failed(all.error());
  const std::unique_ptr<XXH3_state_t, DigestDeleter> digest(XXH3_createState());
  for (const LibraryRow& row : *all) {
    std::optional<StoredBuild> build;
    {
      const sql::ResetAtEnd reset_at_end(s_.one);
      const auto found = s_.one.bind(1, static_cast<std::int64_t>(row.number)).step();
      if (!found) return failed(found.error());
      if (!*found) continue;  // a running server has removed it
      auto read_row = build_of(s_.one);
      if (!read_row) return failed(read_row.error());
      build = *std::move(read_row);
      add_row(folds.builds, s_.one.integer(8));
    }
    XXH3_64bits_reset(digest.get());
    const AddBuild& add = build->build();
    const auto read_all = read(*build, [&](ByteView data) {
      XXH3_64bits_update(digest.get(), data.data(), data.size());
      return true;
    });
    if (!read_all) return failed(read_all.error());
    if (XXH3_64bits_digest(digest.get()) != add.file_digest) {
      return corrupt("build number=" + std::to_string(row.number),
                     "its file is not the one that was added");
    }
  }
  const sql::ResetAtEnd reset_at_end(s_.all_parts);
  for (;;) {
    const auto more = s_.all_parts.step();
    if (!more) return failed(more.error());
    if (!*more) return folds;
    add_row(folds.parts, s_.all_parts.integer(0));
  }
}

}  // namespace runstone
