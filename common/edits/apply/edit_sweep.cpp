#include "common/edits/apply/edit_sweep.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <span>
#include <variant>
#include <vector>

#include "common/core/assert.hpp"
#include "common/edits/apply/line_bits.hpp"
#include "common/runs/run_cursor.hpp"

namespace runstone {
namespace {

bool unconditional(const StackPart& part) { return part.mask.kind == MaskKind::everything; }

// Room for a line, for the voxel before it, and for stores and loads of whole words behind it.
struct LineBuffer {
  static constexpr std::size_t kBefore = 8;
  alignas(16) std::array<Material, kBefore + kSideMax + 16> voxels{};
  Material* line() { return voxels.data() + kBefore; }
};

// Sets the voxels [first, last), and up to 7 voxels behind them. Runs are unpacked in ascending
// order, so the next run overwrites the excess.
void fill_loosely(Material* line, std::uint32_t first, std::uint32_t last, Material material) {
  const std::uint64_t four = material * 0x0001000100010001ULL;
  for (std::uint32_t i = first; i < last; i += 8) {
    std::memcpy(line + i, &four, sizeof four);
    std::memcpy(line + i + 4, &four, sizeof four);
  }
}

void apply_to_line(const StackPart& part, Material* line, std::uint32_t first, std::uint32_t last) {
  const Material material = part.material;
  const auto replace_if = [&](auto&& admits) {
    for (std::uint32_t i = first; i < last; ++i) line[i] = admits(line[i]) ? material : line[i];
  };
  switch (part.mask.kind) {
    case MaskKind::everything:
      std::fill(line + first, line + last, material);
      break;
    case MaskKind::only_empty:
      replace_if([](Material present) { return present == kEmpty; });
      break;
    case MaskKind::only_solid:
      replace_if([](Material present) { return present != kEmpty; });
      break;
    case MaskKind::only_material:
      replace_if([wanted = part.mask.material](Material present) { return present == wanted; });
      break;
  }
}

template <class Runs>
class Sweep {
 public:
  Sweep(Runs runs, OrderedExtent extent, ApplyScratch& scratch, ChangeTally& tally)
      : runs_(runs),
        extent_(extent),
        scratch_(scratch),
        stack_(scratch.stack),
        tally_(tally),
        cursor_(runs) {}

  void run() {
    chain_by_layer();
    scratch_.active.assign((stack_.size() + 63) / 64, 0);
    for (std::uint32_t s = 0; s < extent_.s; ++s) {
      for (std::uint32_t i = scratch_.starting[s]; i != 0; i = scratch_.starting[extent_.s + i])
        activate(i - 1);
      for (std::uint32_t i = scratch_.ending[s]; i != 0; i = scratch_.ending[extent_.s + i])
        deactivate(i - 1);
      if (active_count_ != 0) layer(s);
    }
  }

 private:
  // Chains every part to the layers where it begins and ends: heads first, then one link per part.
  // The links are numbers + 1, so the link of part i is at extent_.s + i + 1.
  void chain_by_layer() {
    const std::size_t size = extent_.s + 1 + stack_.size();
    scratch_.starting.assign(size, 0);
    scratch_.ending.assign(size, 0);
    for (std::uint32_t i = 0; i < stack_.size(); ++i) {
      const auto chain = [this, i](std::vector<std::uint32_t>& chains, std::uint32_t layer) {
        chains[extent_.s + i + 1] = chains[layer];
        chains[layer] = i + 1;
      };
      chain(scratch_.starting, stack_[i].shape.first[2]);
      if (stack_[i].shape.last[2] < extent_.s) chain(scratch_.ending, stack_[i].shape.last[2]);
    }
  }

  void activate(std::uint32_t part) {
    scratch_.active[part / 64] |= std::uint64_t{1} << (part % 64);
    ++active_count_;
  }
  void deactivate(std::uint32_t part) {
    scratch_.active[part / 64] &= ~(std::uint64_t{1} << (part % 64));
    --active_count_;
  }

  // Calls visit(part number) for the active set from the top of the stack downward, while it
  // returns true.
  template <class F>
  void from_top(F&& visit) const {
    for (std::size_t word = scratch_.active.size(); word-- > 0;) {
      for (std::uint64_t bits = scratch_.active[word]; bits != 0;) {
        const auto bit = static_cast<std::uint32_t>(63 - std::countl_zero(bits));
        if (!visit(static_cast<std::uint32_t>(word * 64 + bit))) return;
        bits ^= std::uint64_t{1} << bit;
      }
    }
  }

