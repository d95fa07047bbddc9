#include "common/edits/apply/layer_painter.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "common/edits/apply/layer_canvas.hpp"
#include "common/edits/apply/layer_plan.hpp"
#include "common/edits/apply/line_bits.hpp"
#include "common/runs/run_cursor.hpp"

// The rest of this file is compiled once per instruction set. Highway selects one at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "common/edits/apply/layer_painter.cpp"
#include <hwy/foreach_target.h>
// Highway requires these includes after foreach_target.h.
#include <hwy/highway.h>

#include "common/edits/apply/brush_lanes-inl.hpp"
#include "common/edits/apply/shape_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace runstone {
namespace HWY_NAMESPACE {

/// One call of paint_changes().
template <class Runs>
class Painter {
 public:
  Painter(Runs runs, OrderedExtent extent, ApplyScratch& scratch, ChangeTally& tally)
      : extent_(extent),
        stack_(scratch.stack),
        plan_(scratch.plan),
        canvas_(scratch.canvas),
        before_(scratch.canvas_before),
        tally_(tally),
        cursor_(runs) {}

  void run() {
    canvas_.fit(extent_);
    before_.fit(extent_);
    for (std::uint32_t first = 0; first < extent_.s; first += LayerPlan::kBand) {
      band_first_ = first;
      band_last_ = std::min(first + LayerPlan::kBand, extent_.s);
      make_plan();
      for (std::uint32_t s = band_first_; s < band_last_; ++s) layer(s);
    }
  }

 private:
  void make_plan() {
    // The number of parts that begin minus the number of parts that end, by layer.
    std::array<std::uint32_t, LayerPlan::kBand + 1> parts{};
    for (const StackPart& part : stack_) {
      const auto [first, last] = layers_of(part.shape);
      if (first >= last) continue;
      ++parts[first - band_first_];
      --parts[last - band_first_];
    }
    std::uint32_t room = 0, reaching = 0;
    for (std::uint32_t i = 0; i < LayerPlan::kBand; ++i) {
      plan_.begin[i] = plan_.end[i] = room;
      reaching += parts[i];
      room += reaching;
    }
    if (plan_.pieces.size() < room) plan_.pieces.resize(room);
    row_count_ = 0;
    for (std::uint32_t i = 0; i < stack_.size(); ++i) enter(i);
  }

  // Returns the layers of the shape that lie in the band.
  std::pair<std::uint32_t, std::uint32_t> layers_of(const OrderedShape& shape) const {
    return {std::max(shape.first[2], band_first_), std::min(shape.last[2], band_last_)};
  }

  void enter(std::uint32_t number) {
    const StackPart& part = stack_[number];
    const OrderedShape& shape = part.shape;
    const auto [first, last] = layers_of(shape);
    if (first >= last) return;
    if (shape.form != OrderedShape::Form::box) {
      find_rows(shape, first, last,
                [&](std::uint32_t s, std::uint8_t m_first, std::uint8_t m_last) {
                  const std::uint32_t rows = row_count_;
                  plan_.pieces[plan_.end[s - band_first_]++] = {number, rows, m_first, m_last};
                  row_count_ += std::uint32_t{m_last} - m_first;
                  return room_for_rows(rows);
                });
      return;
    }
    const LayerPiece piece{number, 0, static_cast<std::uint8_t>(shape.first[1]),
                           static_cast<std::uint8_t>(shape.last[1])};
    const bool hides = part.mask.kind == MaskKind::everything && shape.covers_layers(extent_);
    for (std::uint32_t s = first - band_first_; s < last - band_first_; ++s) {
      if (hides) plan_.end[s] = plan_.begin[s];  // the pieces below are overwritten
      plan_.pieces[plan_.end[s]++] = piece;
    }
  }

  // Makes room for the rows up to row_count_. Returns the place of row `first`.
  Ends room_for_rows(std::uint32_t first) {
    const std::size_t size = row_count_ + Ends::kBehind;
    if (plan_.row_first.size() < size) {
      plan_.row_first.resize(2 * size);
      plan_.row_last.resize(2 * size);
    }
    return {plan_.row_first.data() + first, plan_.row_last.data() + first};
  }

