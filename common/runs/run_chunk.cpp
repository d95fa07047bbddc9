#include "common/runs/run_chunk.hpp"

#include <array>
#include <algorithm>

#include "common/runs/run_builder.hpp"

namespace runstone {

RunChunk uniform_chunk(Extent extent, Material material, AxisOrder order) {
  RunBuilder builder(extent, order);
  builder.append(extent.volume(), material);
  return builder.finish();
}

namespace {

template <class Runs>
std::size_t find_run_in(const Runs& runs, VoxelIndex voxel) {
  std::size_t low = 0;
  std::size_t high = runs.size() - 1;
  while (low < high) {
    const std::size_t mid = low + (high - low) / 2;
    if (runs.end(mid) <= voxel) {
      low = mid + 1;
    } else {
      high = mid;
    }
  }
  return low;
}

}  // namespace

std::size_t find_run(const RunChunk& chunk, VoxelIndex voxel) {
  RUNSTONE_DASSERT(voxel < chunk.volume());
  return chunk.runs.visit([voxel](const auto& runs) { return find_run_in(runs, voxel); });
}

Material material_at(const RunChunk& chunk, LocalPos at) {
  return chunk.runs.material(find_run(chunk, index_of(at, chunk.extent, chunk.order)));
}

bool fill(RunChunk& chunk, VoxelIndex first, std::uint32_t count, Material material, EditArea* area) {
  RUNSTONE_ASSERT(count > 0 && first <= chunk.volume() && count <= chunk.volume() - first);
  const VoxelIndex last = first + count;  // one past
  std::size_t from = find_run(chunk, first);
  std::size_t to = find_run(chunk, last - 1);
  if (from == to && chunk.runs.material(from) == material) return false;

  // Neighbours of the same material melt into the new run, so that the list stays canonical.
  std::uint32_t start = first;
  std::uint32_t end = last;
  const auto runs = static_cast<std::size_t>(chunk.runs.size());
  if (first == chunk.runs.begin(from) && from > 0 && chunk.runs.material(from - 1) == material) --from;
  if (last == chunk.runs.end(to) && to + 1 < runs && chunk.runs.material(to + 1) == material) ++to;
  const Run head = chunk.runs[from];
  const Run tail = chunk.runs[to];
  if (head.material == material) start = chunk.runs.begin(from);
  if (tail.material == material) end = tail.end;

  std::array<Run, 3> with{};
  std::size_t n = 0;
  if (start > chunk.runs.begin(from)) with[n++] = {start, head.material};
  with[n++] = {end, material};
  if (end < tail.end) with[n++] = tail;
  const std::size_t before = to - from + 1;
  chunk.runs.splice(from, before, std::span<const Run>(with.data(), n));
  if (area != nullptr) {
    *area = {static_cast<std::uint32_t>(from), static_cast<std::uint32_t>(before), static_cast<std::uint32_t>(n)};
  }
  return true;
}

Result<void> validate(const RunChunk& chunk) {
  if (!chunk.extent.valid()) return fail(ErrorCode::bad_value, "chunk side outside 8..128");
  if (static_cast<std::uint8_t>(chunk.order) >= kAxisOrderCount) return fail(ErrorCode::bad_value, "unknown axis order");
  if (chunk.runs.is_narrow() != (chunk.volume() <= kNarrowVolumeMax)) {
    return fail(ErrorCode::broken_invariant, "run list form does not fit the volume");
  }
  return chunk.runs.visit([volume = chunk.volume()](const auto& runs) -> Result<void> {
    if (runs.size() == 0) return fail(ErrorCode::broken_invariant, "chunk has no runs");
    std::uint32_t begin = 0;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      if (runs.end(i) <= begin) return fail(ErrorCode::broken_invariant, "run ends do not ascend", i);
      if (runs.end(i) > volume) return fail(ErrorCode::broken_invariant, "run ends behind the volume", i);
      if (i > 0 && runs.material(i) == runs.material(i - 1)) {
        return fail(ErrorCode::broken_invariant, "neighbouring runs have one material", i);
      }
      begin = runs.end(i);
    }
    if (begin != volume) return fail(ErrorCode::broken_invariant, "runs do not reach the volume", runs.size() - 1);
    return {};
  });
}

