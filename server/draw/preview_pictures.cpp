#include "server/draw/preview_pictures.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <set>
#include <system_error>
#include <utility>

#include "common/runs/span_boxes.hpp"
#include "server/draw/draw_child.hpp"
#include "server/draw/oblique_camera.hpp"
#include "server/history/world_at.hpp"

namespace runstone {
namespace {

constexpr PictureSize kSize{960, 540};
constexpr std::chrono::seconds kAnswerMax{20};
/// The number of chunks drawn around those that change, so that people recognise the place.
constexpr std::int32_t kLandAround = 2;
constexpr std::size_t kLandMax = 4096;  // chunks drawn around, at most

VoxelBox united(const VoxelBox& a, const VoxelBox& b) {
  return {{std::min(a.min.x, b.min.x), std::min(a.min.y, b.min.y), std::min(a.min.z, b.min.z)},
          {std::max(a.max.x, b.max.x), std::max(a.max.y, b.max.y), std::max(a.max.z, b.max.z)}};
}

/// Returns a box of a chunk in world coordinates.
VoxelBox in_world(const OrderedBox& box, AxisOrder order, VoxelPos origin) {
  const auto axes = axes_of(order);
  std::array<std::int32_t, 3> first = {origin.x, origin.y, origin.z}, last = first;
  for (std::size_t rank = 0; rank < 3; ++rank) {
    const auto axis = static_cast<std::size_t>(axes[rank]);
    last[axis] += static_cast<std::int32_t>(box.last[rank]);
    first[axis] += static_cast<std::int32_t>(box.first[rank]);
  }
  return {{first[0], first[1], first[2]}, {last[0], last[1], last[2]}};
}

}  // namespace

std::vector<ChunkKey> PreviewPictures::choose(const std::vector<ChunkKey>& changing) {
  are_too_many_ = changing.size() > kChunksMax;
  return are_too_many_ ? std::vector<ChunkKey>() : changing;
}

void PreviewPictures::add(const RestorePlan& plan) {
  if (are_too_many_) return;
  edge_ = plan.now.extent.x;
  changed_.push_back({plan.key, plan.now, plan.restored});
  const OrderedExtent extent = ordered(plan.now.extent, plan.now.order);
  for (const Difference& difference : plan.differences) {
    for_each_box(extent, difference.first, difference.last, [&](const OrderedBox& box) {
      const VoxelBox changed = in_world(box, plan.now.order, origin_of(plan.key.at, edge_));
      area_ = area_ ? united(*area_, changed) : changed;
    });
  }
}

std::string PreviewPictures::draw(WorldReader& reader, const Generator& generator,
                                  const std::string& name, const ShouldContinue& wanted) {
  if (are_too_many_) {
    return "no picture: more than " + std::to_string(kChunksMax) +
           " chunks would change; a smaller `box` can be drawn";
  }
  if (changed_.empty()) return "no picture: nothing would change";
  const auto drawn = draw_both(reader, generator, name, wanted);
  if (!drawn) return "no picture: " + drawn.error();
  return "pictures " + folder_ + "/" + name + "-before.png and " + name + "-after.png";
}

Result<void, std::string> PreviewPictures::draw_both(WorldReader& reader,
                                                     const Generator& generator,
                                                     const std::string& name,
                                                     const ShouldContinue& wanted) {
  std::error_code wrong;
  std::filesystem::create_directories(folder_, wrong);
  if (wrong) return failure(folder_ + ": cannot be made: " + wrong.message());
  auto child =
      DrawChild::start({.program = "", .answer_limit = kAnswerMax, .should_continue = wanted});
  if (!child) return failure(child.error());
  const auto materials = reader.materials();
  if (!materials) return failure(materials.error().message());
  if (auto sent = child->world(edge_, *materials); !sent) return sent;

  std::set<ChunkKey> changed, around;
  for (const ChangedChunk& chunk : changed_) changed.insert(chunk.key);
  for (const ChangedChunk& chunk : changed_) {
    for (std::int32_t dx = -kLandAround; dx <= kLandAround; ++dx) {
      for (std::int32_t dy = -1; dy <= 1; ++dy) {
        for (std::int32_t dz = -kLandAround; dz <= kLandAround; ++dz) {
          const ChunkCoord at = {chunk.key.at.x + dx, chunk.key.at.y + dy, chunk.key.at.z + dz};
          if (around.size() < kLandMax && !changed.contains({0, at})) around.insert({0, at});
        }
      }
    }
  }
  const auto last = reader.last_sequence();
  if (!last) return failure(last.error().message());
  auto world = WorldAt::open(reader, generator, *last,
                             [&](Sequence, Sequence) { return !wanted || wanted(); });
  if (!world) return failure(world.error().message());
  for (const ChunkKey& key : around) {
    const auto chunk = world->chunk(key);
    if (!chunk) return failure(chunk.error().message());
    if (auto sent = child->chunk(key, chunk->voxels); !sent) return sent;
  }
  const DrawCamera camera = oblique_camera(*area_, kSize);
  const auto picture = [&](const char* which,
                           RunChunk ChangedChunk::* state) -> Result<void, std::string> {
    for (const ChangedChunk& chunk : changed_) {
      if (auto sent = child->chunk(chunk.key, chunk.*state); !sent) return sent;
    }
    const auto drawn = child->draw(camera, kSize, folder_ + "/" + name + "-" + which + ".png");
    if (!drawn) return failure(drawn.error());
    return {};
  };
  if (auto drawn = picture("before", &ChangedChunk::now); !drawn) return drawn;
  if (auto drawn = picture("after", &ChangedChunk::restored); !drawn) return drawn;
  return child->finish();
}

}  // namespace runstone
