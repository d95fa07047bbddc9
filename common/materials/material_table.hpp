// MaterialTable: the properties of each material id. It is a data file (TOML) like the thesis'
// table (7.4): row i describes id i. Rows are never removed, and rows may be appended. A row never
// changes, but it may get a shape once. Id 0 is always "air", empty.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/given_shape.hpp"
#include "common/core/ids.hpp"
#include "common/core/material_row.hpp"
#include "common/core/result.hpp"
#include "common/core/text_error.hpp"

namespace runstone {

class ShapeTable;

/// The layer of terrain that a generator makes of this material (thesis 7.4 and figure 7.21). Units
/// are voxels; frequency is cycles per voxel. The thesis' z is up; here y is up. The surface of a
/// column lies at distance + elevation * N, where N is a fractal noise in [-1, 1].
struct SurfaceRule {
  std::int32_t seed = 1;
  double elevation = 0;      // noise amplitude, -10000 .. 10000
  double distance = 0;       // mean height above sea level (y = 0), -10000 .. 10000
  double frequency = 0.007;  // 0 < f <= 1
  friend bool operator==(const SurfaceRule&, const SurfaceRule&) = default;
};

struct GenerationRule {
  SurfaceRule surface;                  // the material fills the column below this surface
  std::optional<SurfaceRule> reversed;  // if given, only above this one ("reversed surface")
  friend bool operator==(const GenerationRule&, const GenerationRule&) = default;
};

struct MaterialInfo {
  std::string name;  // as that of a MaterialRow
  MaterialColour colour{0, 0, 0, 255};
  Visibility visibility = Visibility::opaque;
  std::optional<GenerationRule> generation;
  MaterialBody body = MaterialBody::solid;
  std::optional<MaterialLook> look = std::nullopt;  // as that of a MaterialRow
  Shape shape = {};                                 // as that of a MaterialRow
  friend bool operator==(const MaterialInfo&, const MaterialInfo&) = default;
};

/// Returns the row without the rule of generation.
MaterialRow row_of(const MaterialInfo& info);

class MaterialTable {
 public:
  /// Makes a table with only air.
  MaterialTable();

  std::size_t size() const { return rows_.size(); }
  bool knows(Material id) const { return id < rows_.size(); }
  /// Requires knows(id).
  const MaterialInfo& operator[](Material id) const { return rows_[id]; }
  std::optional<Material> find(std::string_view name) const;
  /// Returns the materials whose name is `name`, or begins with it and one of the characters that
  /// precede states in a name, [ { and ~. Cost: O(log size + result).
  std::vector<Material> family(std::string_view name) const;
  std::span<const MaterialInfo> rows() const { return rows_; }
  /// Returns true if a row is no cube.
  bool has_shapes() const { return !shapes_.empty(); }

  /// Appends a row and returns its id. Fails with limit_exceeded if the table is full, and with
  /// bad_value for a bad or duplicate name, an opaque material with alpha below 255, a number or a
  /// look outside its range, or a shape that the material must not have (check_shape(), and none if
  /// it is empty). Fails with limit_exceeded for more than kTableShapesMax different shapes. Cost:
  /// O(log size), and that of check_shape() if no row has the shape.
  Result<Material> add(MaterialInfo info);
  /// Fails if the rows cannot be appended together: with limit_exceeded if the table has no room
  /// for all of them, and with bad_value for a bad row, or a name that is taken, by the table or by
  /// an earlier row, and for a shape as add() does. The error's offset is the number of the row.
  /// Cost: O(rows log size), and that of check_shape() for each shape that the table lacks.
  Result<void> check_rows(std::span<const MaterialRow> rows) const;
  /// Appends the rows, without generation rules; the first gets the id `first`. Fails as
  /// check_rows() does, and with broken_invariant if `first` is not size(); then nothing changes.
  Result<void> append(Material first, std::span<const MaterialRow> rows);

  /// Fails if the shapes cannot be given together: with bad_value if a material is unknown, empty,
  /// has a shape or occurs twice, if a shape is a cube or check_shape() fails for it, and with
  /// limit_exceeded for more than kTableShapesMax different shapes. The error's offset is the
  /// number of the entry. Cost: O(entries log size), and that of check_shape() for each shape that
  /// the table lacks.
  Result<void> check_given(std::span<const GivenShape> given) const;
  /// Gives rows a shape. Fails as check_given() does; then nothing changes.
  Result<void> give_shapes(std::span<const GivenShape> given);

  friend bool operator==(const MaterialTable&, const MaterialTable&) = default;

 private:
  std::vector<MaterialInfo> rows_;
  std::map<std::string, Material, std::less<>> ids_;  // row by name
  std::set<Shape> shapes_;                            // the different ones of the rows
};

/// Returns the visibility of each material by id, in the form of the mesher's VisibilityTable.
std::vector<Visibility> visibilities(const MaterialTable& table);
/// Returns the visibilities for the mesh of the cubes: materials with a shape are empty.
std::vector<Visibility> cube_visibilities(const MaterialTable& table);
/// Returns visibility_as_cube() of each material, for coarse levels of detail and maps. Cost:
/// O(boxes of the materials).
std::vector<Visibility> half_filled_visibilities(const MaterialTable& table);

/// Returns a number that stands for how the shapes of the table count in tiles and on maps: which
/// materials have one, and which of them fill at least half of a voxel. 0 if all are cubes. Cost:
/// that of half_filled_visibilities().
std::uint64_t tile_shapes_number(const MaterialTable& table);

/// Returns the shape of each material by id, as ShapeTable takes them.
std::vector<Shape> shapes_of(const MaterialTable& table);

/// Reads `[[material]]` tables in id order, air first. `file` is only for messages. Unknown keys
/// are errors. docs/materials.md lists the keys.
Result<MaterialTable, TextError> parse_material_table(std::string_view toml, std::string_view file);

/// A row of a file that adds materials, and the line where it begins.
struct MaterialFileRow {
  MaterialRow row;
  std::uint32_t line = 0;
};
/// Reads `[[material]]` tables for MaterialTable::append(). Air is not among them. Fails as
/// parse_material_table() does, and for a generation rule: a generator makes terrain of the
/// materials that its world was created with.
Result<std::vector<MaterialFileRow>, TextError> parse_material_rows(std::string_view toml,
                                                                    std::string_view file);

/// Returns the table as TOML, which parse_material_table() reads back to an equal table.
std::string to_toml(const MaterialTable& table);

/// Returns the built-in table: air, grass, sand, dirt, stone, water and the builders' palette.
const MaterialTable& default_material_table();
/// Returns the built-in table and, behind it, what grows in a landscape: trees, and plants with
/// their shapes. New worlds of the generator "landscape" have it.
const MaterialTable& landscape_material_table();

}  // namespace runstone
