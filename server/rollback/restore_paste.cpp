#include "server/rollback/restore_paste.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "common/core/assert.hpp"
#include "common/edits/clipboard/clipboard_builder.hpp"

namespace runstone {
namespace {

/// A cuboid of cells along fastest, middle and slowest axis, half-open.
struct Part {
  OrderedPos first, last;
};

class Paster {
 public:
  Paster(const RunChunk& shape, VoxelPos origin, const Mask& mask, std::vector<EditDescriptor>& out)
      : order_(shape.order),
        e_(ordered(shape.extent, shape.order)),
        origin_(origin),
        mask_(mask),
        out_(out) {}

  void paste(std::span<const Difference> differences) {
    paste(differences, {{0, 0, 0}, {e_.f, e_.m, e_.s}});
  }

 private:
  VoxelIndex index(std::uint32_t f, std::uint32_t m, std::uint32_t s) const {
    return f + e_.f * (m + e_.m * s);
  }

  void paste(std::span<const Difference> differences, const Part& part) {
    const VoxelIndex first = index(part.first.f, part.first.m, part.first.s);
    const VoxelIndex last = index(part.last.f - 1, part.last.m - 1, part.last.s - 1) + 1;
    const auto begin = std::partition_point(differences.begin(), differences.end(),
                                            [&](const Difference& d) { return d.last <= first; });
    const auto end = std::partition_point(begin, differences.end(),
                                          [&](const Difference& d) { return d.first < last; });
    const std::span<const Difference> mine(begin, end);
    // A filled chunk is one difference, so its lines need not be looked at.
    if (mine.size() == 1 && mine[0].first <= first && mine[0].last >= last) {
      out_.push_back({FillBox{box(part)}, mask_, mine[0].restored});
      return;
    }
    const Part tight = bounds(mine, part);
    if (tight.first.f >= tight.last.f) return;
    if (const auto material = only_material(mine, tight)) {
      out_.push_back({FillBox{box(tight)}, mask_, *material});
      return;
    }
    ClipboardBuilder builder(extent(tight), order_);
    for_each_cell_stretch(mine, tight, [&](std::uint32_t count, std::optional<Material> cell) {
      builder.append(count, cell);
    });
    const auto clipboard = builder.finish();
    if (clipboard) return push(*clipboard, tight);
    RUNSTONE_ASSERT(clipboard.error().code == ErrorCode::limit_exceeded);
    for (const Part& half : halves(tight)) paste(mine, half);
  }

  /// Calls row(m, s, from, to, restored) for the cells [from, to) of each line of the part that a
  /// difference covers.
  template <class F>
  void for_each_row(std::span<const Difference> differences, const Part& part, F&& row) const {
    auto d = differences.begin();
    for (std::uint32_t s = part.first.s; s < part.last.s; ++s) {
      for (std::uint32_t m = part.first.m; m < part.last.m; ++m) {
        const VoxelIndex first = index(part.first.f, m, s);
        const VoxelIndex last = first + (part.last.f - part.first.f);
        while (d != differences.end() && d->last <= first) ++d;
        for (auto at = d; at != differences.end() && at->first < last; ++at) {
          row(m, s, std::max(at->first, first) - index(0, m, s),
              std::min(at->last, last) - index(0, m, s), at->restored);
        }
      }
    }
  }

  /// Returns the smallest part inside `part` that holds the differences. It is empty if there are
  /// none.
  Part bounds(std::span<const Difference> differences, const Part& part) const {
    Part tight = {part.last, part.first};
    for_each_row(
        differences, part,
        [&](std::uint32_t m, std::uint32_t s, std::uint32_t from, std::uint32_t to, Material) {
          tight.first = {std::min(tight.first.f, from), std::min(tight.first.m, m),
                         std::min(tight.first.s, s)};
          tight.last = {std::max(tight.last.f, to), std::max(tight.last.m, m + 1),
                        std::max(tight.last.s, s + 1)};
        });
    return tight;
  }

