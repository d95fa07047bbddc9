#include "common/builds/line_flood.hpp"

#include <algorithm>

#include "common/core/assert.hpp"
#include "common/runs/reorder.hpp"

namespace runstone {

std::optional<FloodFault> LineFlood::run(VoxelPos start) {
  RUNSTONE_ASSERT(start.y <= limits_.level);
  const ChunkCoord first = chunk_of(start, edge_);
  const LocalPos at = local_of(start, edge_);
  Lines* const lines = lines_of(first);
  if (lines == nullptr) return FloodFault::missing_chunk;
  const int x = at.x;
  reach(first, lines, at.y, at.z, x, x + 1);
  if (waiting_.empty()) return FloodFault::blocked;
  while (!waiting_.empty() && !fault_) {
    const Reached next = waiting_.back();
    waiting_.pop_back();
    spread(next);
  }
  return fault_;
}

/// Returns the lines of a chunk, or null if it is not known.
LineFlood::Lines* LineFlood::lines_of(ChunkCoord at) {
  const auto known = chunks_.find(at);
  if (known != chunks_.end()) return &known->second;
  const std::shared_ptr<const RunChunk> chunk = chunk_at_(at);
  if (!chunk) return nullptr;
  RUNSTONE_ASSERT(chunk->extent == Extent::cube(static_cast<unsigned>(edge_)));
  Lines& out = chunks_[at];
  if (chunk->order == AxisOrder::xyz) {
    read(*chunk, out);
  } else {
    read(reorder(*chunk, AxisOrder::xyz), out);
  }
  return &out;
}

/// Requires the order xyz.
void LineFlood::read(const RunChunk& chunk, Lines& out) const {
  const auto edge = static_cast<std::uint32_t>(edge_);
  out.begins.reserve(std::size_t{edge} * edge + 1);
  out.begins.push_back(0);
  const auto end_lines = [&](std::uint32_t count) {
    while (out.begins.size() <= count)
      out.begins.push_back(static_cast<std::uint32_t>(out.stretches.size()));
  };
  chunk.runs.visit([&](const auto& runs) {
    std::uint32_t begin = 0;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const std::uint32_t end = runs.end(i);
      const FloodPart part = part_of_(runs.material(i));
      if (part != FloodPart::stops) {
        for (std::uint32_t at = begin; at < end;) {
          const std::uint32_t line = at / edge, x = at - line * edge;
          const std::uint32_t last = std::min(end - line * edge, edge);
          end_lines(line);
          out.stretches.push_back({static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(last),
                                   part == FloodPart::taken, false});
          at = line * edge + last;
        }
      }
      begin = end;
    }
  });
  end_lines(edge * edge);
}

/// Marks the stretches of a line as reached that share a place of [first, last) along x.
void LineFlood::reach(ChunkCoord chunk, Lines* lines, std::int32_t y, std::int32_t z, int first,
                      int last) {
  const auto line = static_cast<std::size_t>(y + edge_ * z);
  for (std::uint32_t i = lines->begins[line]; i < lines->begins[line + 1]; ++i) {
    Stretch& s = lines->stretches[i];
    if (s.last <= first) continue;
    if (s.first >= last) break;
    if (std::exchange(s.is_reached, true)) continue;
    voxels_ += static_cast<std::uint64_t>(s.last - s.first);
    if (voxels_ > limits_.voxels_max) fault_ = FloodFault::too_many_voxels;
    if (s.is_taken) {
      const VoxelPos origin = origin_of(chunk, edge_);
      const VoxelPos low{origin.x + s.first, origin.y + y, origin.z + z};
      box_ = bounding_box(box_, {low, {origin.x + s.last, low.y + 1, low.z + 1}});
    }
    waiting_.push_back({chunk, lines, y, z, i});
  }
}

/// Marks the stretches beside a stretch as reached.
void LineFlood::spread(const Reached& from) {
  const Stretch s = from.lines->stretches[from.stretch];
  if (s.first != 0) {
    reach(from.chunk, from.lines, from.y, from.z, s.first - 1, s.first);
  } else {
    reach_beyond(from, Direction::neg_x, from.y, from.z, edge_ - 1, edge_);
  }
  if (s.last != edge_) {
    reach(from.chunk, from.lines, from.y, from.z, s.last, s.last + 1);
  } else {
    reach_beyond(from, Direction::pos_x, from.y, from.z, 0, 1);
  }
  for (const Direction d :
       {Direction::neg_y, Direction::pos_y, Direction::neg_z, Direction::pos_z}) {
    const std::int32_t step = is_positive(d) ? 1 : -1;
    const std::int32_t y = from.y + (axis_of(d) == Axis::y ? step : 0);
    const std::int32_t z = from.z + (axis_of(d) == Axis::z ? step : 0);
    if (origin_of(from.chunk, edge_).y + y > limits_.level) continue;
    if (y >= 0 && y < edge_ && z >= 0 && z < edge_) {
      reach(from.chunk, from.lines, y, z, s.first, s.last);
    } else {
      reach_beyond(from, d, (y + edge_) % edge_, (z + edge_) % edge_, s.first, s.last);
    }
  }
}

void LineFlood::reach_beyond(const Reached& from, Direction d, std::int32_t y, std::int32_t z,
                             int first, int last) {
  const ChunkCoord beyond = neighbour(from.chunk, d);
  Lines* const lines = lines_of(beyond);
  if (lines == nullptr) {
    fault_ = FloodFault::missing_chunk;
  } else {
    reach(beyond, lines, y, z, first, last);
  }
}

}  // namespace runstone
