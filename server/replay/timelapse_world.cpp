#include "server/replay/timelapse_world.hpp"

#include <algorithm>
#include <string>

#include "common/core/assert.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"

namespace runstone {
namespace {

constexpr int kSurfaceDepth = 8;  // chunks below the surface of a column that are examined, at most
constexpr int kSamples = 5;       // points a side of a column where its surface is sampled

}  // namespace

StoreResult<TimelapseWorld> TimelapseWorld::open(WorldReader& reader, const Generator& generator,
                                                 Sequence from, Sequence to, std::uint32_t radius,
                                                 std::span<const ChunkCoord> eyes) {
  RUNSTONE_ASSERT(from <= to);
  auto start = WorldAt::open(reader, generator, from);
  if (!start) return failure(start.error());
  TimelapseWorld world(reader, generator, *std::move(start));
  world.at_ = from;
  if (const auto found = world.find_edits(to); !found) return failure(found.error());
  if (const auto set = world.set_stage(radius, eyes); !set) return failure(set.error());
  return world;
}

StoreResult<void> TimelapseWorld::find_edits(Sequence to) {
  const auto take = [this](const EditRecord& record) {
    // Protected ground is no edited place; it may reach through the whole world.
    if (!has_voxels(record.edit)) return true;
    edited_ = bounding_box(edited_, bounding_box(record.edit));
    for (const ChunkCoord& at : touched_chunks(record.edit, edge_)) edited_chunks_.insert({0, at});
    return true;
  };
  if (const auto read = reader_->read_log(at_ + 1, to, take); !read) return read;
  if (!edited_chunks_.empty()) return {};
  // Without edits the timelapse shows what was edited before.
  for (const ChunkKey& key : start_.edited()) {
    edited_chunks_.insert(key);
    edited_ = bounding_box(edited_, box_of(key.at, edge_));
  }
  return {};
}

StoreResult<void> TimelapseWorld::set_stage(std::uint32_t radius,
                                            std::span<const ChunkCoord> eyes) {
  const auto r = static_cast<std::int32_t>(radius);
  std::set<Column> columns;
  const auto add_columns = [&](ChunkCoord around) {
    for (std::int32_t x = around.x - r; x <= around.x + r; ++x) {
      for (std::int32_t z = around.z - r; z <= around.z + r; ++z) columns.insert({x, z});
    }
  };
  std::int32_t y_min = 0, y_max = 0;
  for (const ChunkKey& key : edited_chunks_) {
    add_around(key.at);
    add_columns(key.at);
    y_min = key == *edited_chunks_.begin() ? key.at.y : std::min(y_min, key.at.y);
    y_max = key == *edited_chunks_.begin() ? key.at.y : std::max(y_max, key.at.y);
    if (columns.size() > kChunksMax) return too_large();
  }
  for (const ChunkCoord& eye : eyes) add_columns(eye);
  if (columns.size() > kChunksMax) return too_large();
  for (const Column& column : columns) add_surface(column);
  // Earlier buildings may lie above the ground or below it.
  for (const ChunkKey& key : start_.edited()) {
    if (columns.contains({key.at.x, key.at.z})) add_around(key.at);
  }
  // No generator knows where the ground of an imported world is, so all chunks above and below the
  // edits are drawn.
  const auto has_base = reader_->has_base();
  if (!has_base) return failure(has_base.error());
  for (const auto& [x, z] : columns) {
    for (std::int32_t y = y_min - r; *has_base && y <= y_max + r; ++y) add_to_stage({x, y, z});
  }
  if (stage_.size() > kChunksMax) return too_large();
  return {};
}

/// Adds a chunk and its 26 neighbours: an edit can uncover faces of the neighbours.
void TimelapseWorld::add_around(ChunkCoord at) {
  for (int i = 0; i < 27; ++i)
    add_to_stage({at.x + i % 3 - 1, at.y + i / 3 % 3 - 1, at.z + i / 9 - 1});
}

void TimelapseWorld::add_to_stage(ChunkCoord at) {
  const std::int32_t reach = kWorldLimit / edge_;
  const auto inside = [reach](std::int32_t c) { return c >= -reach && c < reach; };
  if (inside(at.x) && inside(at.y) && inside(at.z)) stage_.insert({0, at});
}

/// Adds the chunks of a column that show untouched ground: from its highest voxel down to a chunk
/// that hides everything below.
void TimelapseWorld::add_surface(const Column& column) {
  const auto [x, z] = column;
  std::int32_t highest = generator_->y_min();
  for (std::int32_t i = 0; i < kSamples * kSamples; ++i) {
    const std::int32_t dx = (i % kSamples) * (edge_ - 1) / (kSamples - 1);
    const std::int32_t dz = (i / kSamples) * (edge_ - 1) / (kSamples - 1);
    highest = std::max(highest, generator_->surface_y(x * edge_ + dx, z * edge_ + dz));
  }
  const std::int32_t top = floor_div(highest - 1, edge_);
  for (std::int32_t y = top; y > top - kSurfaceDepth && (y + 1) * edge_ > generator_->y_min();
       --y) {
    add_to_stage({x, y, z});
    const RunChunk chunk = generator_->generate(origin_of({x, y, z}, edge_),
                                                Extent::cube(static_cast<unsigned>(edge_)));
    if (!chunk.is_uniform()) continue;
    const Material all = material_at(chunk, {0, 0, 0});
    if (reader_->meta().materials[all].visibility == Visibility::opaque) return;
  }
}

Unexpected<StoreError> TimelapseWorld::too_large() const {
  return {{StoreError::Kind::bad_request, reader_->file(), "",
           "the edits and the ground around them are more than " + std::to_string(kChunksMax) +
               " chunks: too many for a picture; choose a smaller --radius, "
               "or fewer edits by --from and --at"}};
}

VoxelBox TimelapseWorld::stage() const {
  VoxelBox box;
  for (const ChunkKey& key : stage_) box = bounding_box(box, box_of(key.at, edge_));
  return box;
}

StoreResult<void> TimelapseWorld::begin(const Each& each) {
  for (const ChunkKey& key : stage_) {
    auto chunk = start_.chunk(key);
    if (!chunk) return failure(chunk.error());
    if (!is_empty(chunk->voxels) && !each(key, chunk->voxels)) return {};
    if (edited_chunks_.contains(key))
      replayed_.emplace(key, ReplayedChunk(*std::move(chunk), origin_of(key.at, edge_)));
  }
  return {};
}

StoreResult<void> TimelapseWorld::advance(Sequence seq, const Each& each) {
  std::set<ChunkKey> touched;
  Sequence read_to = at_;
  const auto read = reader_->read_log(at_ + 1, seq, [&](const EditRecord& record) {
    for (const ChunkCoord& at : touched_chunks(record.edit, edge_)) {
      const ChunkKey key{0, at};
      replayed_.at(key).add(record.edit, record.version, scratch_);
      touched.insert(key);
    }
    read_to = record.version.seq;
    return true;
  });
  if (!read) return read;
  if (read_to != seq) {
    return failure(StoreError{StoreError::Kind::bad_request, reader_->file(), "edit_log",
                              "was shortened by retention while it was read; begin again"});
  }
  at_ = seq;
  for (const ChunkKey& key : touched) {
    ReplayedChunk& replayed = replayed_.at(key);
    replayed.flush(scratch_);
    if (replayed.take_changed() && !each(key, replayed.chunk().voxels)) return {};
  }
  return {};
}

}  // namespace runstone
