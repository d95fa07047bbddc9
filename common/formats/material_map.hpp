// MaterialMap: a person's choice of which materials of a source become which other materials. Each
// row has a pattern for materials of the source, and the name of the material that they become:
//   "minecraft:oak_planks" -> "planks"
//   "default:*"            -> "stone"   a * at the end stands for any rest
//   "minecraft:water"      -> "air"     the voxels become empty
// A material of the source is compared in these forms, in this order, and the first row that is
// equal to a form counts:
//   1. the name that it has in a world (world_name_of()): "minecraft:oak_stairs[facing=east]";
//   2. the name with all its states in brackets:
//      "minecraft:oak_stairs[facing=east,half=bottom,...]";
//   3. the name without states: "minecraft:oak_stairs".
// Otherwise the longest pattern with a * counts that form 2 begins with. Materials that are empty
// in the source stay empty, whatever the rows say.
#pragma once
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/material_row.hpp"
#include "common/core/result.hpp"
#include "common/formats/build_head.hpp"

namespace runstone {

struct MaterialMapRow {
  std::string from;  // the pattern, 1 .. kMaterialPatternBytesMax bytes
  std::string to;    // the name of a material; "air": empty
};
inline constexpr std::size_t kMaterialPatternBytesMax = 512;

/// The rows of a map that applied to a material, by number.
using AppliedRows = std::set<std::size_t>;

class MaterialMap {
 public:
  MaterialMap() = default;
  /// Fails with bad_value or limit_exceeded if a pattern is empty or too long, has a * before its
  /// end, or occurs twice, or if `to` is no name of a material. The offset of the error is the
  /// number of the row.
  static Result<MaterialMap> of(std::vector<MaterialMapRow> rows);

  std::span<const MaterialMapRow> rows() const { return rows_; }

  /// Returns the number of the row that applies to a material, or nullopt if none does. Cost:
  /// O(bytes * log rows).
  std::optional<std::size_t> find(const BuildMaterial& material) const;

  /// Returns the material that a material becomes, without states, and notes the row in `applied`.
  /// Returns nullopt if the material stays as it is: it is empty, or no row applies. The look is
  /// that of the built-in material of the new name, otherwise that of Minecraft's block of this
  /// name, otherwise that of `material`.
  std::optional<MaterialRow> apply(const BuildMaterial& material, AppliedRows& applied) const;

 private:
  std::vector<MaterialMapRow> rows_;
  std::map<std::string, std::size_t, std::less<>> exact_, beginnings_;  // number of the row
};

/// Returns the patterns of rows that applied to no material, such as `"a:b", "c:*" and 3 more`, or
/// an empty text.
std::string unused_rows_text(const MaterialMap& map, const AppliedRows& applied);

}  // namespace runstone
