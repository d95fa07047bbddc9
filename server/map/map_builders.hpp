// MapBuilders: who built what at a column of voxels, newest first.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "common/edits/descriptor/edit_record.hpp"
#include "server/store/log_reader.hpp"

namespace runstone {

/// The number of edits that an answer has.
inline constexpr std::size_t kBuildersMax = 8;

/// Returns the newest edits up to `last` whose geometry has a voxel in the column (x, z), newest
/// first. Changes of rights are no edits of the column. Blocks on the disk.
StoreResult<std::vector<EditRecord>> newest_edits_of_column(LogReader& reader, std::int32_t x,
                                                            std::int32_t z, Sequence last);

/// Returns the newest edits of the world that changed voxels, newest first. Blocks on the disk.
StoreResult<std::vector<EditRecord>> newest_edits_of_world(LogReader& reader);

/// Returns the arguments of `runstone-server control` with which an operator sees what taking back
/// the edit would do: a preview for its author, its time and its box.
std::string undo_command(const EditRecord& record);

}  // namespace runstone
