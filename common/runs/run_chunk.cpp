#include "common/runs/run_chunk.hpp"

#include <array>

#include "common/core/m61.hpp"
#include "common/runs/line_digest.hpp"
#include "common/runs/material_factors.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone {

RunChunk uniform_chunk(Extent extent, Material material, AxisOrder order) {
  RunBuilder builder(extent, order);
  builder.append(extent.volume(), material);
  return builder.finish();
}

namespace {

/// Returns the first run from `low` on that ends behind `voxel`. Requires low < size, and that no
/// run before `low` ends behind `voxel`.
template <class Runs>
std::size_t find_run_in(const Runs& runs, VoxelIndex voxel, std::size_t low = 0) {
  std::size_t count = runs.size() - low;
  // The search halves the range without a branch on the comparison, because the place of an edit is
  // unpredictable.
  while (count > 1) {
    const std::size_t half = count / 2;
    low += runs.end(low + half - 1) <= voxel ? half : 0;
    count -= half;
  }
  return low;
}

/// The runs that a fill replaces, and their replacement.
struct FillPlan {
  std::size_t from = 0, before = 0;  // edit index and edit area
  std::array<Run, 3> with{};
  std::size_t after = 0;  // entries of `with` in use; 0 if nothing changes
};

template <class Runs>
FillPlan plan_fill(const Runs& runs, VoxelIndex first, VoxelIndex last, Material material) {
  std::size_t from = find_run_in(runs, first);
  std::size_t to = last <= runs.end(from) ? from : find_run_in(runs, last - 1, from + 1);
  if (from == to && runs.material(from) == material) return {};
  const auto begin = [&](std::size_t i) { return i == 0 ? 0 : runs.end(i - 1); };

  // Neighbours of the same material merge with the new run, so that the list stays canonical.
  if (first == begin(from) && from > 0 && runs.material(from - 1) == material) --from;
  if (last == runs.end(to) && to + 1 < runs.size() && runs.material(to + 1) == material) ++to;
  const std::uint32_t area_begin = begin(from);
  const Run tail{runs.end(to), runs.material(to)};
  const std::uint32_t start = runs.material(from) == material ? area_begin : first;
  const std::uint32_t end = tail.material == material ? tail.end : last;

  FillPlan plan{from, to - from + 1, {}, 0};
  if (start > area_begin) plan.with[plan.after++] = {start, runs.material(from)};
  plan.with[plan.after++] = {end, material};
  if (end < tail.end) plan.with[plan.after++] = tail;
  return plan;
}

}  // namespace

std::size_t find_run(const RunChunk& chunk, VoxelIndex voxel) {
  RUNSTONE_DASSERT(voxel < chunk.volume());
  return chunk.runs.visit([voxel](const auto& runs) { return find_run_in(runs, voxel); });
}

Material material_at(const RunChunk& chunk, LocalPos at) {
  return chunk.runs.material(find_run(chunk, index_of(at, chunk.extent, chunk.order)));
}

bool fill(RunChunk& chunk, VoxelIndex first, std::uint32_t count, Material material,
          EditArea* area) {
  RUNSTONE_ASSERT(count > 0 && first <= chunk.volume() && count <= chunk.volume() - first);
  const FillPlan plan = chunk.runs.visit(
      [&](const auto& runs) { return plan_fill(runs, first, first + count, material); });
  if (plan.after == 0) return false;
  chunk.runs.splice(plan.from, plan.before, std::span<const Run>(plan.with.data(), plan.after));
  if (area != nullptr) {
    *area = {static_cast<std::uint32_t>(plan.from), static_cast<std::uint32_t>(plan.before),
             static_cast<std::uint32_t>(plan.after)};
  }
  return true;
}

Result<void> validate(const RunChunk& chunk) {
  if (!chunk.extent.valid()) return fail(ErrorCode::bad_value, "chunk side outside 8..128");
  return validate_runs(chunk);
}

Result<void> validate_runs(const RunChunk& chunk) {
  if (!chunk.extent.valid_part()) return fail(ErrorCode::bad_value, "side outside 1..128");
  if (static_cast<std::uint8_t>(chunk.order) >= kAxisOrderCount)
    return fail(ErrorCode::bad_value, "unknown axis order");
  if (chunk.runs.is_narrow() != (chunk.volume() <= kNarrowVolumeMax)) {
    return fail(ErrorCode::broken_invariant, "run list form does not fit the volume");
  }
  return chunk.runs.visit([volume = chunk.volume()](const auto& runs) -> Result<void> {
    if (runs.size() == 0) return fail(ErrorCode::broken_invariant, "chunk has no runs");
    std::uint32_t begin = 0;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      if (runs.end(i) <= begin)
        return fail(ErrorCode::broken_invariant, "run ends do not ascend", i);
      if (runs.end(i) > volume)
        return fail(ErrorCode::broken_invariant, "run ends behind the volume", i);
      if (i > 0 && runs.material(i) == runs.material(i - 1)) {
        return fail(ErrorCode::broken_invariant, "neighbouring runs have one material", i);
      }
      begin = runs.end(i);
    }
    if (begin != volume)
      return fail(ErrorCode::broken_invariant, "runs do not reach the volume", runs.size() - 1);
    return {};
  });
}

