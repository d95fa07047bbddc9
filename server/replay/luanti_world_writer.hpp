// LuantiWorldWriter: makes the folder of a Luanti world: world.mt, map_meta.txt and map.sqlite, in
// the layout that every Luanti since 0.4 reads. Blocks are written one by one, so memory does not
// grow with the world. Where no block is, Luanti's map generator `singlenode` leaves air. Threads:
// one. It blocks on the disk.
#pragma once
#include <cstdint>
#include <iosfwd>
#include <memory>
#include <string>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/os/new_folder.hpp"
#include "common/sql/database.hpp"

namespace runstone {

/// The voxels that a map of Luanti has along each axis, from the first to the last one, both
/// inside: whole blocks inside its limit of 31,000.
inline constexpr std::int32_t kLuantiVoxelMin = -30'912, kLuantiVoxelMax = 30'927;

class LuantiWorldWriter {
 public:
  /// Begins a world. The folder is made as a NewFolder: an interrupted export leaves no world.
  /// `name` is shown in Luanti's list of worlds. The error is one line.
  static Result<LuantiWorldWriter, std::string> make(const std::string& folder,
                                                     const std::string& name, std::ostream& out);

  /// Writes a block of encode_luanti_block() at a position in blocks of 16. Requires that no block
  /// was written there.
  Result<void, std::string> put(ChunkCoord block, ByteView data);
  std::uint64_t blocks() const { return blocks_; }

  /// Completes the folder, which is on disk on return. Nothing may be called after that.
  Result<void, std::string> finish();

 private:
  LuantiWorldWriter(NewFolder folder, sql::Database map, sql::Statement insert);
  Unexpected<std::string> error(const sql::Error& error) const;

  NewFolder folder_;
  std::unique_ptr<sql::Database> map_;  // before its statement
  sql::Statement insert_;
  std::uint64_t blocks_ = 0;
};

}  // namespace runstone
