#include "common/tiles/veil.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "common/runs/bit_row.hpp"
#include "common/runs/run_cursor.hpp"
#include "common/tiles/run_sink.hpp"

namespace runstone {
namespace tiles {
namespace {

/// The opaque voxels of three layers, a row for each line. Layer s lies in rows[s % 3].
template <class Row>
using OpaqueLayers = std::array<std::vector<Row>, 3>;

}  // namespace
}  // namespace tiles

struct VeilScratch::State {
  tiles::OpaqueLayers<Row64> narrow;
  tiles::OpaqueLayers<Row128> wide;
  tiles::RunSink sink;
};

VeilScratch::VeilScratch() : state_(std::make_unique<State>()) {}
VeilScratch::~VeilScratch() = default;
VeilScratch::VeilScratch(VeilScratch&&) noexcept = default;
VeilScratch& VeilScratch::operator=(VeilScratch&&) noexcept = default;

namespace tiles {
namespace {

/// Reads the next layer, which begins at voxel `first`. The cursor's run reaches that voxel.
template <class Row, class Runs>
void read_opaque(RunCursor<Runs>& cursor, std::uint32_t first, const OrderedExtent& e,
                 const VisibilityTable& visibility, std::vector<Row>& rows) {
  rows.assign(e.m, 0);
  const std::uint32_t end = first + e.layer();
  for (std::uint32_t at = first; at < end;) {
    if (cursor.end() == at) cursor.next();
    const std::uint32_t last = std::min(cursor.end(), end);
    if (visibility[cursor.material()] == Visibility::opaque) {
      const std::uint32_t line = (at - first) / e.f, last_line = (last - first) / e.f;
      const unsigned from = (at - first) % e.f, to = (last - first) % e.f;
      if (line == last_line) {
        rows[line] |= bits_below<Row>(to) & ~bits_below<Row>(from);
      } else {
        rows[line] |= bits_below<Row>(e.f) & ~bits_below<Row>(from);
        std::fill(rows.begin() + line + 1, rows.begin() + last_line, bits_below<Row>(e.f));
        if (to != 0) rows[last_line] |= bits_below<Row>(to);
      }
    }
    at = last;
  }
}

/// Appends the veiled runs to the sink. Returns true if they differ from the tile's.
template <class Row, class Runs>
bool veil_runs(Runs runs, const OrderedExtent& e, const VisibilityTable& visibility,
               OpaqueLayers<Row>& opaque, RunSink& sink) {
  RunCursor<Runs> reader(runs);
  std::size_t run = 0;
  std::uint32_t begin = 0;  // of the run
  bool is_changed = false;
  read_opaque(reader, 0, e, visibility, opaque[0]);
  for (std::uint32_t s = 0; s < e.s; ++s) {
    const std::uint32_t first = s * e.layer();
    if (s + 1 < e.s) read_opaque(reader, first + e.layer(), e, visibility, opaque[(s + 1) % 3]);
    const bool is_border = s == 0 || s + 1 == e.s;
    const std::vector<Row>& rows = opaque[s % 3];
    for (; run < runs.size() && begin < first + e.layer(); begin = runs.end(run++)) {
      // Of each run, only the first voxel that keeps its material matters: all behind it have the
      // same.
      const std::uint32_t line = (begin - first) / e.f;
      std::uint32_t keeps = begin;
      if (!is_border && line != 0 && line + 1 != e.m) {
        const unsigned from = begin - first - line * e.f;
        const Row row = rows[line];
        const Row veiled = row & (row << 1) & (row >> 1) & rows[line - 1] & rows[line + 1] &
                           opaque[(s + 2) % 3][line] & opaque[(s + 1) % 3][line];
        // The last voxel of a line keeps its material, so there is such a voxel in the line.
        keeps = begin - from + lowest_bit(Row(~veiled & ~bits_below<Row>(from)));
      }
      is_changed = is_changed || keeps != begin;
      if (keeps < runs.end(run)) sink.append(keeps, runs.material(run));
    }
  }
  return is_changed;
}

}  // namespace
}  // namespace tiles

std::optional<RunChunk> veiled(const RunChunk& tile, const VisibilityTable& visibility,
                               VeilScratch& scratch) {
  if (tile.is_uniform()) return std::nullopt;
  VeilScratch::State& state = scratch.state();
  const OrderedExtent e = ordered(tile.extent, tile.order);
  state.sink.clear();
  const bool is_changed = tile.runs.visit([&](auto runs) {
    if (e.f <= kRowBits<Row64>)
      return tiles::veil_runs(runs, e, visibility, state.narrow, state.sink);
    return tiles::veil_runs(runs, e, visibility, state.wide, state.sink);
  });
  if (!is_changed) return std::nullopt;
  return RunChunk{tile.extent, tile.order, state.sink.runs_of(tile.volume())};
}

}  // namespace runstone
