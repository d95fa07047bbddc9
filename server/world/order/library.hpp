// Library: the builds of the world as the world strand knows them: who added each, and its size. The
// builds themselves are in the store (server/store/library_reader.hpp). It decides whether a build
// may be added.
// Thread: the world strand. Memory: some 60 bytes for each build.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "common/edits/descriptor/edit_record.hpp"
#include "server/world/environment/library_rows.hpp"
#include "server/world/environment/world_limits.hpp"

namespace runstone {

/// A number of builds, and the bytes of their files together.
struct LibraryTotal {
  std::uint64_t builds = 0, file_bytes = 0;
  friend bool operator==(const LibraryTotal&, const LibraryTotal&) = default;
};

class Library {
 public:
  /// `rows`: the builds at the start.
  Library(const LibraryLimits& limits, std::span<const LibraryRow> rows);

  /// Applies the changes of the library among records that were ordered just now. A removal of a
  /// build that does not exist changes nothing.
  void apply(std::span<const EditRecord> records);

  /// Returns why an author may not add a file of so many bytes, as a sentence that names the limit,
  /// its value and what to do, or nullopt. The limits of a player do not hold for the console
  /// (author 0).
  std::optional<std::string> refusal(AuthorId author, std::uint64_t file_bytes) const;
  /// Returns the row of a build, or null if there is none of this number.
  const LibraryRow* find(Sequence number) const;
  const LibraryLimits& limits() const { return limits_; }
  const LibraryTotal& total() const { return total_; }
  LibraryTotal total_of(AuthorId author) const;
  /// Returns the record that changed the library last in this run, or 0.
  Sequence newest() const { return newest_; }
  bool has_changed_ever() const { return !rows_.empty() || newest_ != 0; }
  /// Returns a content number that was never used in the world. Requires the epoch of this start.
  std::uint64_t next_content(Epoch epoch) { return std::uint64_t{epoch} << 32 | ++contents_; }

 private:
  void add(const LibraryRow& row);

  LibraryLimits limits_;
  std::map<Sequence, LibraryRow> rows_;
  std::map<AuthorId, LibraryTotal> author_totals_;
  LibraryTotal total_;
  Sequence newest_ = 0;
  std::uint32_t contents_ = 0;
};

}  // namespace runstone
