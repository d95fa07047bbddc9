#include "common/veil/veil_patch.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "common/core/assert.hpp"
#include "common/runs/layer_walk.hpp"
#include "common/runs/run_builder.hpp"
#include "common/runs/run_cursor.hpp"
#include "common/runs/span_boxes.hpp"

namespace runstone {
namespace {

/// Appends the lines of a box as spans of another axis order.
void add_lines(const OrderedBox& box, const VeilPatch& patch, Material material, VeilPatch& out) {
  const OrderedExtent to = ordered(out.extent, out.order);
  // The box along the axes of the new order.
  std::array<std::uint32_t, 3> first{}, last{};
  const auto axes = axes_of(patch.order);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto rank = static_cast<std::size_t>(rank_of(axes[i], out.order));
    first[rank] = box.first[i];
    last[rank] = box.last[i];
  }
  for (std::uint32_t s = first[2]; s < last[2]; ++s) {
    for (std::uint32_t m = first[1]; m < last[1]; ++m)
      out.spans.push_back({s * to.layer() + m * to.f + first[0], last[0] - first[0], material});
  }
}

/// Joins spans that touch and have one material. Requires ascending spans.
void join(std::vector<VeilSpan>& spans) {
  std::size_t used = 0;
  for (const VeilSpan& span : spans) {
    if (used != 0 && spans[used - 1].material == span.material &&
        spans[used - 1].first + spans[used - 1].count == span.first) {
      spans[used - 1].count += span.count;
    } else {
      spans[used++] = span;
    }
  }
  spans.resize(used);
}

/// Returns the runs of the chunk with all spans.
RunChunk patched(const RunChunk& chunk, const std::vector<VeilSpan>& spans) {
  RunBuilder builder(chunk.extent, chunk.order);
  chunk.runs.visit([&]<class Runs>(Runs runs) {
    RunCursor<Runs> cursor(runs);
    const auto copy_to = [&](std::uint32_t end) {
      if (builder.filled() == end) return;
      cursor.seek(builder.filled());
      for (; cursor.end() < end; cursor.next()) builder.append_to(cursor.end(), cursor.material());
      builder.append_to(end, cursor.material());
    };
    for (const VeilSpan& span : spans) {
      copy_to(span.first);
      builder.append(span.count, span.material);
    }
    copy_to(chunk.volume());
  });
  return builder.finish();
}

}  // namespace

Result<void> validate(const VeilPatch& patch) {
  if (!patch.extent.valid_part()) return fail(ErrorCode::bad_value, "sides of a patch", 0);
  std::uint32_t end = 0;
  for (std::size_t i = 0; i < patch.spans.size(); ++i) {
    const VeilSpan& span = patch.spans[i];
    if (span.count == 0) return fail(ErrorCode::broken_invariant, "a span has no voxels", i);
    if (span.first < end && i != 0)
      return fail(ErrorCode::broken_invariant, "spans do not ascend", i);
    if (span.first >= patch.extent.volume() || span.count > patch.extent.volume() - span.first)
      return fail(ErrorCode::broken_invariant, "a span leaves the chunk", i);
    if (i != 0 && span.first == end && span.material == patch.spans[i - 1].material)
      return fail(ErrorCode::broken_invariant, "spans of one material touch", i);
    end = span.first + span.count;
  }
  return {};
}

VeilPatch in_order(const VeilPatch& patch, AxisOrder order) {
  if (order == patch.order) return patch;
  VeilPatch out{patch.extent, order, {}};
  const OrderedExtent from = ordered(patch.extent, patch.order);
  for (const VeilSpan& span : patch.spans) {
    for_each_box(from, span.first, span.first + span.count,
                 [&](const OrderedBox& box) { add_lines(box, patch, span.material, out); });
  }
  std::sort(out.spans.begin(), out.spans.end(),
            [](const VeilSpan& a, const VeilSpan& b) { return a.first < b.first; });
  join(out.spans);
  return out;
}

bool apply_patch(const VeilPatch& patch, RunChunk& chunk) {
  RUNSTONE_ASSERT(patch.extent == chunk.extent);
  if (patch.order != chunk.order) return apply_patch(in_order(patch, chunk.order), chunk);
  // Each splice moves the runs behind it. For a few spans that costs less than a copy of all runs.
  constexpr std::size_t kSplicesMax = 8;
  if (patch.spans.size() <= kSplicesMax) {
    bool is_changed = false;
    for (const VeilSpan& span : patch.spans)
      is_changed = fill(chunk, span.first, span.count, span.material) || is_changed;
    return is_changed;
  }
  RunChunk out = patched(chunk, patch.spans);
  const bool is_changed = !(out.runs == chunk.runs);
  chunk = std::move(out);
  return is_changed;
}

}  // namespace runstone