  void layer(std::uint32_t s) {
    const VoxelIndex first = s * extent_.layer();
    if (whole_layer_program()) return interval(first, first + extent_.layer());
    enter_rows(s);
    for (std::uint32_t m = 0; m < extent_.m; ++m) {
      if (lines_[m] != 0) line(first + m * extent_.f, lines_[m]);
    }
  }

  // Returns true if all parts that matter in this layer cover it completely. They are the program
  // then.
  bool whole_layer_program() {
    scratch_.program.clear();
    bool whole = true;
    from_top([&](std::uint32_t part) {
      whole = stack_[part].shape.covers_layers(extent_);
      scratch_.program.push_back(part);
      return whole && !unconditional(stack_[part]);
    });
    std::reverse(scratch_.program.begin(), scratch_.program.end());
    return whole;
  }

  // Adds the rows of the layer to the chains of their lines, from the top of the stack downward, so
  // that each chain begins at the bottom. A row is left out if parts above it without a mask cover
  // it.
  void enter_rows(std::uint32_t s) {
    std::fill_n(lines_.begin(), extent_.m, 0u);
    std::fill_n(covered_.begin(), extent_.m, LineBits{});
    scratch_.entries.clear();
    const LineBits full = bits_below(extent_.f);
    std::uint32_t open_lines = extent_.m;
    from_top([&](std::uint32_t number) {
      const StackPart& part = stack_[number];
      for_each_row(part.shape, s, [&](std::uint32_t m, std::uint32_t first, std::uint32_t last) {
        const LineBits row = bits_between(first, last);
        LineBits& covered = covered_[m];
        if (!(row & ~covered).any()) return;
        scratch_.entries.push_back(
            {lines_[m], number, static_cast<std::uint8_t>(first), static_cast<std::uint8_t>(last)});
        lines_[m] = static_cast<std::uint32_t>(scratch_.entries.size());
        if (!unconditional(part)) return;
        covered = covered | row;
        if (covered == full) --open_lines;
      });
      return open_lines != 0;
    });
  }

  const LineEntry& entry(std::uint32_t link) const { return scratch_.entries[link - 1]; }

  void line(VoxelIndex begin, std::uint32_t chain) {
    const LineEntry& bottom = entry(chain);
    bool same_voxels = true;
    scratch_.program.clear();
    for (std::uint32_t link = chain; link != 0 && same_voxels; link = entry(link).next) {
      same_voxels = entry(link).first == bottom.first && entry(link).last == bottom.last;
      scratch_.program.push_back(entry(link).part);
    }
    if (same_voxels) {
      interval(begin + bottom.first, begin + bottom.last);
    } else {
      unpacked_line(begin, chain);
    }
  }

  // Evaluates the program over [first, last), run by run.
  void interval(VoxelIndex first, VoxelIndex last) {
    cursor_.seek(first);
    for (VoxelIndex at = first; at < last;) {
      const VoxelIndex end = std::min(cursor_.end(), last);
      const Material before = cursor_.material();
      Material after = before;
      for (const std::uint32_t part : scratch_.program) {
        if (stack_[part].mask.admits(after)) after = stack_[part].material;
      }
      if (after != before) tally_.stretch(at, end, before, after);
      at = end;
      if (at < last) cursor_.next();
    }
  }

  void unpacked_line(VoxelIndex begin, std::uint32_t chain) {
    Material* const before = before_.line();
    Material* const after = after_.line();
    LineBits cuts = unpack(begin, before);
    std::memcpy(after, before, extent_.f * sizeof(Material));
    for (std::uint32_t link = chain; link != 0; link = entry(link).next) {
      apply_to_line(stack_[entry(link).part], after, entry(link).first, entry(link).last);
    }
    LineBits changed = differing(before, after, extent_.f);
    if (!changed.any()) return;
    after[-1] = after[0];
    cuts = cuts | differing(after, after - 1, extent_.f) | ~changed;
    while (changed.any()) {
      const std::uint32_t first = changed.lowest();
      const std::uint32_t cut = (cuts & ~bits_below(first + 1)).lowest();
      const std::uint32_t last = std::min(cut, extent_.f);
      tally_.stretch(begin + first, begin + last, before[first], after[first]);
      changed = changed & ~bits_below(last);
    }
  }

