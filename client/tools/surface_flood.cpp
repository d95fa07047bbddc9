#include "client/tools/surface_flood.hpp"

#include <array>
#include <cstdlib>
#include <optional>

#include "client/tools/aim.hpp"
#include "client/tools/shown_voxels.hpp"

namespace runstone {
namespace {

constexpr std::int32_t kSide = 2 * kSurfaceReach + 1;

class Flood {
 public:
  Flood(const Replica& replica, VoxelPos start, const SurfaceFlood& flood)
      : voxels_(replica),
        start_(start),
        flood_(flood),
        seen_(std::size_t{1} * kSide * kSide * kSide) {}

  std::vector<VoxelPos> run() {
    material_ = voxels_.at(start_).value_or(kEmpty);
    visit(start_);
    for (std::size_t i = 0; i < found_.size() && found_.size() < flood_.voxels_max; ++i) {
      for (int d = 0; d < kDirectionCount; ++d) {
        const auto side = static_cast<Direction>(d);
        if (axis_of(side) != axis_of(flood_.face)) step_to(moved(found_[i], side, 1));
      }
    }
    return std::move(found_);
  }

 private:
  void step_to(VoxelPos beside) {
    if (visit(beside) || !flood_.follows_steps) return;
    if (!visit(moved(beside, flood_.face, 1))) visit(moved(beside, flood_.face, -1));
  }
  /// Returns true if the voxel belongs to the surface.
  bool visit(VoxelPos at) {
    const std::int32_t x = at.x - start_.x, y = at.y - start_.y, z = at.z - start_.z;
    if (std::abs(x) > kSurfaceReach || std::abs(y) > kSurfaceReach || std::abs(z) > kSurfaceReach)
      return false;
    if (!is_surface(at)) return false;
    const auto index = static_cast<std::size_t>(
        (x + kSurfaceReach) + kSide * ((y + kSurfaceReach) + kSide * (z + kSurfaceReach)));
    if (seen_[index] || found_.size() >= flood_.voxels_max) return true;
    seen_[index] = true;
    found_.push_back(at);
    return true;
  }
  bool is_surface(VoxelPos at) {
    const auto material = voxels_.at(at);
    if (!material || *material == kEmpty) return false;
    if (flood_.same_material && *material != material_) return false;
    return voxels_.at(moved(at, flood_.face, 1)) == std::optional<Material>(kEmpty);
  }

  ShownVoxels voxels_;
  const VoxelPos start_;
  const SurfaceFlood& flood_;
  Material material_ = kEmpty;
  std::vector<bool> seen_;  // by offset from the start
  std::vector<VoxelPos> found_;
};

}  // namespace

std::vector<VoxelPos> flood_surface(const Replica& replica, VoxelPos start,
                                    const SurfaceFlood& flood) {
  return Flood(replica, start, flood).run();
}

}  // namespace runstone
