#include "common/tiles/tile_builder.hpp"

#include <algorithm>
#include <optional>
#include <type_traits>
#include <vector>

#include "common/core/assert.hpp"
#include "common/runs/line_starts.hpp"
#include "common/runs/run_cursor.hpp"
#include "common/runs/run_sink.hpp"
#include "common/tiles/exposure.hpp"
#include "common/tiles/layer_rows.hpp"

namespace runstone {

struct TileScratch::State {
  std::array<tiles::LayerRows, 4> layers;  // layer t of the children lies in layers[t % 4]
  tiles::LayerRows outside;
  tiles::ExposureSweep sweep;
  tiles::MostExposed most_exposed;
  RunSink sink;
  RunChunk empty;                         // for children that are null
  std::array<LineStarts, 8> line_starts;  // of the children in another axis order
};

TileScratch::TileScratch() : state_(std::make_unique<State>()) {}
TileScratch::~TileScratch() = default;
TileScratch::TileScratch(TileScratch&&) noexcept = default;
TileScratch& TileScratch::operator=(TileScratch&&) noexcept = default;

namespace tiles {
namespace {

/// The rows of one line while its segments are added.
template <std::size_t kWords>
struct LineRow {
  std::array<Row64, kWords> changes{}, opaque{}, solid{};
  bool is_opaque = false, is_solid = false;  // of the segment that was added last

  /// Adds a segment that begins at `at` and reaches to the end of the line.
  void add(unsigned at, Visibility kind) {
    const bool now_opaque = kind == Visibility::opaque, now_solid = kind != Visibility::empty;
    const Row64 flip_opaque = is_opaque != now_opaque ? ~Row64{0} : 0;
    const Row64 flip_solid = is_solid != now_solid ? ~Row64{0} : 0;
    is_opaque = now_opaque;
    is_solid = now_solid;
    if constexpr (kWords == 1) {
      changes[0] |= Row64{1} << at;
      opaque[0] ^= flip_opaque & (~Row64{0} << at);
      solid[0] ^= flip_solid & (~Row64{0} << at);
    } else {
      changes[at / 64] |= Row64{1} << at % 64;
      opaque[at / 64] ^= flip_opaque & (~Row64{0} << at % 64);
      solid[at / 64] ^= flip_solid & (~Row64{0} << at % 64);
      for (std::size_t w = at / 64 + 1; w < kWords; ++w) {
        opaque[w] ^= flip_opaque;
        solid[w] ^= flip_solid;
      }
    }
  }
};

/// A child, read line by line: its runs, or the starts of its lines if it has another axis order.
template <class Runs>
struct ChildReader {
  RunCursor<Runs> cursor;
  const LineStarts* lines;  // null: the runs
};

/// Reads the layers of eight children, in order, into bit rows.
template <unsigned kEdge, class Runs>
class LayerReader {
 public:
  static constexpr std::size_t kWords = (2 * kEdge + 63) / 64;

  LayerReader(std::array<ChildReader<Runs>, 8> children, AxisOrder order,
              const VisibilityTable& visibility)
      : children_(children), visibility_(visibility) {
    const auto axes = axes_of(order);
    for (std::size_t i = 0; i < 3; ++i) step_[i] = std::size_t{1} << static_cast<unsigned>(axes[i]);
  }

  /// Reads the next layer.
  void read(LayerRows& out) {
    const std::size_t half = layer_ / kEdge * step_[2];
    const std::uint32_t layer = layer_ % kEdge;
    ++layer_;
    const std::array<ChildReader<Runs>*, 4> parts = {&children_[half], &children_[half + step_[0]],
                                                     &children_[half + step_[1]],
                                                     &children_[half + step_[0] + step_[1]]};
    std::array<std::optional<Material>, 4> only;
    for (std::size_t i = 0; i < 4; ++i) only[i] = only_material(*parts[i], layer);
    const bool is_uniform =
        only[0] && only[0] == only[1] && only[0] == only[2] && only[0] == only[3];
    if (is_uniform) return out.make_uniform(*only[0]);
    out.is_uniform = out.has_same_before = false;
    out.has_rows = true;
    out.transparent = {};
    end_ = out.materials.data();
    read_half(layer, 0, *parts[0], *parts[1], out);
    read_half(layer, kEdge, *parts[2], *parts[3], out);
    out.find_same_in_layer();
  }