  // Returns the places where runs begin in the line.
  LineBits unpack(VoxelIndex begin, Material* out) {
    LineBits starts;
    cursor_.seek(begin);
    const VoxelIndex end = begin + extent_.f;
    for (VoxelIndex at = begin; at < end;) {
      const VoxelIndex stop = std::min(cursor_.end(), end);
      fill_loosely(out, at - begin, stop - begin, cursor_.material());
      starts = starts | bits_between(at - begin, at - begin + 1);
      at = stop;
      if (at < end) cursor_.next();
    }
    return starts;
  }

  Runs runs_;
  const OrderedExtent extent_;
  ApplyScratch& scratch_;
  const std::vector<StackPart>& stack_;
  ChangeTally& tally_;
  RunCursor<Runs> cursor_;
  std::uint32_t active_count_ = 0;
  // Heads of the chains of the current layer: entry number + 1.
  std::array<std::uint32_t, kSideMax> lines_{};
  // Voxels of the layer that parts without a mask overwrite.
  std::array<LineBits, kSideMax> covered_{};
  LineBuffer before_, after_;
};

// Gives the voxels of the spans that `mask` admits this material. Requires ascending spans, none
// before the cursor.
template <class Runs>
void walk_spans(RunCursor<Runs>& cursor, const Mask& mask, Material material,
                std::span<const IndexSpan> spans, ChangeTally& tally) {
  for (const IndexSpan& span : spans) {
    cursor.seek(span.first);
    for (VoxelIndex at = span.first; at < span.last;) {
      const VoxelIndex end = std::min(cursor.end(), span.last);
      const Material before = cursor.material();
      if (before != material && mask.admits(before)) tally.stretch(at, end, before, material);
      at = end;
      if (at < span.last) cursor.next();
    }
  }
}

}  // namespace

void sweep_changes(const RunChunk& chunk, ApplyScratch& scratch, ChangeTally& tally) {
  chunk.runs.visit([&]<class Runs>(Runs runs) {
    Sweep<Runs>(runs, ordered(chunk.extent, chunk.order), scratch, tally).run();
  });
}

void walk_changes(const RunChunk& chunk, ApplyScratch& scratch, ChangeTally& tally) {
  RUNSTONE_ASSERT(!scratch.stack.empty());
  const OrderedExtent extent = ordered(chunk.extent, chunk.order);
  scratch.spans.clear();
  chunk.runs.visit([&]<class Runs>(Runs runs) {
    RunCursor<Runs> cursor(runs);
    const StackPart& front = scratch.stack.front();
    if (front.shape.form == OrderedShape::Form::capsule) {
      // The segments of a stroke overlap and differ only in shape.
      for (const StackPart& part : scratch.stack) append_spans(part.shape, extent, scratch.spans);
      if (scratch.stack.size() > 1) unite_spans(scratch.spans, 0);
      walk_spans(cursor, front.mask, front.material, scratch.spans, tally);
      return;
    }
    // The boxes of a paste come in index order. They do not overlap, and each has its material.
    for (const StackPart& part : scratch.stack) {
      scratch.spans.clear();
      append_spans(part.shape, extent, scratch.spans);
      walk_spans(cursor, part.mask, part.material, scratch.spans, tally);
    }
  });
}

void walk_paste(const RunChunk& chunk, VoxelPos origin, const EditDescriptor& edit,
                ApplyScratch& scratch, ChangeTally& tally) {
  RUNSTONE_DASSERT(std::holds_alternative<Paste>(edit.shape) && validate(edit).has_value());
  const OrderedExtent extent = ordered(chunk.extent, chunk.order);
  chunk.runs.visit([&]<class Runs>(Runs runs) {
    RunCursor<Runs> cursor(runs);
    // The boxes come in index order and do not overlap.
    for_each_part(edit, origin, chunk.extent, chunk.order,
                  [&](const OrderedShape& box, Material material) {
                    scratch.spans.clear();
                    append_spans(box, extent, scratch.spans);
                    walk_spans(cursor, edit.mask, material, scratch.spans, tally);
                  });
  });
}

}  // namespace runstone
