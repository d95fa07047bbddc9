#include "client/tools/symmetry.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include "client/tools/build_words.hpp"
#include "client/tools/merge_edits.hpp"
#include "client/tools/pattern_work.hpp"
#include "client/tools/turned_materials.hpp"
#include "common/builds/build_transforms.hpp"

namespace runstone {
namespace {

std::int32_t& along(VoxelPos& at, Axis axis) {
  return axis == Axis::x ? at.x : axis == Axis::y ? at.y : at.z;
}

/// The mirrored materials of one action, each looked up once.
class MirroredMaterials {
 public:
  explicit MirroredMaterials(const MaterialTable& table) : table_(table) {}
  /// Returns the mirrored form, or the material itself if it has none.
  Material mirrored(Material material, Axis axis) {
    const auto [at, is_new] = known_.try_emplace({material, axis}, material);
    if (is_new) {
      const auto now = turned_material(material, Orientation{}.mirrored(axis), table_);
      at->second = now.value_or(material);
    }
    return at->second;
  }
  /// Returns the mirrored form of a clipboard of one descriptor, without moving its cells.
  const std::shared_ptr<const Clipboard>& mirrored(
      const std::shared_ptr<const Clipboard>& clipboard, Axis axis) {
    auto& form = clipboards_[{clipboard, axis}];
    if (!form) form = with_turned_materials(clipboard, Orientation{}.mirrored(axis), table_);
    return form;
  }

 private:
  const MaterialTable& table_;
  std::map<std::pair<Material, Axis>, Material> known_;
  std::map<std::pair<std::shared_ptr<const Clipboard>, Axis>, std::shared_ptr<const Clipboard>>
      clipboards_;
};

struct Mirror {
  Axis axis;
  std::int32_t centre2;
  MirroredMaterials& materials;

