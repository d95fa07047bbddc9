// The part of SqlStore that keeps the library of builds: docs/builds.md, "The library".
#include <utility>

#include "server/store/sql_result.hpp"
#include "server/store/sql_store.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {

StoreResult<void> SqlStore::open_library() {
  if (library_) return {};
  const auto rows = meta_table_.read_all();
  if (!rows) return failed(rows.error());
  if (!rows->contains(kBuildFoldKey)) return {};
  auto opened = BuildTable::open(database());
  if (!opened) return failed(opened.error());
  library_ = *std::move(opened);
  return {};
}

StoreResult<void> SqlStore::make_library() {
  if (library_) return {};
  if (auto made = add_tables_of_library(database()); !made) return made;
  if (auto put = put_library_folds({}, {}); !put) return put;
  if (auto raised = raise_format(kWorldFormatOfLibrary); !raised) return raised;
  auto opened = BuildTable::open(database());
  if (!opened) return failed(opened.error());
  library_ = *std::move(opened);
  is_library_new_ = true;
  return {};
}

StoreResult<void> SqlStore::put_library_folds(const RowFold& builds, const RowFold& parts) {
  if (auto put = meta_table_.put_fold(kBuildFoldKey, builds); !put) return put;
  return meta_table_.put_fold(kBuildPartFoldKey, parts);
}

StoreResult<void> SqlStore::save_build_part(std::uint64_t content, std::uint32_t part,
                                            ByteView data) {
  return write([&]() -> StoreResult<void> {
    const std::string where = "build_part content=" + std::to_string(content);
    if (data.empty() || data.size() > kBuildPartBytes)
      return refuse(where, "has a part of another length");
    if (auto made = make_library(); !made) return made;
    const auto is_used = library_->is_used(content);
    if (!is_used) return failed(is_used.error());
    if (*is_used) return refuse(where, "belongs to a build");
    auto parts = meta_table_.fold(kBuildPartFoldKey);
    if (!parts) return failed(parts.error());
    if (auto put = library_->put_part(content, part, data, *parts); !put) return put;
    return meta_table_.put_fold(kBuildPartFoldKey, *parts);
  });
}

StoreResult<void> SqlStore::remove_build_file(std::uint64_t content) {
  if (!library_) return {};
  return write([&]() -> StoreResult<void> {
    const auto is_used = library_->is_used(content);
    if (!is_used) return failed(is_used.error());
    if (*is_used) {
      return refuse("build_part content=" + std::to_string(content), "belongs to a build");
    }
    auto parts = meta_table_.fold(kBuildPartFoldKey);
    if (!parts) return failed(parts.error());
    if (auto removed = library_->remove_parts(content, *parts); !removed) return removed;
    return meta_table_.put_fold(kBuildPartFoldKey, *parts);
  });
}

StoreResult<void> SqlStore::apply_library(std::span<const EditRecord> records, bool is_history) {
  std::optional<RowFold> builds, parts;
  for (const EditRecord& record : records) {
    const LibraryChange* change = library_change_of(record.edit);
    if (change == nullptr) continue;
    // The log has a record that programs of format 6 do not know, whether its file is here or not.
    if (auto made = make_library(); !made) return made;
    if (!builds) {
      auto build_fold = meta_table_.fold(kBuildFoldKey);
      if (!build_fold) return failed(build_fold.error());
      auto part_fold = meta_table_.fold(kBuildPartFoldKey);
      if (!part_fold) return failed(part_fold.error());
      builds = *build_fold;
      parts = *part_fold;
    }
    if (const auto* remove = std::get_if<RemoveBuild>(change)) {
      if (auto removed = library_->remove(remove->number, *builds, *parts); !removed)
        return removed;
      continue;
    }
    const AddBuild& add = *std::get_if<AddBuild>(change);
    const auto bytes = library_->content_bytes(add.content);
    if (!bytes) return failed(bytes.error());
    const auto is_used = library_->is_used(add.content);
    if (!is_used) return failed(is_used.error());
    if (*bytes != add.file_bytes || *is_used) {
      if (is_history) continue;
      return refuse("build number=" + std::to_string(record.version.seq),
                    "its file is not in the world");
    }
    if (auto added = library_->add(record, *builds); !added) return added;
  }
  return builds ? put_library_folds(*builds, *parts) : StoreResult<void>{};
}

StoreResult<std::vector<StoredBuild>> SqlStore::builds(const LibraryQuery& query) {
  return at_one_moment<std::vector<StoredBuild>>([&]() -> StoreResult<std::vector<StoredBuild>> {
    if (auto opened = open_library(); !opened) return failed(opened.error());
    if (!library_) return std::vector<StoredBuild>();
    return library_->find(query);
  });
}

StoreResult<std::optional<StoredBuild>> SqlStore::build(Sequence number) {
  if (auto opened = open_library(); !opened) return failed(opened.error());
  if (!library_) return std::optional<StoredBuild>();
  return library_->one(number);
}

StoreResult<void> SqlStore::read_build(const StoredBuild& build, const EachPart& each) {
  if (auto opened = open_library(); !opened) return opened;
  if (!library_) return refuse("build", "the world has no library");
  return library_->read(build, each);
}

StoreResult<Bytes> SqlStore::read_build_piece(const StoredBuild& build, std::uint64_t offset,
                                              std::size_t bytes_max) {
  if (auto opened = open_library(); !opened) return failed(opened.error());
  if (!library_) return refuse("build", "the world has no library");
  return library_->piece(build, offset, bytes_max);
}

StoreResult<std::vector<LibraryRow>> SqlStore::library_rows() {
  return at_one_moment<std::vector<LibraryRow>>([&]() -> StoreResult<std::vector<LibraryRow>> {
    if (auto opened = open_library(); !opened) return failed(opened.error());
    if (!library_) return std::vector<LibraryRow>();
    auto rows = library_->rows();
    if (!rows) return rows;
    const auto fold = meta_table_.fold(kBuildFoldKey);
    if (!fold) return failed(fold.error());
    // The sum is that of whole rows, which check() reads.
    if (fold->count != rows->size()) {
      return failure(StoreError{
          StoreError::Kind::corrupt, file(), "build",
          std::to_string(rows->size()) + " rows, meta counts " + std::to_string(fold->count)});
    }
    return rows;
  });
}

StoreResult<void> SqlStore::check_library() {
  return at_one_moment<void>([&]() -> StoreResult<void> {
    if (auto opened = open_library(); !opened) return opened;
    if (!library_) return {};
    const auto found = library_->check();
    if (!found) return failed(found.error());
    if (auto sound = check_fold("build", found->builds); !sound) return sound;
    return check_fold("build_part", found->parts);
  });
}

StoreResult<void> SqlStore::accept_lost_builds(std::vector<std::string>& lost) {
  if (!library_) return {};
  const auto found = library_->check();
  if (!found) return failed(found.error());
  for (const auto& [table, fold] :
       {std::pair{"build", found->builds}, std::pair{"build_part", found->parts}}) {
    if (auto sound = check_fold(table, fold); !sound) {
      if (sound.error().may_pass()) return sound;
      lost.push_back(sound.error().message());
    }
  }
  return put_library_folds(found->builds, found->parts);
}

}  // namespace runstone
