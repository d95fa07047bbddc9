// RepairReport: the damage that a repair found, the rows that it lost or took from elsewhere, and
// their places. Its text is for the host.
#pragma once
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"

namespace runstone {

/// A record of the log that is gone.
struct GoneEdit {
  Sequence seq = 0;
  AuthorId author = 0;         // 0: the server, or not known
  std::optional<Cause> cause;  // nullopt: not known
  // The times of the records around it. UTC.
  TimeUs from_us = 0, until_us = 0;
  std::optional<VoxelBox> box;  // of its damaged row, which may be wrong; nullopt: not known
};

/// A chunk whose voxels come from a snapshot, because the log lacks edits that it shows.
struct KeptGround {
  ChunkKey key;
  std::uint64_t voxels = 0;
};

struct RepairReport {
  std::vector<std::string> damage;  // one line each
  std::uint64_t records = 0;        // of the log that were found
  std::uint64_t records_from_backup = 0;
  std::vector<GoneEdit> lost;
  std::size_t materials_made = 0;  // rows in place of lost ones
  std::vector<KeptGround> ground;
  std::vector<std::string> taken;   // from the backup, one line for each table
  std::vector<std::string> losses;  // of other tables than the log, one line each
  Epoch epoch = 0;                  // of the repaired world
};

/// Prints the report. `edge` is that of the chunks.
void print(const RepairReport& report, std::int32_t edge, std::ostream& out);

}  // namespace runstone
