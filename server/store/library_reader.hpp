// LibraryReader: the library of builds of a stored world. A build is the record that added it, and
// the bytes of its .rsb in parts (docs/builds.md).
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/ids.hpp"
#include "common/edits/descriptor/edit_record.hpp"
#include "server/store/store_error.hpp"
#include "server/world/environment/library_rows.hpp"

namespace runstone {

/// A build of the library.
struct StoredBuild {
  EditRecord record;  // that added it; its change is an AddBuild

  Sequence number() const { return record.version.seq; }
  const AddBuild& build() const { return *std::get_if<AddBuild>(library_change_of(record.edit)); }
};

/// A choice of builds. A build is chosen if it fits all that is given.
struct LibraryQuery {
  std::string name;                // a part of the name, or empty. Case does not matter
  std::string author;              // a part of the author's name, or empty. Case does not matter
  std::string tag;                 // a whole tag, or empty. Case does not matter
  Sequence before = kSequenceMax;  // only builds with a lower number
  std::size_t count_max = 20;
};

/// Takes the next bytes of a file. Returns false to stop.
using EachPart = std::function<bool(ByteView)>;

class LibraryReader {
 public:
  virtual ~LibraryReader() = default;

  /// Returns the chosen builds, newest first, at most query.count_max. Cost: O(builds) small rows,
  /// without their files.
  virtual StoreResult<std::vector<StoredBuild>> builds(const LibraryQuery& /*query*/) {
    return std::vector<StoredBuild>();
  }
  /// Returns a build, or nullopt if the library has none of this number.
  virtual StoreResult<std::optional<StoredBuild>> build(Sequence /*number*/) {
    return std::optional<StoredBuild>();
  }
  /// Calls `each` for the parts of the file of a build, in order. Fails (corrupt) if a part is
  /// missing or damaged; the parts before it were sound.
  virtual StoreResult<void> read_build(const StoredBuild& /*build*/, const EachPart& /*each*/) {
    return {};
  }
  /// Returns `bytes_max` bytes of the file of a build from `offset` on, or those up to the end of the
  /// file. Requires offset < file_bytes. Reads no part before them. Fails (corrupt) if a part of them
  /// is missing or damaged.
  virtual StoreResult<Bytes> read_build_piece(const StoredBuild& /*build*/,
                                              std::uint64_t /*offset*/, std::size_t /*bytes_max*/) {
    return Bytes();
  }
  /// Returns all builds, ascending by number. Fails (corrupt) if a row is missing.
  virtual StoreResult<std::vector<LibraryRow>> library_rows() { return std::vector<LibraryRow>(); }
};

}  // namespace runstone