namespace {

/// Sum of A[x] * B[y] * C[z] over the first i voxels of the flattened chunk. These voxels are whole
/// layers, whole lines of one layer and part of one line: three boxes. Two of the boxes stay the
/// same while i stays on one line. The sum over a span is the difference of two such sums.
class PrefixDigest {
 public:
  PrefixDigest(Extent extent, AxisOrder order) : e_(ordered(extent, order)) {
    const auto axes = axes_of(order);
    for (int i = 0; i < kDigestLanes; ++i) {
      Lane& lane = lanes_[static_cast<std::size_t>(i)];
      lane.f = digest_axis_prefix(i, axes[0]).data();
      lane.m = digest_axis_prefix(i, axes[1]).data();
      lane.s = digest_axis_prefix(i, axes[2]).data();
      lane.layer = m61::mul(lane.f[e_.f], lane.m[e_.m]);
    }
    move_to(0);
  }

  Digest below(VoxelIndex i) {
    const std::uint32_t line = i / e_.f;
    if (line != line_) move_to(line);
    const std::uint32_t f = i - line * e_.f;
    Digest out;
    for (std::size_t k = 0; k < kDigestLanes; ++k) {
      out.lane[k] = m61::add(lanes_[k].before, m61::mul(lanes_[k].factor, lanes_[k].f[f]));
    }
    return out;
  }

  /// The current line is that of the last call of below(), at first the first one.
  VoxelIndex line_end() const { return (line_ + 1) * e_.f; }
  VoxelIndex line_begin() const { return line_ * e_.f; }
  /// Returns the factor that the voxels of the current line share.
  std::uint64_t line_factor(std::size_t lane) const { return lanes_[lane].factor; }

 private:
  struct Lane {
    const std::uint64_t *f, *m, *s;  // prefix sums by rank
    std::uint64_t layer;             // sum of f times sum of m
    std::uint64_t before;            // whole layers and lines before the current line
    std::uint64_t factor;            // the factor of each voxel of the current line
  };

  void move_to(std::uint32_t line) {
    line_ = line;
    // The layer is one past the last layer at the very end of the chunk.
    const std::uint32_t s = line / e_.m;
    const std::uint32_t m = line - s * e_.m;
    for (Lane& lane : lanes_) {
      const std::uint64_t of_s = m61::sub(lane.s[s + 1], lane.s[s]);
      lane.before = m61::add(m61::mul(lane.s[s], lane.layer),
                             m61::mul(of_s, m61::mul(lane.f[e_.f], lane.m[m])));
      lane.factor = m61::mul(of_s, m61::sub(lane.m[m + 1], lane.m[m]));
    }
  }

  OrderedExtent e_;
  std::uint32_t line_ = 0;
  std::array<Lane, kDigestLanes> lanes_{};
};

Digest times_material(const Digest& sum, const MaterialFactors::Lanes& factors) {
  Digest out;
  for (std::size_t k = 0; k < kDigestLanes; ++k) out.lane[k] = m61::mul(sum.lane[k], factors[k]);
  return out;
}

}  // namespace

Digest digest_of_span(const RunChunk& shape, VoxelIndex first, VoxelIndex last, Material material) {
  RUNSTONE_DASSERT(first <= last && last <= shape.volume());
  if (first == last || material == kEmpty) return {};
  PrefixDigest prefix(shape.extent, shape.order);
  const Digest before = prefix.below(first);
  return times_material(prefix.below(last) - before,
                        {digest_material(0, material), digest_material(1, material)});
}

Digest digest_of(const RunChunk& chunk) {
  PrefixDigest prefix(chunk.extent, chunk.order);
  LineDigest line(axes_of(chunk.order)[0]);  // of the current line of `prefix`
  MaterialFactors factors;
  Digest sum;
  const auto close_line = [&] {
    if (line.is_empty()) return;
    const LineDigest::Lanes of_line = line.take();
    for (std::size_t k = 0; k < kDigestLanes; ++k)
      sum.lane[k] = m61::add(sum.lane[k], m61::mul(of_line[k], prefix.line_factor(k)));
  };
  chunk.runs.visit([&](const auto& runs) {
    VoxelIndex begin = 0;
    for (std::size_t i = 0; i < runs.size(); begin = runs.end(i++)) {
      const VoxelIndex end = runs.end(i);
      const Material material = runs.material(i);
      if (end > prefix.line_end()) {
        close_line();
        const Digest before = prefix.below(begin);
        const Digest span = prefix.below(end) - before;
        if (material != kEmpty) sum = sum + times_material(span, factors.of(material));
      } else if (material != kEmpty) {
        line.add(begin - prefix.line_begin(), end - prefix.line_begin(), factors.of(material));
      }
    }
  });
  close_line();
  return sum;
}

}  // namespace runstone