  void turn(VoxelPos& at) const { along(at, axis) = centre2 - along(at, axis); }
  void operator()(SetVoxel& s) const { turn(s.at); }
  void operator()(FillBox& s) const {
    std::int32_t& low = along(s.box.min, axis);
    std::int32_t& end = along(s.box.max, axis);
    low = std::exchange(end, centre2 - low + 1);
    low = centre2 - low + 1;
  }
  void operator()(FillSphere& s) const { turn(s.centre); }
  void operator()(FillStroke& s) const {
    for (VoxelPos& point : s.points) turn(point);
  }
  void operator()(Paste& s) const {
    const auto sides = s.orientation.rotated(s.clipboard->extent()).sides();
    std::int32_t& low = along(s.at, axis);
    low = centre2 - (low + sides[static_cast<std::size_t>(axis)] - 1);
    // An orientation turns cells, not materials: these are as they lie in the world.
    s.clipboard = materials.mirrored(s.clipboard, axis);
    s.orientation = s.orientation.mirrored(axis);
  }
  void operator()(RightsEdit&) const {}
  void operator()(MaterialsEdit&) const {}
  void operator()(LibraryEdit&) const {}
  void operator()(ShapesEdit&) const {}
  void operator()(TextureEdit&) const {}
  void operator()(ClockEdit&) const {}
  void operator()(GapEdit&) const {}
};

/// Appends an edit unless it has the voxels of another one. A copy onto itself has, although its
/// material may be mirrored.
void append_new(std::vector<EditDescriptor>& to, EditDescriptor edit) {
  const bool is_known = std::any_of(
      to.begin(), to.end(), [&](const EditDescriptor& other) { return other.shape == edit.shape; });
  if (!is_known) to.push_back(std::move(edit));
}

EditDescriptor mirrored_with(MirroredMaterials& materials, const EditDescriptor& edit, Axis axis,
                             std::int32_t centre2) {
  EditDescriptor out = edit;
  std::visit(Mirror{axis, centre2, materials}, out.shape);
  out.material = materials.mirrored(out.material, axis);
  out.mask.material = materials.mirrored(out.mask.material, axis);
  return out;
}

}  // namespace

EditDescriptor mirrored(const EditDescriptor& edit, Axis axis, std::int32_t centre2,
                        const MaterialTable& materials) {
  MirroredMaterials forms(materials);
  return mirrored_with(forms, edit, axis, centre2);
}

std::vector<EditDescriptor> with_copies(std::vector<EditDescriptor> edits, const Symmetry& symmetry,
                                        const MaterialTable& materials) {
  if (symmetry.kind == SymmetryKind::none) return edits;
  MirroredMaterials forms(materials);
  const auto in_x = [&](const EditDescriptor& e) {
    return mirrored_with(forms, e, Axis::x, symmetry.centre2_x);
  };
  const auto in_z = [&](const EditDescriptor& e) {
    return mirrored_with(forms, e, Axis::z, symmetry.centre2_z);
  };
  std::vector<EditDescriptor> out;
  for (const EditDescriptor& edit : edits) {
    append_new(out, edit);
    const SymmetryKind kind = symmetry.kind;
    if (kind == SymmetryKind::x || kind == SymmetryKind::both) append_new(out, in_x(edit));
    if (kind == SymmetryKind::z || kind == SymmetryKind::both) append_new(out, in_z(edit));
    if (kind == SymmetryKind::point || kind == SymmetryKind::both)
      append_new(out, in_x(in_z(edit)));
  }
  return merge_edits(std::move(out));
}

Result<BuildPtr> MirroredBuilds::mirrored(const BuildPtr& build, bool along_x, bool along_z,
                                          const MaterialTable& materials) {
  if (build != build_) {
    forget();
    build_ = build;
  }
  BuildPtr& form = forms_[(along_x ? 1U : 0U) + (along_z ? 2U : 0U)];
  if (!form) {
    Orientation orientation;
    if (along_x) orientation = orientation.mirrored(Axis::x);
    if (along_z) orientation = orientation.mirrored(Axis::z);
    auto made = turned(*build, orientation);
    if (!made) return failure(made.error());
    const TurnedMaterials now = turned_materials((*made)->palette(), orientation, materials);
    if (now.is_changed) made = with_materials(**made, now.ids);
    if (!made) return failure(made.error());
    form = *std::move(made);
  }
  return form;
}

std::vector<MirrorAxes> copies_of(SymmetryKind kind) {
  switch (kind) {
    case SymmetryKind::none:
      break;
    case SymmetryKind::x:
      return {{true, false}};
    case SymmetryKind::z:
      return {{false, true}};
    case SymmetryKind::both:
      return {{true, false}, {false, true}, {true, true}};
    case SymmetryKind::point:
      return {{true, true}};
  }
  return {};
}

VoxelPos mirrored_corner(VoxelPos at, VoxelPos sides, MirrorAxes axes, const Symmetry& symmetry) {
  if (axes.x) at.x = symmetry.centre2_x - (at.x + sides.x - 1);
  if (axes.z) at.z = symmetry.centre2_z - (at.z + sides.z - 1);
  return at;
}

Result<BuildPaste, std::string> mirrored(const BuildPaste& paste, MirrorAxes axes,
                                         const Symmetry& symmetry, MirroredBuilds& builds,
                                         const MaterialTable& materials) {
  auto build = builds.mirrored(paste.build, axes.x, axes.z, materials);
  if (!build) return failure(words_of(build.error()));
  BuildPaste copy = paste;
  const VoxelPos sides = paste.build->sides();
  copy.build = *std::move(build);
  copy.is_difference = false;
  copy.at = mirrored_corner(paste.at, sides, axes, symmetry);
  if (!is_in_world(copy.at, sides)) return failure("a mirrored copy reaches outside the world");
  return copy;
}

Result<ToolAction, std::string> with_copies(ToolAction action, const Symmetry& symmetry,
                                            MirroredBuilds& builds,
                                            const MaterialTable& materials) {
  ToolAction out(with_copies(std::move(action.edits), symmetry, materials));
  out.copied = std::move(action.copied);
  out.chosen = std::move(action.chosen);
  out.chosen_mode = action.chosen_mode;
  out.cleared = std::move(action.cleared);
  out.has_followers = action.has_followers && symmetry.kind == SymmetryKind::none;
  out.chain = action.chain;
  if (action.pattern) {
    auto pattern = with_symmetry(std::move(action.pattern), symmetry, materials);
    if (!pattern) return failure(pattern.error());
    out.pattern = *std::move(pattern);
  }
  for (const BuildPaste& paste : action.pastes) {
    out.pastes.push_back(paste);
    for (const MirrorAxes axes : copies_of(symmetry.kind)) {
      auto copy = mirrored(paste, axes, symmetry, builds, materials);
      if (!copy) return failure(copy.error());
      out.pastes.push_back(*std::move(copy));
    }
  }
  return out;
}

}  // namespace runstone