 private:
  /// Returns the material of a layer of a child if one run, or lines of one segment, show that it
  /// has only one.
  static std::optional<Material> only_material(ChildReader<Runs>& child, std::uint32_t layer) {
    if (child.lines != nullptr) {
      const auto starts = child.lines->lines(std::size_t{layer} * kEdge, kEdge);
      if (starts.size() != kEdge) return std::nullopt;
      const Material first = starts[0].material;
      for (const LineStart& start : starts) {
        if (start.material != first) return std::nullopt;
      }
      return first;
    }
    const std::uint32_t begin = layer * kEdge * kEdge;
    if (child.cursor.end() == begin) child.cursor.next();
    if (child.cursor.end() < begin + kEdge * kEdge) return std::nullopt;
    return child.cursor.material();
  }

  /// The state of the inner loop, as local variables.
  struct Segments {
    const Visibility* visibility;
    Material* end;  // behind the last segment
    TransparentMaterials transparent;

    void add(LineRow<kWords>& row, unsigned at, Material material) {
      const Visibility kind = visibility[material];
      row.add(at, kind);
      *end++ = material;
      if (kind == Visibility::transparent) transparent.add(material);
    }
    /// Adds the segments of line `line` of a child (numbered over all layers) from place `at` of
    /// the row on.
    void add_part(LineRow<kWords>& row, std::size_t line, unsigned at, ChildReader<Runs>& child) {
      if (child.lines != nullptr) {
        const auto starts = child.lines->line(line);
        if (at == 0 || end[-1] != starts[0].material) add(row, at, starts[0].material);
        for (const LineStart& start : starts.subspan(1)) add(row, start.at + at, start.material);
        return;
      }
      RunCursor<Runs>& cursor = child.cursor;
      const auto start = static_cast<std::uint32_t>(line) * kEdge;
      if (cursor.end() == start) cursor.next();
      if (at == 0 || end[-1] != cursor.material()) add(row, at, cursor.material());
      for (std::uint32_t next = cursor.end(); next < start + kEdge; next = cursor.end()) {
        cursor.next();
        add(row, next - start + at, cursor.material());
      }
    }
  };

  /// Returns how many lines from `line` on one run of the child covers.
  static std::size_t covered_lines(ChildReader<Runs>& child, std::size_t line) {
    if (child.lines != nullptr) return 0;
    const auto start = static_cast<std::uint32_t>(line) * kEdge;
    if (child.cursor.end() == start) child.cursor.next();
    return (child.cursor.end() - start) / kEdge;
  }

  /// Reads the lines [first_line, first_line + kEdge) of the layer from two children, of which it
  /// is layer `layer`.
  void read_half(std::uint32_t layer, std::size_t first_line, ChildReader<Runs>& low_child,
                 ChildReader<Runs>& high_child, LayerRows& out) {
    Segments segments{visibility_.data(), end_, out.transparent};
    ChildReader<Runs> low = low_child, high = high_child;
    const std::size_t first_of_child = std::size_t{layer} * kEdge;
    for (std::size_t i = 0; i < kEdge;) {
      const std::size_t line = first_of_child + i;
      const auto first_segment = static_cast<std::uint32_t>(segments.end - out.materials.data());
      LineRow<kWords> row;
      // Lines that single runs of both children cover are equal.
      std::size_t count = std::min(covered_lines(low, line), covered_lines(high, line));
      if (count != 0) {
        count = std::min<std::size_t>(count, kEdge - i);
        segments.add(row, 0, low.cursor.material());
        if (high.cursor.material() != low.cursor.material())
          segments.add(row, kEdge, high.cursor.material());
      } else {
        count = 1;
        segments.add_part(row, line, 0, low);
        segments.add_part(row, line, kEdge, high);
      }
      for (; count > 0; --count, ++i) {
        out.first_segment[first_line + i] = first_segment;
        for (std::size_t w = 0; w < kWords; ++w) {
          out.changes.at(first_line + i, w) = row.changes[w];
          out.opaque.at(first_line + i, w) = row.opaque[w];
          out.solid.at(first_line + i, w) = row.solid[w];
        }
      }
    }
    low_child = low;
    high_child = high;
    end_ = segments.end;
    out.transparent = segments.transparent;
  }

