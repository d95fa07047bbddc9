#include "common/mesh/rdm/mesh_run.hpp"

#include <algorithm>
#include <array>

#include "common/mesh/rdm/divider.hpp"
#include "common/runs/run_cursor.hpp"

namespace runstone::rdm {
namespace {

/// Appends to a run list so that neighbours differ.
class Appender {
 public:
  Appender(const VisibilityTable& visibility, std::vector<MeshRun>& out)
      : visibility_(visibility), out_(out) {
    out_.clear();
  }
  void append_to(std::uint32_t end, Material material) {
    if (!out_.empty() && out_.back().material == material) {
      out_.back().end = end;
    } else {
      out_.push_back({end, material, visibility_[material]});
    }
  }

 private:
  const VisibilityTable& visibility_;
  std::vector<MeshRun>& out_;
};

/// Layer of the slowest axis: one stretch of the chunk.
template <class Runs>
void slow_layer(const Runs& runs, OrderedExtent e, std::uint32_t at, Appender& out) {
  const std::uint32_t begin = at * e.layer();
  RunCursor cursor(runs);
  for (cursor.seek(begin); cursor.end() < begin + e.layer(); cursor.next()) {
    out.append_to(cursor.end() - begin, cursor.material());
  }
  out.append_to(e.layer(), cursor.material());
}

/// Layer of the middle axis: one line of every slow layer.
template <class Runs>
void middle_layer(const Runs& runs, OrderedExtent e, std::uint32_t at, Appender& out) {
  RunCursor cursor(runs);
  for (std::uint32_t row = 0; row < e.s;) {
    const std::uint32_t begin = row * e.layer() + at * e.f;
    for (cursor.seek(begin); cursor.end() < begin + e.f; cursor.next()) {
      out.append_to(row * e.f + (cursor.end() - begin), cursor.material());
    }
    // The run may cover the same line of the layers that follow: a uniform chunk is one step.
    const std::uint32_t rows = 1 + (cursor.end() - begin - e.f) / e.layer();
    row += rows;
    out.append_to(row * e.f, cursor.material());
  }
}

/// Layer of the fastest axis: one voxel of every line.
template <class Runs>
void fast_layer(const Runs& runs, OrderedExtent e, std::uint32_t at, Appender& out) {
  const Divider lines_in(e.f);
  std::uint32_t covered = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const std::uint32_t lines = lines_in(runs.end(i) + e.f - 1 - at);  // whose voxel `at` lies before the end
    if (lines == covered) continue;
    covered = lines;
    out.append_to(covered, runs.material(i));
  }
}

/// Swaps the two axes of a layer with rows of `row_length`, by way of its materials in `layer`.
void transpose(std::uint32_t row_length, const VisibilityTable& visibility, std::vector<Material>& layer,
               std::vector<MeshRun>& runs) {
  const std::uint32_t area = runs.back().end;
  const std::uint32_t rows = area / row_length;
  layer.resize(area);
  std::uint32_t i = 0;
  std::uint32_t u = 0;
  std::uint32_t to = 0;  // place of voxel i in the turned layer: row + u * rows
  for (const MeshRun& run : runs) {
    for (; i < run.end; ++i) {
      layer[to] = run.material;
      to += rows;
      if (++u == row_length) {
        u = 0;
        to -= area - 1;
      }
    }
  }
  Appender appender(visibility, runs);
  for (i = 0; i < area; ++i) appender.append_to(i + 1, layer[i]);
}

}  // namespace

void chunk_runs(const RunChunk& chunk, const VisibilityTable& visibility, std::vector<MeshRun>& out) {
  chunk.runs.visit([&](const auto& runs) {
    out.resize(runs.size());
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const Material material = runs.material(i);
      out[i] = {runs.end(i), material, visibility[material]};
    }
  });
}

void layer_runs(const RunChunk& chunk, Axis axis, std::uint32_t at, Axis u_axis,
                const VisibilityTable& visibility, std::vector<Material>& layer, std::vector<MeshRun>& out) {
  const OrderedExtent e = ordered(chunk.extent, chunk.order);
  const std::array<Axis, 3> axes = axes_of(chunk.order);
  Appender appender(visibility, out);
  chunk.runs.visit([&](const auto& runs) {
    if (axis == axes[2]) {
      slow_layer(runs, e, at, appender);
    } else if (axis == axes[1]) {
      middle_layer(runs, e, at, appender);
    } else {
      fast_layer(runs, e, at, appender);
    }
  });
  const Axis lower = axis == axes[0] ? axes[1] : axes[0];
  if (u_axis != lower && out.size() > 1) transpose(axis == axes[0] ? e.m : e.f, visibility, layer, out);
}

}  // namespace runstone::rdm