  template <class F>
  void for_each_cell_stretch(std::span<const Difference> differences, const Part& part,
                             F&& cells) const {
    const std::uint32_t width = part.last.f - part.first.f;
    const std::uint32_t height = part.last.m - part.first.m;
    std::uint32_t at = 0;
    for_each_row(
        differences, part,
        [&](std::uint32_t m, std::uint32_t s, std::uint32_t from, std::uint32_t to, Material cell) {
          const std::uint32_t line = ((s - part.first.s) * height + (m - part.first.m)) * width;
          cells(line + (from - part.first.f) - at, std::nullopt);
          cells(to - from, cell);
          at = line + (to - part.first.f);
        });
    cells(width * height * (part.last.s - part.first.s) - at, std::nullopt);
  }

  /// Returns the restored material of every cell of the part, or nullopt if they differ or a cell
  /// stays.
  std::optional<Material> only_material(std::span<const Difference> differences,
                                        const Part& part) const {
    std::optional<Material> material;
    bool is_uniform = true;
    for_each_cell_stretch(differences, part,
                          [&](std::uint32_t count, std::optional<Material> cell) {
                            if (count == 0) return;
                            is_uniform = is_uniform && cell && (!material || *material == *cell);
                            if (!material) material = cell;
                          });
    return is_uniform ? material : std::nullopt;
  }

  static std::array<Part, 2> halves(const Part& part) {
    std::array<Part, 2> both = {part, part};
    const auto split = [&](std::uint32_t OrderedPos::* axis) {
      const std::uint32_t middle = (part.first.*axis + part.last.*axis) / 2;
      both[0].last.*axis = both[1].first.*axis = middle;
    };
    if (part.last.s - part.first.s > 1) {
      split(&OrderedPos::s);
    } else {
      RUNSTONE_ASSERT(part.last.m - part.first.m > 1);  // a line of 128 cells fits any clipboard
      split(&OrderedPos::m);
    }
    return both;
  }

  /// Returns the components along x, y, z.
  std::array<std::uint32_t, 3> by_axis(const OrderedPos& p) const {
    std::array<std::uint32_t, 3> out{};
    const auto axes = axes_of(order_);
    out[static_cast<std::size_t>(axes[0])] = p.f;
    out[static_cast<std::size_t>(axes[1])] = p.m;
    out[static_cast<std::size_t>(axes[2])] = p.s;
    return out;
  }
  Extent extent(const Part& part) const {
    const auto sides = by_axis(
        {part.last.f - part.first.f, part.last.m - part.first.m, part.last.s - part.first.s});
    return {static_cast<std::uint8_t>(sides[0]), static_cast<std::uint8_t>(sides[1]),
            static_cast<std::uint8_t>(sides[2])};
  }

  VoxelPos place(const OrderedPos& p) const {
    const auto at = by_axis(p);
    return {origin_.x + static_cast<std::int32_t>(at[0]),
            origin_.y + static_cast<std::int32_t>(at[1]),
            origin_.z + static_cast<std::int32_t>(at[2])};
  }
  VoxelBox box(const Part& part) const { return {place(part.first), place(part.last)}; }

  void push(const std::shared_ptr<const Clipboard>& clipboard, const Part& part) {
    Paste paste;
    paste.at = place(part.first);
    paste.clipboard = clipboard;
    out_.push_back({paste, mask_, kEmpty});
  }

  AxisOrder order_;
  OrderedExtent e_;
  VoxelPos origin_;
  Mask mask_;
  std::vector<EditDescriptor>& out_;
};

}  // namespace

std::vector<EditDescriptor> restore_pastes(const RunChunk& now,
                                           std::span<const Difference> differences,
                                           VoxelPos origin) {
  std::vector<EditDescriptor> out;
  Paster(now, origin, {}, out).paste(differences);
  return out;
}

std::vector<EditDescriptor> careful_restore_pastes(const RunChunk& now,
                                                   std::span<const Difference> differences,
                                                   VoxelPos origin) {
  // Each voxel belongs to one group. The mask of the group names the material of the voxel before
  // any of these edits, so no group changes the voxels of another.
  std::map<Material, std::vector<Difference>> by_material;
  for (const Difference& d : differences) by_material[d.now].push_back(d);
  std::vector<EditDescriptor> out;
  for (const auto& [material, group] : by_material) {
    Paster(now, origin, {MaskKind::only_material, material}, out).paste(group);
  }
  return out;
}

}  // namespace runstone
