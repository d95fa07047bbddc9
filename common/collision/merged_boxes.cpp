#include "common/collision/merged_boxes.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace runstone {
namespace {

/// A rectangle of solid voxels in one layer of the slowest axis.
struct LayerRectangle {
  std::uint32_t f_first = 0, f_last = 0, m_first = 0, m_last = 0;
  std::size_t box = 0;  // in the list of boxes
};

/// Merges rows that arrive in index order. Rows, rectangles and boxes are kept in the order of their
/// first voxels, so each step compares two sorted lists.
class BoxMerger {
 public:
  BoxMerger(Extent extent, AxisOrder order, std::size_t boxes_max, std::vector<MergedBox>& out)
      : extent_(ordered(extent, order)), axes_(axes_of(order)), boxes_max_(boxes_max), boxes_(out) {
    boxes_.clear();
  }

  /// Adds voxels [first, last) of the flattened chunk. Returns false if there are too many boxes.
  bool add_stretch(VoxelIndex first, VoxelIndex last) {
    while (first < last) {
      const std::uint32_t line = first / extent_.f;
      const VoxelIndex end = std::min(last, (line + 1) * extent_.f);
      if (line != line_ && !begin_line(line)) return false;
      add_row(first - line * extent_.f, end - line * extent_.f);
      first = end;
    }
    return true;
  }
  bool finish() { return finish_layer(); }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  bool begin_line(std::uint32_t line) {
    const std::uint32_t layer = line / extent_.m;
    if (layer != layer_ && !finish_layer()) return false;
    const bool follows = layer == layer_ && line == line_ + 1;
    above_.clear();
    if (follows) above_.swap(current_);
    current_.clear();
    next_above_ = 0;
    layer_ = layer;
    line_ = line;
    return true;
  }

  void add_row(std::uint32_t first, std::uint32_t last) {
    while (next_above_ < above_.size() && rectangles_[above_[next_above_]].f_first < first)
      ++next_above_;
    const std::uint32_t m = line_ - layer_ * extent_.m;
    if (next_above_ < above_.size()) {
      LayerRectangle& above = rectangles_[above_[next_above_]];
      if (above.f_first == first && above.f_last == last) {
        above.m_last = m + 1;
        current_.push_back(above_[next_above_]);
        return;
      }
    }
    current_.push_back(rectangles_.size());
    rectangles_.push_back({first, last, m, m + 1});
  }

  /// Gives each rectangle of the layer its box: that of an equal one in the layer before, or a new
  /// one.
  bool finish_layer() {
    if (layer_ == kNone) return true;
    const bool follows = before_layer_ != kNone && layer_ == before_layer_ + 1;
    if (!follows) before_.clear();
    std::size_t at = 0;
    for (LayerRectangle& rectangle : rectangles_) {
      const auto place = [](const LayerRectangle& r) { return std::pair(r.m_first, r.f_first); };
      while (at < before_.size() && place(before_[at]) < place(rectangle)) ++at;
      if (at < before_.size() && place(before_[at]) == place(rectangle) &&
          before_[at].m_last == rectangle.m_last && before_[at].f_last == rectangle.f_last) {
        rectangle.box = before_[at].box;
        ++boxes_[rectangle.box].max[static_cast<std::size_t>(axes_[2])];
        continue;
      }
      if (boxes_.size() == boxes_max_) return false;
      rectangle.box = boxes_.size();
      boxes_.push_back(box_of(rectangle));
    }
    before_.swap(rectangles_);
    rectangles_.clear();
    current_.clear();
    before_layer_ = layer_;
    return true;
  }

  MergedBox box_of(const LayerRectangle& r) const {
    MergedBox box;
    const auto set = [&](std::size_t rank, std::uint32_t first, std::uint32_t last) {
      box.min[static_cast<std::size_t>(axes_[rank])] = static_cast<std::uint8_t>(first);
      box.max[static_cast<std::size_t>(axes_[rank])] = static_cast<std::uint8_t>(last);
    };
    set(0, r.f_first, r.f_last);
    set(1, r.m_first, r.m_last);
    set(2, layer_, layer_ + 1);
    return box;
  }

  OrderedExtent extent_;
  std::array<Axis, 3> axes_;
  std::size_t boxes_max_;
  std::vector<MergedBox>& boxes_;
  std::uint32_t line_ = kNone, layer_ = kNone, before_layer_ = kNone;
  std::vector<LayerRectangle> rectangles_, before_;  // of this layer and of the one before it
  std::vector<std::size_t> above_, current_;         // rectangles with a row in the last two lines
  std::size_t next_above_ = 0;
};

}  // namespace

Result<void> merge_boxes(const RunChunk& chunk, const MaterialSet& solid, std::size_t boxes_max,
                         std::vector<MergedBox>& out) {
  BoxMerger merger(chunk.extent, chunk.order, boxes_max, out);
  const bool fits = chunk.runs.visit([&](const auto& runs) {
    VoxelIndex begin = 0, solid_begin = 0;
    bool is_inside = false;
    for (std::size_t i = 0; i < runs.size(); begin = runs.end(i++)) {
      const bool is_solid = solid.contains(runs.material(i));
      if (is_solid && !is_inside) solid_begin = begin;
      if (!is_solid && is_inside && !merger.add_stretch(solid_begin, begin)) return false;
      is_inside = is_solid;
    }
    return (!is_inside || merger.add_stretch(solid_begin, begin)) && merger.finish();
  });
  if (fits) return {};
  out.clear();
  return fail(ErrorCode::limit_exceeded, "more merged boxes than allowed", boxes_max);
}

}  // namespace runstone
