#include "common/edits/descriptor/edit_descriptor.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <utility>

#include "common/edits/descriptor/placed_clipboard.hpp"

namespace runstone {
namespace {

bool inside_world(std::int64_t c) { return c >= -kWorldLimit && c < kWorldLimit; }

Result<void> validate_shape(const SetVoxel& shape) {
  if (!inside_world(shape.at.x) || !inside_world(shape.at.y) || !inside_world(shape.at.z)) {
    return fail(ErrorCode::bad_value, "voxel outside the world");
  }
  return {};
}

Result<void> validate_shape(const FillBox& shape) {
  const VoxelBox& b = shape.box;
  if (b.empty()) return fail(ErrorCode::bad_value, "box is empty");
  const std::array<std::array<std::int64_t, 2>, 3> ranges = {
      {{b.min.x, b.max.x}, {b.min.y, b.max.y}, {b.min.z, b.max.z}}};
  for (const auto& [first, end] : ranges) {
    if (!inside_world(first) || !inside_world(end - 1))
      return fail(ErrorCode::bad_value, "box reaches outside the world");
    if (end - first > kEditBoxSideMax) return fail(ErrorCode::limit_exceeded, "box side too long");
  }
  return {};
}

Result<void> validate_shape(const FillSphere& shape) {
  if (shape.radius > kEditRadiusMax)
    return fail(ErrorCode::limit_exceeded, "sphere radius too large");
  for (const std::int64_t c : {shape.centre.x, shape.centre.y, shape.centre.z}) {
    if (!inside_world(c - shape.radius) || !inside_world(c + shape.radius)) {
      return fail(ErrorCode::bad_value, "sphere reaches outside the world");
    }
  }
  return {};
}

Result<void> validate_shape(const FillStroke& shape) {
  if (shape.points.size() < 2)
    return fail(ErrorCode::bad_value, "stroke has fewer than two points");
  if (shape.points.size() > kStrokePointsMax) {
    return fail(ErrorCode::limit_exceeded, "stroke has too many points");
  }
  if (shape.radius == 0) return fail(ErrorCode::bad_value, "stroke radius is 0");
  if (shape.radius > kEditRadiusMax)
    return fail(ErrorCode::limit_exceeded, "stroke radius too large");
  const VoxelPos* before = nullptr;
  for (const VoxelPos& p : shape.points) {
    for (const std::int64_t c : {p.x, p.y, p.z}) {
      if (!inside_world(c - shape.radius) || !inside_world(c + shape.radius)) {
        return fail(ErrorCode::bad_value, "stroke reaches outside the world");
      }
    }
    if (before != nullptr) {
      if (p == *before) return fail(ErrorCode::bad_value, "stroke repeats a point");
      const auto step = std::max(
          {std::abs(p.x - before->x), std::abs(p.y - before->y), std::abs(p.z - before->z)});
      if (step > kStrokeStepMax) return fail(ErrorCode::limit_exceeded, "stroke step too long");
    }
    before = &p;
  }
  return {};
}

Result<void> validate_shape(const Paste& shape) {
  if (shape.clipboard == nullptr) return fail(ErrorCode::bad_value, "paste without a clipboard");
  if (!shape.orientation.valid()) return fail(ErrorCode::bad_value, "unknown orientation");
  // The position is checked first, so that the sums that follow cannot overflow.
  if (!validate_shape(SetVoxel{shape.at}))
    return fail(ErrorCode::bad_value, "paste lies outside the world");
  const VoxelBox box = box_of(shape);
  const VoxelPos last{box.max.x - 1, box.max.y - 1, box.max.z - 1};
  if (!validate_shape(SetVoxel{box.min}) || !validate_shape(SetVoxel{last})) {
    return fail(ErrorCode::bad_value, "paste reaches outside the world");
  }
  return {};
}

Result<void> validate_shape(const RightsEdit& shape) {
  if (shape.change == nullptr) return fail(ErrorCode::bad_value, "edit of rights without a change");
  return validate(*shape.change);
}

Result<void> validate_shape(const MaterialsEdit& shape) {
  if (shape.added == nullptr) return fail(ErrorCode::bad_value, "edit of materials without rows");
  return validate(*shape.added);
}

Result<void> validate_shape(const LibraryEdit& shape) {
  if (shape.change == nullptr)
    return fail(ErrorCode::bad_value, "edit of the library without a change");
  return validate(*shape.change);
}

Result<void> validate_shape(const ShapesEdit& shape) {
  if (shape.given == nullptr) return fail(ErrorCode::bad_value, "edit of shapes without rows");
  return validate(*shape.given);
}

Result<void> validate_shape(const TextureEdit& shape) {
  if (shape.given == nullptr)
    return fail(ErrorCode::bad_value, "edit of a texture without a picture");
  return validate(*shape.given);
}

Result<void> validate_shape(const ClockEdit& shape) {
  if (shape.time.day_ms >= kDayMs) return fail(ErrorCode::bad_value, "time is not one of a day");
  if (shape.time.rate > kTimeRateMax)
    return fail(ErrorCode::limit_exceeded, "rate of time is too high");
  return {};
}

Result<void> validate_shape(const GapEdit&) { return {}; }

void write_position(ByteWriter& w, VoxelPos p) {
  w.svarint(p.x);
  w.svarint(p.y);
  w.svarint(p.z);
}

void write_shape(ByteWriter& w, const SetVoxel& shape) { write_position(w, shape.at); }

void write_shape(ByteWriter& w, const FillBox& shape) {
  const VoxelBox& b = shape.box;
  write_position(w, b.min);
  w.varint(static_cast<std::uint64_t>(b.max.x - b.min.x - 1));
  w.varint(static_cast<std::uint64_t>(b.max.y - b.min.y - 1));
  w.varint(static_cast<std::uint64_t>(b.max.z - b.min.z - 1));
}

void write_shape(ByteWriter& w, const FillSphere& shape) {
  write_position(w, shape.centre);
  w.varint(shape.radius);
}

void write_shape(ByteWriter& w, const FillStroke& shape) {
  w.varint(shape.radius);
  w.varint(shape.points.size() - 2);
  write_position(w, shape.points.front());
  for (std::size_t i = 1; i < shape.points.size(); ++i) {
    const VoxelPos &a = shape.points[i - 1], &b = shape.points[i];
    write_position(w, {b.x - a.x, b.y - a.y, b.z - a.z});
  }
}

void write_shape(ByteWriter& w, const Paste& shape) {
  write_position(w, shape.at);
  w.u8(shape.orientation.to_byte());
  write_clipboard(w, *shape.clipboard);
}

void write_shape(ByteWriter& w, const RightsEdit& shape) {
  Bytes bytes;
  encode(*shape.change, bytes);
  w.bytes(bytes);
}

void write_shape(ByteWriter& w, const MaterialsEdit& shape) {
  write_added_materials(w, *shape.added);
}

void write_shape(ByteWriter& w, const LibraryEdit& shape) {
  write_library_change(w, *shape.change);
}

void write_shape(ByteWriter& w, const ShapesEdit& shape) { write_given_shapes(w, *shape.given); }

void write_shape(ByteWriter& w, const TextureEdit& shape) { write_given_texture(w, *shape.given); }

void write_shape(ByteWriter& w, const ClockEdit& shape) {
  w.varint(shape.time.day_ms);
  w.varint(shape.time.rate);
}

void write_shape(ByteWriter& w, const GapEdit& shape) {
  w.u8(shape.begins_era ? 1 : 0);
  w.varint(shape.author);
}

std::int32_t read_coordinate(ByteReader& r) {
  return static_cast<std::int32_t>(
      r.svarint_in(-kWorldLimit, kWorldLimit - 1, "coordinate outside the world"));
}

VoxelPos read_position(ByteReader& r) {
  VoxelPos p;
  p.x = read_coordinate(r);
  p.y = read_coordinate(r);
  p.z = read_coordinate(r);
  return p;
}

std::int32_t read_side(ByteReader& r) {
  return 1 + static_cast<std::int32_t>(r.varint_max(kEditBoxSideMax - 1, "box side too long"));
}

std::int32_t read_step(ByteReader& r) {
  return static_cast<std::int32_t>(
      r.svarint_in(-kStrokeStepMax, kStrokeStepMax, "stroke step too long"));
}

FillStroke read_stroke(ByteReader& r) {
  FillStroke shape;
  shape.radius =
      static_cast<std::uint16_t>(r.varint_max(kEditRadiusMax, "stroke radius too large"));
  const auto count = static_cast<std::size_t>(
      2 + r.varint_max(kStrokePointsMax - 2, "stroke has too many points"));
  VoxelPos at = read_position(r);
  if (!r.ok()) return shape;
  shape.points.reserve(count);
  shape.points.push_back(at);
  while (r.ok() && shape.points.size() < count) {
    at.x += read_step(r);
    at.y += read_step(r);
    at.z += read_step(r);
    shape.points.push_back(at);
  }
  return shape;
}

Paste read_paste(ByteReader& r) {
  Paste shape;
  shape.at = read_position(r);
  const auto orientation = Orientation::of_byte(r.u8());
  if (!orientation) {
    r.reject(ErrorCode::bad_value, "unknown orientation");
    return shape;
  }
  shape.orientation = *orientation;
  shape.clipboard = read_clipboard(r);
  return shape;
}

WorldTime read_world_time(ByteReader& r) {
  WorldTime time;
  time.day_ms = static_cast<std::uint32_t>(r.varint_max(kDayMs - 1, "time is not one of a day"));
  time.rate = static_cast<std::uint32_t>(r.varint_max(kTimeRateMax, "rate of time is too high"));
  return time;
}

GapEdit read_gap(ByteReader& r) {
  GapEdit gap;
  const std::uint8_t flags = r.u8();
  if (flags > 1) r.reject(ErrorCode::bad_value, "unknown flags of a gap");
  gap.begins_era = flags == 1;
  gap.author = static_cast<AuthorId>(
      r.varint_max(std::numeric_limits<AuthorId>::max(), "author exceeds 32 bits"));
  return gap;
}

Material read_material(ByteReader& r) {
  return static_cast<Material>(r.varint_max(0xffff, "material id exceeds 16 bits"));
}

bool is_kind(std::uint8_t tag) {
  switch (static_cast<EditKind>(tag)) {
    case EditKind::set_voxel:
    case EditKind::fill_box:
    case EditKind::fill_sphere:
    case EditKind::fill_stroke:
    case EditKind::paste:
    case EditKind::rights:
    case EditKind::materials:
    case EditKind::materials_with_looks:
    case EditKind::library:
    case EditKind::shapes:
    case EditKind::texture:
    case EditKind::clock:
    case EditKind::gap:
      return true;
  }
  return false;
}

EditShape read_shape(ByteReader& r, std::uint8_t tag) {
  switch (static_cast<EditKind>(tag)) {
    case EditKind::set_voxel:
      return SetVoxel{read_position(r)};
    case EditKind::fill_box: {
      FillBox shape;
      shape.box.min = read_position(r);
      shape.box.max.x = shape.box.min.x + read_side(r);
      shape.box.max.y = shape.box.min.y + read_side(r);
      shape.box.max.z = shape.box.min.z + read_side(r);
      return shape;
    }
    case EditKind::fill_sphere: {
      FillSphere shape;
      shape.centre = read_position(r);
      shape.radius =
          static_cast<std::uint16_t>(r.varint_max(kEditRadiusMax, "sphere radius too large"));
      return shape;
    }
    case EditKind::fill_stroke:
      return read_stroke(r);
    case EditKind::paste:
      return read_paste(r);
    case EditKind::rights:
      return RightsEdit{std::make_shared<const RightsChange>(read_rights_change(r))};
    case EditKind::materials:
      return MaterialsEdit{std::make_shared<const AddedMaterials>(read_added_materials(r, false))};
    case EditKind::materials_with_looks:
      return MaterialsEdit{std::make_shared<const AddedMaterials>(read_added_materials(r, true))};
    case EditKind::library:
      return LibraryEdit{std::make_shared<const LibraryChange>(read_library_change(r))};
    case EditKind::shapes:
      return ShapesEdit{std::make_shared<const GivenShapes>(read_given_shapes(r))};
    case EditKind::texture:
      return TextureEdit{std::make_shared<const GivenTexture>(read_given_texture(r))};
    case EditKind::clock:
      return ClockEdit{read_world_time(r)};
    case EditKind::gap:
      return read_gap(r);
  }
  return SetVoxel{};  // unknown tags were rejected before
}

}  // namespace

EditKind kind_of(const EditDescriptor& edit) {
  constexpr std::array<EditKind, std::variant_size_v<EditShape>> kKinds = {
      EditKind::set_voxel, EditKind::fill_box, EditKind::fill_sphere, EditKind::fill_stroke,
      EditKind::paste,     EditKind::rights,   EditKind::materials,   EditKind::library,
      EditKind::shapes,    EditKind::texture,  EditKind::clock,       EditKind::gap};
  const AddedMaterials* added = added_materials_of(edit);
  if (added != nullptr && has_looks(*added)) return EditKind::materials_with_looks;
  return kKinds[edit.shape.index()];
}

EditDescriptor rights_edit(RightsChange change) {
  return {RightsEdit{std::make_shared<const RightsChange>(std::move(change))}, {}, kEmpty};
}

EditDescriptor materials_edit(AddedMaterials added) {
  return {MaterialsEdit{std::make_shared<const AddedMaterials>(std::move(added))}, {}, kEmpty};
}

EditDescriptor library_edit(LibraryChange change) {
  return {LibraryEdit{std::make_shared<const LibraryChange>(std::move(change))}, {}, kEmpty};
}

EditDescriptor shapes_edit(GivenShapes given) {
  return {ShapesEdit{std::make_shared<const GivenShapes>(std::move(given))}, {}, kEmpty};
}

EditDescriptor texture_edit(GivenTexture given) {
  return {TextureEdit{std::make_shared<const GivenTexture>(std::move(given))}, {}, kEmpty};
}

EditDescriptor clock_edit(const WorldTime& time) { return {ClockEdit{time}, {}, kEmpty}; }

EditDescriptor gap_edit(const GapEdit& gap) { return {gap, {}, kEmpty}; }

Result<void> validate(const EditDescriptor& edit) {
  if (static_cast<std::uint8_t>(edit.mask.kind) >
      static_cast<std::uint8_t>(MaskKind::only_material)) {
    return fail(ErrorCode::bad_value, "unknown mask kind");
  }
  if (edit.mask.kind != MaskKind::only_material && edit.mask.material != kEmpty) {
    return fail(ErrorCode::bad_value, "mask material without an only_material mask");
  }
  if (std::holds_alternative<Paste>(edit.shape) && edit.material != kEmpty) {
    return fail(ErrorCode::bad_value, "paste with a material of its own");
  }
  if (!has_voxels(edit) && (edit.material != kEmpty || edit.mask != Mask{}))
    return fail(ErrorCode::bad_value, "edit without voxels with a mask or a material");
  return std::visit([](const auto& shape) { return validate_shape(shape); }, edit.shape);
}

Material material_max(const EditDescriptor& edit) {
  const Material own = std::max(edit.material, edit.mask.material);
  const auto* paste = std::get_if<Paste>(&edit.shape);
  return paste == nullptr ? own : std::max(own, paste->clipboard->palette().back());
}

void encode(const EditDescriptor& edit, Bytes& out) {
  RUNSTONE_ASSERT(validate(edit).has_value());
  ByteWriter w(out);
  w.u8(static_cast<std::uint8_t>(kind_of(edit)));
  w.u8(static_cast<std::uint8_t>(edit.mask.kind));
  if (edit.mask.kind == MaskKind::only_material) w.varint(edit.mask.material);
  w.varint(edit.material);
  std::visit([&w](const auto& shape) { write_shape(w, shape); }, edit.shape);
}

Bytes encode(const EditDescriptor& edit) {
  Bytes out;
  encode(edit, out);
  return out;
}

Result<EditDescriptor> decode_descriptor(ByteView in) {
  ByteReader r(in);
  EditDescriptor edit;
  const std::uint8_t tag = r.u8();
  if (!is_kind(tag)) {
    r.reject(ErrorCode::unknown_kind, "unknown edit kind");
  }
  // The bound of the kind is checked before the rest is read; a record has room for more.
  if (r.ok() && in.size() > descriptor_bytes_max(static_cast<EditKind>(tag)))
    r.reject(ErrorCode::limit_exceeded, "descriptor too long");
  const std::uint8_t mask = r.u8();
  if (mask > static_cast<std::uint8_t>(MaskKind::only_material)) {
    r.reject(ErrorCode::unknown_kind, "unknown mask kind");
  }
  if (r.ok()) {
    edit.mask.kind = static_cast<MaskKind>(mask);
    if (edit.mask.kind == MaskKind::only_material) edit.mask.material = read_material(r);
    edit.material = read_material(r);
    edit.shape = read_shape(r, tag);
  }
  if (const auto done = r.finish(); !done) return failure(done.error());
  if (const auto valid = validate(edit); !valid) return failure(valid.error());
  return edit;
}

Result<EditDescriptor> decode_voxel_edit(ByteView in) {
  // By the kind alone, because the rest of such an edit costs time to check.
  if (!in.empty() && in[0] >= static_cast<std::uint8_t>(EditKind::rights) &&
      in[0] <= static_cast<std::uint8_t>(EditKind::gap))
    return fail(
        ErrorCode::unknown_kind,
        "a change of rights, materials, shapes, textures, the library or the clock, or a gap, is "
        "no edit of voxels");
  return decode_descriptor(in);
}

}  // namespace runstone