  void layer(std::uint32_t s) {
    const std::uint32_t i = s - band_first_;
    const std::span pieces(plan_.pieces.data() + plan_.begin[i], plan_.end[i] - plan_.begin[i]);
    if (pieces.empty()) return;
    LineBits met;
    for (const LayerPiece& piece : pieces) met = met | bits_between(piece.m_first, piece.m_last);
    const VoxelIndex begin = s * extent_.layer();
    for_each_line(met, [&](std::uint32_t m) {
      starts_[m] = unpack(begin + m * extent_.f, before_.line(m));
      copy_line(before_.line(m), canvas_.line(m), extent_.f);
    });
    for (const LayerPiece& piece : pieces) paint(piece);
    for_each_line(met, [&](std::uint32_t m) { compare(m, s); });
  }

  template <class F>
  static void for_each_line(LineBits lines, F&& f) {
    for (std::uint64_t low = lines.low; low != 0; low &= low - 1) {
      f(static_cast<std::uint32_t>(std::countr_zero(low)));
    }
    for (std::uint64_t high = lines.high; high != 0; high &= high - 1) {
      f(64 + static_cast<std::uint32_t>(std::countr_zero(high)));
    }
  }

  void paint(const LayerPiece& piece) const {
    const StackPart& part = stack_[piece.part];
    const Brush brush(part.mask, part.material);
    const bool is_short = static_cast<std::int32_t>(extent_.f) <= Brush::lanes();
    Material* line = canvas_.line(piece.m_first);
    const auto draw = [&](std::int32_t first, std::int32_t last) {
      if (is_short) {
        brush.stroke_short(line, first, last);
      } else {
        brush.stroke(line, first, last);
      }
      line += canvas_.stride();
    };
    const std::uint32_t count = std::uint32_t{piece.m_last} - piece.m_first;
    if (part.shape.form == OrderedShape::Form::box) {
      const auto first = static_cast<std::int32_t>(part.shape.first[0]);
      const auto last = static_cast<std::int32_t>(part.shape.last[0]);
      for (std::uint32_t i = 0; i < count; ++i) draw(first, last);
    } else {
      const std::uint8_t* const first = plan_.row_first.data() + piece.rows;
      const std::uint8_t* const last = plan_.row_last.data() + piece.rows;
      for (std::uint32_t i = 0; i < count; ++i) draw(first[i], last[i]);
    }
  }

  // Passes the differences between the canvas and the runs of a line to the tally.
  void compare(std::uint32_t m, std::uint32_t s) const {
    const Material* const before = before_.line(m);
    const Material* const after = canvas_.line(m);
    const LineBits changed = differing_lanes(before, after, extent_.f);
    if (!changed.any()) return;
    tally_.line(m, s, changed, starts_[m] | differing_lanes(after, after - 1, extent_.f), before,
                after);
  }

  // Returns the places where runs begin in the line.
  LineBits unpack(VoxelIndex begin, Material* out) {
    LineBits starts;
    cursor_.seek(begin);
    const VoxelIndex end = begin + extent_.f;
    for (VoxelIndex at = begin; at < end;) {
      const VoxelIndex stop = std::min(cursor_.end(), end);
      fill_ahead(out + (at - begin), out + (stop - begin), cursor_.material());
      starts = starts | bits_between(at - begin, at - begin + 1);
      at = stop;
      if (at < end) cursor_.next();
    }
    return starts;
  }

  const OrderedExtent extent_;
  const std::vector<StackPart>& stack_;
  LayerPlan& plan_;
  LayerCanvas& canvas_;
  LayerCanvas& before_;  // the layer as the runs have it
  ChangeTally& tally_;
  RunCursor<Runs> cursor_;
  std::array<LineBits, kSideMax> starts_;  // where runs begin in the lines of the layer
  std::uint32_t band_first_ = 0, band_last_ = 0, row_count_ = 0;
};

void paint_runs(const RunChunk& chunk, ApplyScratch& scratch, ChangeTally& tally) {
  chunk.runs.visit([&]<class Runs>(Runs runs) {
    Painter<Runs>(runs, ordered(chunk.extent, chunk.order), scratch, tally).run();
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace runstone
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace runstone {

HWY_EXPORT(paint_runs);

void paint_changes(const RunChunk& chunk, ApplyScratch& scratch, ChangeTally& tally) {
  HWY_DYNAMIC_DISPATCH(paint_runs)(chunk, scratch, tally);
}

}  // namespace runstone
#endif
