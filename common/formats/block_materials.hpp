// BlockMaterials: the materials that the blocks of a foreign world become. It is used in two
// passes, because the materials of a world are known before its first chunk: note() sees each
// piece, make_table() numbers the materials, and resolve() gives each piece its materials.
// Memory: the names and states of the blocks, at most kForeignBlockBytesMax.
#pragma once
#include <cstddef>
#include <map>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/formats/format.hpp"
#include "common/formats/material_map.hpp"
#include "common/materials/material_table.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// The maximum size of all names and states of a world. Real worlds have some 100 KB.
inline constexpr std::size_t kForeignBlockBytesMax = std::size_t{64} << 20;

class BlockMaterials {
 public:
  /// `keep_all` is that of Format::material_of. If `map` is not null, it must outlive the object,
  /// and the materials are those that it chooses.
  BlockMaterials(const Format& format, bool keep_all, const MaterialMap* map = nullptr)
      : format_(format), keep_all_(keep_all), map_(map) {}

  /// Notes the blocks that occur in a piece. Cost: O(runs + blocks log noted blocks).
  void note(const ForeignPiece& piece);

  /// Returns a table of the materials of all noted blocks that are not empty, ascending by name and
  /// states of the blocks. Id 0 is air. Blocks with materials of one name share the first one that
  /// the map did not choose, otherwise the first one. Fails with limit_exceeded if the table has no
  /// room, or if the blocks exceeded kForeignBlockBytesMax.
  Result<MaterialTable> make_table();
  /// Returns the rows of the map that applied. Requires make_table().
  const AppliedRows& applied() const { return applied_; }

  /// Returns the voxels of a piece with the ids of the table. Blocks that are not noted are empty.
  RunChunk resolve(const ForeignPiece& piece) const;

 private:
  const Format& format_;
  bool keep_all_;
  const MaterialMap* map_;
  AppliedRows applied_;
  std::map<ForeignBlock, Material> ids_;
  std::size_t bytes_ = 0;  // of the keys of ids_
};

}  // namespace runstone
