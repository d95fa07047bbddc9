#include "common/tiles/tile_builder.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "common/core/assert.hpp"
#include "common/runs/reorder.hpp"
#include "common/runs/run_cursor.hpp"
#include "common/tiles/exposure.hpp"
#include "common/tiles/layer_rows.hpp"
#include "common/tiles/run_sink.hpp"

namespace runstone {

struct TileScratch::State {
  std::array<tiles::LayerRows, 4> layers;  // layer t of the children lies in layers[t % 4]
  tiles::LayerRows outside;
  tiles::ExposureSweep sweep;
  tiles::MostExposed most_exposed;
  tiles::RunSink sink;
  RunChunk empty;  // for children that are null
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

/// Reads the layers of eight children, in order, into bit rows.
template <unsigned kEdge, class Runs>
class LayerReader {
 public:
  static constexpr std::size_t kWords = (2 * kEdge + 63) / 64;

  LayerReader(std::array<RunCursor<Runs>, 8> cursors, AxisOrder order,
              const VisibilityTable& visibility)
      : cursors_(cursors), visibility_(visibility) {
    const auto axes = axes_of(order);
    for (std::size_t i = 0; i < 3; ++i) step_[i] = std::size_t{1} << static_cast<unsigned>(axes[i]);
  }

  /// Reads the next layer.
  void read(LayerRows& out) {
    const std::size_t half = layer_ / kEdge * step_[2];
    const std::uint32_t base = layer_ % kEdge * kEdge * kEdge;
    ++layer_;
    const std::array<RunCursor<Runs>*, 4> parts = {&cursors_[half], &cursors_[half + step_[0]],
                                                   &cursors_[half + step_[1]],
                                                   &cursors_[half + step_[0] + step_[1]]};
    bool is_uniform = true;
    for (RunCursor<Runs>* part : parts) {
      if (part->end() == base) part->next();
      is_uniform = is_uniform && part->end() >= base + kEdge * kEdge &&
                   part->material() == parts[0]->material();
    }
    if (is_uniform) return out.make_uniform(parts[0]->material());
    out.is_uniform = out.has_same_before = false;
    out.has_rows = true;
    out.transparent = {};
    out_ = &out;
    segments_ = 0;
    read_half(base, 0, *parts[0], *parts[1]);
    read_half(base, kEdge, *parts[2], *parts[3]);
    out.find_same_in_layer();
  }

 private:
  /// Reads the lines [first_line, first_line + kEdge) of the layer from two children.
  void read_half(std::uint32_t base, std::size_t first_line, RunCursor<Runs>& low,
                 RunCursor<Runs>& high) {
    for (std::size_t line = 0; line < kEdge;) {
      const std::uint32_t start = base + static_cast<std::uint32_t>(line) * kEdge;
      if (low.end() == start) low.next();
      if (high.end() == start) high.next();
      const std::size_t first_segment = segments_;
      LineRow<kWords> row;
      // Lines that single runs of both children cover are equal.
      const std::uint32_t covered = std::min(low.end(), high.end()) - start;
      std::size_t count = 1;
      if (covered >= kEdge) {
        count = std::min<std::size_t>(covered / kEdge, kEdge - line);
        add(row, 0, low.material());
        if (high.material() != low.material()) add(row, kEdge, high.material());
      } else {
        read_part(row, start, 0, low);
        read_part(row, start, kEdge, high);
      }
      for (; count > 0; --count, ++line) {
        out_->first_segment[first_line + line] = static_cast<std::uint32_t>(first_segment);
        for (std::size_t w = 0; w < kWords; ++w) {
          out_->changes.at(first_line + line, w) = row.changes[w];
          out_->opaque.at(first_line + line, w) = row.opaque[w];
          out_->solid.at(first_line + line, w) = row.solid[w];
        }
      }
    }
  }

  /// Adds the segments of one child to the line from `at` on.
  void read_part(LineRow<kWords>& row, std::uint32_t start, unsigned at, RunCursor<Runs>& cursor) {
    const std::uint32_t end = start + kEdge;
    if (at == 0 || out_->materials[segments_ - 1] != cursor.material())
      add(row, at, cursor.material());
    while (cursor.end() < end) {
      const std::uint32_t next = cursor.end() - start + at;
      cursor.next();
      add(row, next, cursor.material());
    }
  }

  void add(LineRow<kWords>& row, unsigned at, Material material) {
    const Visibility kind = visibility_[material];
    row.add(at, kind);
    out_->materials[segments_++] = material;
    if (kind == Visibility::transparent) out_->transparent.add(material);
  }

  std::array<RunCursor<Runs>, 8> cursors_;
  const VisibilityTable& visibility_;
  std::array<std::size_t, 3> step_{};  // in the number of a child, along each axis of the order
  std::uint32_t layer_ = 0;
  LayerRows* out_ = nullptr;
  std::size_t segments_ = 0;  // in out_->materials
};

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
      const LayerRows& layer = *window.own[i >> 1];
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
        const unsigned segment = bit_count(changes[line][w] & (~Row64{0} >> (63 - voxel)));
        // materials[line] is one segment before the first one that begins in this word, or behind.
        const auto cell = static_cast<std::uint32_t>(w * 32 + at / 2);
        sink_.append(start + cell, *(materials[line] + segment - 1));
      }
      carry = any[w] >> 63;
      carry_f = f >> 62 & 1;
      carry_m = along_m >> 62 & 1;
      carry_s = along_s >> 62 & 1;
      if constexpr (kWords > 1) {
        for (std::size_t i = 0; i < 4; ++i) materials[i] += bit_count(changes[i][w]);
      }
    }
  }

  RunSink& sink_;
};

template <unsigned kEdge, class Runs>
void build_layers(const TileChildren& children, AxisOrder order, const VisibilityTable& visibility,
                  TileScratch::State& state) {
  const auto cursor = [&](std::size_t i) {
    return children[i]->runs.visit([](auto runs) -> RunCursor<Runs> {
      if constexpr (std::is_same_v<decltype(runs), Runs>) {
        return RunCursor<Runs>(runs);
      } else {
        assertion_failed("runs in the form of their volume", __FILE__, __LINE__);
      }
    });
  };
  LayerReader<kEdge, Runs> reader(
      {cursor(0), cursor(1), cursor(2), cursor(3), cursor(4), cursor(5), cursor(6), cursor(7)},
      order, visibility);
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
  std::array<RunChunk, 8> reordered;
  TileChildren all = children;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i] == nullptr) {
      all[i] = &state.empty;
      continue;
    }
    RUNSTONE_ASSERT(all[i]->extent == extent);
    if (all[i]->order == order || all[i]->is_uniform()) continue;
    reordered[i] = reorder(*all[i], order);
    all[i] = &reordered[i];
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
