// log_gaps: makes the log of a repaired world continuous. A record with a GapEdit takes the
// sequence number of each lost record. If lost records added materials, a record that adds rows
// named lost_ID takes the place of such a gap, because voxels and later records refer to the ids.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "common/core/ids.hpp"
#include "common/edits/descriptor/added_materials.hpp"
#include "common/edits/descriptor/edit_record.hpp"
#include "common/sql/database.hpp"
#include "server/repair/page_file.hpp"
#include "server/repair/world_scan.hpp"
#include "server/store/log_reader.hpp"

namespace runstone {

/// The columns of a lost record that are known. They come from the indexes of the log, which have
/// no checksums, so they may be wrong.
struct LostRecord {
  AuthorId author = 0;         // 0: the server, or not known
  std::optional<Cause> cause;  // nullopt: not known
};

/// Deletes the records up to the head, which are in the base. Deletes also each doubtful record
///   - whose epoch is older than that of the record before it;
///   - whose epoch is newer than that of the record behind it;
///   - which is from a free page, if no record is behind it.
StoreResult<void> remove_misfits(sql::Database& database, const LogEnd& head,
                                 const std::map<Sequence, RowOrigin>& doubtful);

/// Returns rows, named lost_ID, for lost materials from the id `first` on. It returns those up to
/// `end`, not included, or as many as one record may have. Requires first < end.
AddedMaterials lost_materials(std::size_t first, std::size_t end);

/// Returns the sequences behind the head and up to `last` that the log lacks, ascending.
StoreResult<std::vector<Sequence>> lost_sequences(sql::Database& database, const LogEnd& head,
                                                  Sequence last);

/// Returns what the indexes of the damaged world say about lost records.
StoreResult<std::map<Sequence, LostRecord>> find_lost_records(sql::Database& database,
                                                              PageFile& pages,
                                                              const std::vector<Sequence>& lost);

/// Writes a record for each lost one, in the caller's transaction. `materials` is the number of
/// rows of the material table at the head; `instance` is the client instance of the new records.
/// Returns the number of materials that got a row in place of a lost one. Fails (corrupt) if the
/// lost records cannot have added the materials that are missing.
StoreResult<std::size_t> fill_gaps(sql::Database& database, const LogEnd& head,
                                   const std::vector<Sequence>& lost,
                                   const std::map<Sequence, LostRecord>& known,
                                   std::size_t materials, ClientInstance instance);

/// Calls `each` for all records of the log, ascending.
StoreResult<void> each_record(sql::Database& database,
                              const std::function<StoreResult<void>(const EditRecord&)>& each);

}  // namespace runstone
