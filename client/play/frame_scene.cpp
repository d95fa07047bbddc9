#include "client/play/frame_scene.hpp"

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <span>

#include "client/display/ground_marker.hpp"
#include "client/display/player_body.hpp"
#include "client/far/far_reach.hpp"
#include "common/materials/liquids.hpp"
#include "common/mesh/shapes/liquid_steps.hpp"

namespace runstone {
namespace {

/// Returns the outline of a box, `gap` voxels outside of it, so that it is drawn before the faces
/// of the box.
Marker outline_of(const VoxelBox& box, double gap, std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  return {box.min.x - gap,
          box.min.y - gap,
          box.min.z - gap,
          box.max.x - box.min.x + 2 * gap,
          box.max.y - box.min.y + 2 * gap,
          box.max.z - box.min.z + 2 * gap,
          r,
          g,
          b,
          false};
}

}  // namespace

double FrameScene::draw_distance() const {
  return (view_.radii().h + 1.5) * std::max(16, session_.replica().chunk_edge());
}

double FrameScene::reach() const {
  const Replica& replica = session_.replica();
  if (replica.far_tiles().solid_count() == 0) return draw_distance();
  return std::max(draw_distance(), far_reach(session_.view(), replica.chunk_edge()));
}

Camera FrameScene::camera(std::optional<double> field_of_view) const {
  Camera out = player_.camera(reach());
  if (reach() > draw_distance()) out.shadow_far = draw_distance();
  if (field_of_view) out.fov_y = *field_of_view * std::numbers::pi / 180;
  return out;
}

FrameContents FrameScene::contents(bool outlines_aim, bool shows_ground) const {
  FrameContents out;
  out.at_eye = material_at_eye();
  add_bodies(out.bodies);
  if (shows_ground) add_ground(out.markers);
  if (outlines_aim) add_aim(out.markers);
  add_selection(out.markers);
  for (const std::span<const GhostChunk> ghosts : {tool_.ghosts(), panels_.rollback().ghosts()})
    out.ghosts.insert(out.ghosts.end(), ghosts.begin(), ghosts.end());
  others_.append_ghosts(out.ghosts);
  others_.append_outlines(out.markers);
  return out;
}

Material FrameScene::material_at_eye() const {
  VoxelPos at = player_.voxel();
  const Material material = session_.replica().shown_at(at).value_or(kEmpty);
  const MaterialTable& materials = tool_.box().materials();
  if (!materials.knows(material) || !has_lowered_surface(materials[material])) return material;
  if (player_.eye().y - at.y < 1 - kLiquidDrop / 16.0) return material;
  // The eye may be above the surface, in the part of the voxel that is not filled.
  ++at.y;
  const Material above = session_.replica().shown_at(at).value_or(kEmpty);
  const bool is_covered = above == material || (materials.knows(above) &&
                                                materials[above].visibility == Visibility::opaque &&
                                                materials[above].shape.is_cube());
  return is_covered ? material : kEmpty;
}

void FrameScene::add_bodies(std::vector<Body>& bodies) const {
  for (const auto& [author, pose] : panels_.poses()) {
    if (const auto body = player_body(author, pose, player_.eye())) bodies.push_back(*body);
  }
}

void FrameScene::add_ground(std::vector<Marker>& markers) const {
  const Replica& replica = session_.replica();
  if (replica.past()) return;
  for (const auto& [seq, box] : replica.ground().boxes()) {
    if (const auto outline = ground_marker(box, player_.eye(), draw_distance()))
      markers.push_back(*outline);
  }
}

void FrameScene::add_aim(std::vector<Marker>& markers) const {
  const auto hit = tool_.pick();
  if (!hit) return;
  constexpr double kGap = 0.002;
  const Marker voxel = outline_of(box_between(hit->voxel, hit->voxel), kGap, 20, 20, 20);
  if (tool_.shapes().is_cube(hit->material)) return markers.push_back(voxel);
  for (const ShapeBox& box : tool_.shapes()[hit->material].shape.boxes) {
    const auto place = [&](std::size_t axis) { return box.min[axis] / double{kShapeUnits}; };
    const auto size = [&](std::size_t axis) {
      return (box.max[axis] - box.min[axis]) / double{kShapeUnits} + 2 * kGap;
    };
    Marker of_box = voxel;
    of_box.x += place(0), of_box.y += place(1), of_box.z += place(2);
    of_box.size_x = size(0), of_box.size_y = size(1), of_box.size_z = size(2);
    markers.push_back(of_box);
  }
}

void FrameScene::add_selection(std::vector<Marker>& markers) const {
  constexpr double kGap = 0.01;
  for (const VoxelBox& box : tool_.box().selected().boxes.boxes())
    markers.push_back(outline_of(box, kGap, 60, 160, 255));
  for (const VoxelPos at : tool_.box().points())
    markers.push_back(outline_of(box_between(at, at), kGap, 255, 200, 60));
}

}  // namespace runstone
