// QuadBins: quads in the order in which strips end, sorted at last into the passes and layers of a ChunkMesh.
// A counting sort: stable, so that the order within a layer is the order of arrival, and without allocation
// once the buffers have grown.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/core/coords.hpp"
#include "common/mesh/chunk_mesh.hpp"
#include "common/mesh/quad.hpp"
#include "common/mesh/rdm/strip_table.hpp"
#include "common/mesh/visibility.hpp"

namespace runstone::rdm {

/// How strips of one direction lie: which axis they run along, which axis their rows go up. Turns a strip
/// into packed bits with shifts alone.
class QuadShape {
 public:
  /// Requires three different axes: that of the direction, `strip` and `row`.
  constexpr QuadShape(Direction direction, Axis strip, Axis row)
      : base_(static_cast<std::uint64_t>(direction) << 35),
        layer_shift_(7 * static_cast<unsigned>(axis_of(direction))),
        strip_shift_(7 * static_cast<unsigned>(strip)),
        row_shift_(7 * static_cast<unsigned>(row)),
        length_shift_(u_axis_of(axis_of(direction)) == strip ? 21 : 28),
        rows_shift_(u_axis_of(axis_of(direction)) == strip ? 28 : 21) {}

  /// The quad of strip [begin, strip.end) in rows [strip.row_first, strip.row_end) of one layer.
  constexpr Quad quad(std::uint32_t layer, std::uint32_t begin, const Strip& strip) const {
    return {base_ | std::uint64_t{layer} << layer_shift_ | std::uint64_t{begin} << strip_shift_ |
            std::uint64_t{strip.row_first} << row_shift_ |
            std::uint64_t{strip.end - begin - 1} << length_shift_ |
            std::uint64_t{strip.row_end - std::uint32_t{strip.row_first} - 1} << rows_shift_ |
            std::uint64_t{strip.material} << 38};
  }

 private:
  std::uint64_t base_;
  unsigned layer_shift_, strip_shift_, row_shift_, length_shift_, rows_shift_;
};

class QuadBins {
 public:
  /// Puts a quad to the others of its pass. Requires a material that is not empty.
  void put(Quad quad, Visibility visibility) {
    Pass& pass = visibility == Visibility::transparent ? transparent_ : opaque_;
    pass.quads.push_back(quad);
    ++pass.count[bin_of(quad)];
  }

  /// Replaces `out` by all quads put since the last call, and forgets them. O(quads + bins).
  void finish(ChunkMesh& out) {
    sort(opaque_, out.opaque);
    sort(transparent_, out.transparent);
  }

 private:
  static constexpr std::size_t kBins = kDirectionCount * kSideMax;  // as in QuadLayers::first
  struct Pass {
    std::vector<Quad> quads;
    std::array<std::uint32_t, kBins> count{};
  };

  static std::size_t bin_of(Quad quad) {
    const std::uint64_t direction = quad.bits >> 35 & 7;
    return static_cast<std::size_t>(direction * kSideMax + (quad.bits >> (7 * (direction >> 1)) & 127));
  }

  static void sort(Pass& pass, QuadLayers& out) {
    if (pass.quads.empty()) return out.clear();
    std::uint32_t first = 0;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      out.first[bin] = first;
      first += pass.count[bin];
      pass.count[bin] = out.first[bin];  // from here on the place of the bin's next quad
    }
    out.first[kBins] = first;
    out.quads.resize(pass.quads.size());
    for (const Quad quad : pass.quads) out.quads[pass.count[bin_of(quad)]++] = quad;
    pass.quads.clear();
    pass.count.fill(0);
  }

  Pass opaque_;
  Pass transparent_;
};

}  // namespace runstone::rdm