namespace {

/// Calls box(min, max) for at most five boxes, in ordered coordinates, that tile [first, last).
template <class F>
void for_each_box(OrderedExtent e, VoxelIndex first, VoxelIndex last, F&& box) {
  const auto lines = [&](VoxelIndex a, VoxelIndex b) {  // whole lines a .. b (line numbers), at most 3 boxes
    const std::uint32_t s0 = a / e.m;
    const std::uint32_t s1 = b / e.m;
    if (s0 == s1) {
      if (a < b) box(OrderedPos{0, a % e.m, s0}, OrderedPos{e.f, b % e.m, s0 + 1});
      return;
    }
    std::uint32_t whole = s0;
    if (a % e.m != 0) {
      box(OrderedPos{0, a % e.m, s0}, OrderedPos{e.f, e.m, s0 + 1});
      ++whole;
    }
    if (whole < s1) box(OrderedPos{0, 0, whole}, OrderedPos{e.f, e.m, s1});
    if (b % e.m != 0) box(OrderedPos{0, 0, s1}, OrderedPos{e.f, b % e.m, s1 + 1});
  };
  const auto part = [&](VoxelIndex a, VoxelIndex b) {  // inside one line
    const std::uint32_t line = a / e.f;
    const std::uint32_t f0 = a - line * e.f;
    box(OrderedPos{f0, line % e.m, line / e.m}, OrderedPos{f0 + (b - a), line % e.m + 1, line / e.m + 1});
  };
  const VoxelIndex line_up = (first + e.f - 1) / e.f;  // first whole line
  const VoxelIndex line_down = last / e.f;             // one past the last whole line
  if (line_up > line_down) return part(first, last);
  if (first < line_up * e.f) part(first, line_up * e.f);
  lines(line_up, line_down);
  if (line_down * e.f < last) part(line_down * e.f, last);
}

Digest digest_of_ordered_span(OrderedExtent e, std::array<Axis, 3> axes, VoxelIndex first, VoxelIndex last,
                              Material material) {
  Digest sum;
  if (material == kEmpty) return sum;
  for_each_box(e, first, last, [&](OrderedPos min, OrderedPos max) {
    std::array<unsigned, 3> low{};
    std::array<unsigned, 3> high{};
    const std::array<std::uint32_t, 3> lo = {min.f, min.m, min.s};
    const std::array<std::uint32_t, 3> hi = {max.f, max.m, max.s};
    for (std::size_t i = 0; i < 3; ++i) {
      low[static_cast<std::size_t>(axes[i])] = lo[i];
      high[static_cast<std::size_t>(axes[i])] = hi[i];
    }
    sum = sum + digest_of_box(material, low, high);
  });
  return sum;
}

}  // namespace

Digest digest_of_span(const RunChunk& shape, VoxelIndex first, VoxelIndex last, Material material) {
  RUNSTONE_DASSERT(first <= last && last <= shape.volume());
  if (first == last) return {};
  return digest_of_ordered_span(ordered(shape.extent, shape.order), axes_of(shape.order), first, last, material);
}

Digest digest_of(const RunChunk& chunk) {
  const OrderedExtent e = ordered(chunk.extent, chunk.order);
  const auto axes = axes_of(chunk.order);
  return chunk.runs.visit([&](const auto& runs) {
    Digest sum;
    std::uint32_t begin = 0;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      sum = sum + digest_of_ordered_span(e, axes, begin, runs.end(i), runs.material(i));
      begin = runs.end(i);
    }
    return sum;
  });
}

}  // namespace runstone