  std::array<ChildReader<Runs>, 8> children_;
  const VisibilityTable& visibility_;
  std::array<std::size_t, 3> step_{};  // in the number of a child, along each axis of the order
  std::uint32_t layer_ = 0;
  Material* end_ = nullptr;  // behind the last segment of the layer
};

/// Returns the number of set bits. On processors without an instruction for it, bit_count() is a
/// call, which costs a tenth of the time of a tile. Source: Hacker's Delight, 5-1.
constexpr unsigned count_bits(Row64 row) {
  row -= row >> 1 & 0x5555'5555'5555'5555;
  row = (row & 0x3333'3333'3333'3333) + (row >> 2 & 0x3333'3333'3333'3333);
  row = (row + (row >> 4)) & 0x0f0f'0f0f'0f0f'0f0f;
  return static_cast<unsigned>(row * 0x0101'0101'0101'0101 >> 56);
}

/// Writes the layers of a tile from the most exposed voxels of their cells.
template <unsigned kEdge>
class LayerWriter {
 public:
  static constexpr std::size_t kWords = (2 * kEdge + 63) / 64;
  static constexpr Row64 kCells = kEdge < 32 ? Row64{0x5555'5555} : Row64{0x5555'5555'5555'5555};

  explicit LayerWriter(RunSink& sink) : sink_(sink) {}

  /// Appends layer `s` of the tile.
  void write(std::uint32_t s, const LayerWindow& window, const MostExposed& most_exposed) {
    for (std::size_t m = 0; m < kEdge; ++m)
      write_line((s * kEdge + static_cast<std::uint32_t>(m)) * kEdge, window, most_exposed, m);
  }

 private:
  void write_line(std::uint32_t start, const LayerWindow& window, const MostExposed& most_exposed,
                  std::size_t m) {
    // The four lines of the cells, by m + 2 * s.
    std::array<const Material*, 4> materials;
    std::array<std::array<Row64, kWords>, 4> changes;
    std::array<Row64, kWords> any{};
    for (std::size_t i = 0; i < 4; ++i) {
      const LayerRows& layer = *window.middle[i >> 1];
      const std::size_t line = 2 * m + (i & 1);
      materials[i] = layer.materials.data() + layer.first_segment[line];
      for (std::size_t w = 0; w < kWords; ++w) {
        changes[i][w] = layer.changes.at(line, w);
        any[w] |= changes[i][w];
      }
    }
    Row64 more = any[0] ^ 1;
    for (std::size_t w = 1; w < kWords; ++w) more |= any[w];
    if (more == 0 && *materials[0] == *materials[1] && *materials[0] == *materials[2] &&
        *materials[0] == *materials[3]) {
      return sink_.append(start, *materials[0]);
    }
    Row64 carry = 0;                              // the change at the last voxel of the word before
    Row64 carry_f = 0, carry_m = 0, carry_s = 0;  // the place in the last cell of the word before
    for (std::size_t w = 0; w < kWords; ++w) {
      const Row64 f = most_exposed.f[m + w * kEdge], along_m = most_exposed.m[m + w * kEdge],
                  along_s = most_exposed.s[m + w * kEdge];
      // A cell differs from the one before it only if a line changes between the two pairs of
      // voxels or the place of the most exposed voxel differs.
      const Row64 moved = (f ^ (f << 2 | carry_f)) | (along_m ^ (along_m << 2 | carry_m)) |
                          (along_s ^ (along_s << 2 | carry_s));
      const Row64 changed = any[w] | any[w] >> 1 | any[w] << 1 | carry;
      for (Row64 cells = (changed | moved) & kCells; cells != 0; cells &= cells - 1) {
        const unsigned at = lowest_bit(cells);
        const auto line = static_cast<std::size_t>((along_m >> at & 1) | (along_s >> at & 1) << 1);
        const unsigned voxel = at + static_cast<unsigned>(f >> at & 1);
        const unsigned segment = count_bits(changes[line][w] & (~Row64{0} >> (63 - voxel)));
        // materials[line] is one segment before the first one that begins in this word, or behind.
        const auto cell = static_cast<std::uint32_t>(w * 32 + at / 2);
        sink_.append(start + cell, *(materials[line] + segment - 1));
      }
      carry = any[w] >> 63;
      carry_f = f >> 62 & 1;
      carry_m = along_m >> 62 & 1;
      carry_s = along_s >> 62 & 1;
      if constexpr (kWords > 1) {
        for (std::size_t i = 0; i < 4; ++i) materials[i] += count_bits(changes[i][w]);
      }
    }
  }

  RunSink& sink_;
};

template <unsigned kEdge, class Runs>
void build_layers(const TileChildren& children, AxisOrder order, const VisibilityTable& visibility,
                  TileScratch::State& state) {
  const auto child = [&](std::size_t i) -> ChildReader<Runs> {
    const bool is_turned = children[i]->order != order && !children[i]->is_uniform();
    if (is_turned) state.line_starts[i].read(*children[i], order);
    return children[i]->runs.visit([&](auto runs) -> ChildReader<Runs> {
      if constexpr (std::is_same_v<decltype(runs), Runs>) {
        return {RunCursor<Runs>(runs), is_turned ? &state.line_starts[i] : nullptr};
      } else {
        assertion_failed("runs in the form of their volume", __FILE__, __LINE__);
      }
    });
  };
  LayerReader<kEdge, Runs> reader(
      {child(0), child(1), child(2), child(3), child(4), child(5), child(6), child(7)}, order,
      visibility);
  LayerWriter<kEdge> writer(state.sink);
  for (LayerRows& layer : state.layers) layer.reset(kEdge);
  state.outside.reset(kEdge);
  state.outside.make_outside();
  state.sweep.reset(kEdge);
  state.sink.clear();
  reader.read(state.layers[0]);
  for (std::uint32_t s = 0; s < kEdge; ++s) {
    LayerRows& own0 = state.layers[2 * s % 4];
    LayerRows& own1 = state.layers[(2 * s + 1) % 4];
    LayerRows& before = s == 0 ? state.outside : state.layers[(2 * s + 3) % 4];
    LayerRows& behind = s + 1 == kEdge ? state.outside : state.layers[(2 * s + 2) % 4];
    reader.read(own1);
    if (s + 1 != kEdge) reader.read(behind);
    if (own0.is_uniform && own1.is_uniform && own0.material == own1.material) {
      state.sink.append(s * kEdge * kEdge, own0.material);
      continue;
    }
    for (LayerRows* layer : {&before, &own0, &own1, &behind}) layer->make_rows(visibility);
    own0.find_same_before(before);
    own1.find_same_before(own0);
    behind.find_same_before(own1);
    const LayerWindow window{&before, {&own0, &own1}, &behind};
    state.sweep.find(window, order, state.most_exposed);
    writer.write(s, window, state.most_exposed);
  }
}

/// Returns true if all children are of the same single material.
bool is_uniform(const TileChildren& children) {
  return std::all_of(children.begin(), children.end(), [&](const RunChunk* child) {
    return child->is_uniform() && child->runs.material(0) == children[0]->runs.material(0);
  });
}

}  // namespace
}  // namespace tiles

RunChunk build_tile(const TileChildren& children, unsigned edge, AxisOrder order,
                    const VisibilityTable& visibility, TileScratch& scratch) {
  RUNSTONE_ASSERT(edge == 16 || edge == 32 || edge == 64 || edge == 128);
  const Extent extent = Extent::cube(edge);
  TileScratch::State& state = scratch.state();
  if (state.empty.extent != extent || state.empty.runs.size() == 0)
    state.empty = uniform_chunk(extent, kEmpty);
  TileChildren all = children;
  for (const RunChunk*& child : all) {
    if (child == nullptr) child = &state.empty;
    RUNSTONE_ASSERT(child->extent == extent);
  }
  if (tiles::is_uniform(all)) return uniform_chunk(extent, all[0]->runs.material(0), order);
  switch (edge) {
    case 16:
      tiles::build_layers<16, NarrowRuns>(all, order, visibility, state);
      break;
    case 32:
      tiles::build_layers<32, NarrowRuns>(all, order, visibility, state);
      break;
    case 64:
      tiles::build_layers<64, WideRuns>(all, order, visibility, state);
      break;
    default:
      tiles::build_layers<128, WideRuns>(all, order, visibility, state);
      break;
  }
  return {extent, order, state.sink.runs_of(extent.volume())};
}

}  // namespace runstone
