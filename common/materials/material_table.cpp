#include "common/materials/material_table.hpp"

#include <cmath>
#include <functional>
#include <set>
#include <utility>

#include "common/materials/visibility_as_cube.hpp"
#include "common/shapes/shape_faces.hpp"

namespace runstone {
namespace {

constexpr const char* kTableIsFull = "more than 65536 materials";
constexpr const char* kNameIsTaken = "name is already taken";

const char* broken_rule(const SurfaceRule& rule) {
  constexpr double kReach = 10000;
  // The conditions are written so that a NaN fails.
  if (!(std::fabs(rule.elevation) <= kReach)) return "elevation must be within -10000 .. 10000";
  if (!(std::fabs(rule.distance) <= kReach)) return "distance must be within -10000 .. 10000";
  if (!(rule.frequency > 0 && rule.frequency <= 1))
    return "frequency must be above 0 and at most 1";
  return nullptr;
}

/// Checks the shapes of rows that are to have them together.
class ShapeCheck {
 public:
  /// `known` are the shapes of the table, and must outlive the object.
  explicit ShapeCheck(const std::set<Shape>& known) : known_(known) {}
  /// Fails for a shape that a row of this visibility must not have, and if there are too many
  /// different ones. A cube is no shape. The shape must outlive the object.
  Result<void> check(const Shape& shape, Visibility visibility) {
    if (shape == Shape{}) return {};
    if (visibility == Visibility::empty)
      return fail(ErrorCode::bad_value, "a material that is empty has no shape");
    if (known_.count(shape) != 0 || fresh_.count(&shape) != 0) return {};
    if (auto sound = check_shape(shape); !sound) return sound;
    if (known_.size() + fresh_.size() == kTableShapesMax)
      return fail(ErrorCode::limit_exceeded, "more than 4096 different shapes", kTableShapesMax);
    fresh_.insert(&shape);
    return {};
  }

 private:
  const std::set<Shape>& known_;
  std::set<const Shape*, ShapeBefore> fresh_;
};

}  // namespace

MaterialRow row_of(const MaterialInfo& info) {
  return {info.name, info.colour, info.visibility, info.body, info.look, info.shape};
}

MaterialTable::MaterialTable() {
  rows_.push_back({"air", {0, 0, 0, 0}, Visibility::empty, std::nullopt});
  ids_.emplace("air", kEmpty);
}

std::optional<Material> MaterialTable::find(std::string_view name) const {
  const auto found = ids_.find(name);
  if (found == ids_.end()) return std::nullopt;
  return found->second;
}

std::vector<Material> MaterialTable::family(std::string_view name) const {
  std::vector<Material> out;
  if (const auto bare = find(name)) out.push_back(*bare);
  for (const char mark : {'[', '{', '~'}) {
    const std::string begin = std::string(name) + mark;
    for (auto at = ids_.lower_bound(begin); at != ids_.end() && at->first.starts_with(begin); ++at)
      out.push_back(at->second);
  }
  return out;
}

Result<Material> MaterialTable::add(MaterialInfo info) {
  if (rows_.size() >= kMaterialCountMax) return fail(ErrorCode::limit_exceeded, kTableIsFull);
  if (const auto sound =
          validate_material(info.name, info.colour, info.visibility, info.body, info.look);
      !sound)
    return failure(sound.error());
  if (const auto sound = ShapeCheck(shapes_).check(info.shape, info.visibility); !sound)
    return failure(sound.error());
  if (info.generation) {
    if (const char* what = broken_rule(info.generation->surface))
      return fail(ErrorCode::bad_value, what);
    if (info.generation->reversed) {
      if (const char* what = broken_rule(*info.generation->reversed))
        return fail(ErrorCode::bad_value, what);
    }
  }
  const auto id = static_cast<Material>(rows_.size());
  if (!ids_.emplace(info.name, id).second) return fail(ErrorCode::bad_value, kNameIsTaken);
  if (!info.shape.is_cube()) shapes_.insert(info.shape);
  rows_.push_back(std::move(info));
  return id;
}

Result<void> MaterialTable::check_rows(std::span<const MaterialRow> rows) const {
  const std::size_t room = kMaterialCountMax - rows_.size();
  if (rows.size() > room) return fail(ErrorCode::limit_exceeded, kTableIsFull, room);
  std::set<std::string_view> names;
  ShapeCheck shapes(shapes_);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const MaterialRow& row = rows[i];
    if (const auto sound =
            validate_material(row.name, row.colour, row.visibility, row.body, row.look);
        !sound)
      return fail(sound.error().code, sound.error().what, i);
    if (const auto sound = shapes.check(row.shape, row.visibility); !sound)
      return fail(sound.error().code, sound.error().what, i);
    if (find(row.name) || !names.insert(row.name).second)
      return fail(ErrorCode::bad_value, kNameIsTaken, i);
  }
  return {};
}

Result<void> MaterialTable::append(Material first, std::span<const MaterialRow> rows) {
  if (first != rows_.size())
    return fail(ErrorCode::broken_invariant, "materials do not continue the table");
  if (auto sound = check_rows(rows); !sound) return sound;
  for (const MaterialRow& row : rows) {
    const auto added =
        add({row.name, row.colour, row.visibility, std::nullopt, row.body, row.look, row.shape});
    RUNSTONE_ASSERT(added.has_value());
  }
  return {};
}

Result<void> MaterialTable::check_given(std::span<const GivenShape> given) const {
  std::set<Material> materials;
  ShapeCheck shapes(shapes_);
  for (std::size_t i = 0; i < given.size(); ++i) {
    const auto& [material, shape] = given[i];
    if (!knows(material))
      return fail(ErrorCode::bad_value, "a shape is given to a material that does not exist", i);
    if (!rows_[material].shape.is_cube() || !materials.insert(material).second)
      return fail(ErrorCode::bad_value, "a shape is given to a material that has one", i);
    if (shape.is_cube()) return fail(ErrorCode::bad_value, "a given shape is a cube", i);
    if (const auto sound = shapes.check(shape, rows_[material].visibility); !sound)
      return fail(sound.error().code, sound.error().what, i);
  }
  return {};
}

Result<void> MaterialTable::give_shapes(std::span<const GivenShape> given) {
  if (auto sound = check_given(given); !sound) return sound;
  for (const auto& [material, shape] : given) {
    rows_[material].shape = shape;
    shapes_.insert(shape);
  }
  return {};
}

std::vector<Visibility> visibilities(const MaterialTable& table) {
  std::vector<Visibility> out;
  out.reserve(table.size());
  for (const MaterialInfo& row : table.rows()) out.push_back(row.visibility);
  return out;
}

std::vector<Visibility> cube_visibilities(const MaterialTable& table) {
  std::vector<Visibility> out = visibilities(table);
  for (std::size_t id = 0; id < out.size(); ++id) {
    if (!table[static_cast<Material>(id)].shape.is_cube()) out[id] = Visibility::empty;
  }
  return out;
}

std::vector<Visibility> half_filled_visibilities(const MaterialTable& table) {
  std::vector<Visibility> out;
  out.reserve(table.size());
  for (const MaterialInfo& row : table.rows())
    out.push_back(visibility_as_cube(row.visibility, row.shape));
  return out;
}

std::vector<Shape> shapes_of(const MaterialTable& table) {
  std::vector<Shape> out;
  out.reserve(table.size());
  for (const MaterialInfo& row : table.rows()) out.push_back(row.shape);
  return out;
}

}  // namespace runstone
