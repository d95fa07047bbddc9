#include "server/history/voxels_at.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "common/core/assert.hpp"
#include "common/runs/cut.hpp"
#include "common/runs/dense.hpp"
#include "common/runs/reorder.hpp"

namespace runstone {
namespace {

struct BoxSides {
  std::size_t x, y, z;
};

BoxSides sides_of(const VoxelBox& box) {
  return {static_cast<std::size_t>(box.max.x - box.min.x),
          static_cast<std::size_t>(box.max.y - box.min.y),
          static_cast<std::size_t>(box.max.z - box.min.z)};
}

/// Writes the voxels of a part of the box. `line_step` is the distance in the array from a line of
/// the part to the next line with the same x, and `layer_step` that to the next x.
void write_part(const RunChunk& part, Material* first, std::size_t line_step,
                std::size_t layer_step) {
  const OrderedExtent e = ordered(part.extent, AxisOrder::zyx);
  if (part.is_uniform()) {
    for (std::uint32_t x = 0; x < e.s; ++x) {
      for (std::uint32_t y = 0; y < e.m; ++y)
        std::fill_n(first + x * layer_step + y * line_step, e.f, part.runs.material(0));
    }
    return;
  }
  const RunChunk lines = part.order == AxisOrder::zyx ? part : reorder(part, AxisOrder::zyx);
  lines.runs.visit([&](auto runs) {
    std::size_t run = 0;
    std::uint32_t line_begin = 0;
    for (std::uint32_t x = 0; x < e.s; ++x) {
      for (std::uint32_t y = 0; y < e.m; ++y, line_begin += e.f) {
        Material* out = first + x * layer_step + y * line_step;
        const std::uint32_t line_end = line_begin + e.f;
        for (std::uint32_t at = line_begin; at < line_end;) {
          const std::uint32_t stop = std::min(runs.end(run), line_end);
          out = std::fill_n(out, stop - at, runs.material(run));
          at = stop;
          if (at == runs.end(run)) ++run;
        }
      }
    }
  });
}

/// The work of several threads on one box: they take one chunk after another.
class BoxReading {
 public:
  BoxReading(const WorldAt& world, std::int32_t edge, const VoxelBox& box, std::span<Material> out)
      : world_(world),
        edge_(edge),
        box_(box),
        sides_(sides_of(box)),
        out_(out),
        first_(chunk_of(box.min, edge)) {
    const ChunkCoord last = chunk_of({box.max.x - 1, box.max.y - 1, box.max.z - 1}, edge);
    count_y_ = static_cast<std::size_t>(last.y - first_.y) + 1;
    count_z_ = static_cast<std::size_t>(last.z - first_.z) + 1;
    count_ = (static_cast<std::size_t>(last.x - first_.x) + 1) * count_y_ * count_z_;
  }

  std::size_t count() const { return count_; }

  /// Reads chunks until none is left or a reader failed.
  void work(WorldReader& reader) {
    auto outcome = reader.begin_reads();
    if (outcome) {
      outcome = read_chunks(reader);
      const auto ended = reader.end_reads();
      if (outcome) outcome = ended;
    }
    if (outcome) return;
    next_.store(count_);
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = outcome.error();
  }

  StoreResult<void> outcome() const {
    if (error_) return failure(*error_);
    return {};
  }

 private:
  StoreResult<void> read_chunks(WorldReader& reader) {
    ReplayScratch scratch;
    for (std::size_t i = next_++; i < count_; i = next_++) {
      const ChunkCoord at{first_.x + static_cast<std::int32_t>(i / count_z_ / count_y_),
                          first_.y + static_cast<std::int32_t>(i / count_z_ % count_y_),
                          first_.z + static_cast<std::int32_t>(i % count_z_)};
      auto voxels = world_.voxels({0, at}, reader, scratch);
      if (!voxels) return failure(voxels.error());
      const VoxelBox inside = intersect(box_, box_of(at, edge_));
      const BoxSides part = sides_of(inside);
      const Extent extent{static_cast<std::uint8_t>(part.x), static_cast<std::uint8_t>(part.y),
                          static_cast<std::uint8_t>(part.z)};
      Material* const first =
          out_.data() + static_cast<std::size_t>(inside.min.z - box_.min.z) +
          sides_.z * (static_cast<std::size_t>(inside.min.y - box_.min.y) +
                      sides_.y * static_cast<std::size_t>(inside.min.x - box_.min.x));
      const bool is_whole = extent == voxels->extent;
      write_part(is_whole ? *std::move(voxels) : cut(*voxels, local_of(inside.min, edge_), extent),
                 first, sides_.z, sides_.z * sides_.y);
    }
    return {};
  }

  const WorldAt& world_;
  const std::int32_t edge_;
  const VoxelBox box_;
  const BoxSides sides_;
  const std::span<Material> out_;
  const ChunkCoord first_;
  std::size_t count_y_ = 0, count_z_ = 0, count_ = 0;
  std::atomic<std::size_t> next_{0};
  std::mutex mutex_;  // a leaf: guards the error
  std::optional<StoreError> error_;
};

}  // namespace

StoreResult<void> read_voxels(const WorldAt& world, std::span<WorldReader* const> readers,
                              const VoxelBox& box, std::span<Material> out) {
  RUNSTONE_ASSERT(!readers.empty() && !box.empty());
  const BoxSides sides = sides_of(box);
  RUNSTONE_ASSERT(out.size() == sides.x * sides.y * sides.z);
  count_dense_expansion();
  BoxReading reading(world, readers.front()->meta().chunk_edge, box, out);
  const std::size_t threads = std::min(readers.size(), reading.count());
  std::vector<std::thread> others;
  for (std::size_t i = 1; i < threads; ++i)
    others.emplace_back([&reading, reader = readers[i]] { reading.work(*reader); });
  reading.work(*readers.front());
  for (std::thread& other : others) other.join();
  return reading.outcome();
}

}  // namespace runstone
