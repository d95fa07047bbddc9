#include "common/mesh/rdm/layer_mesher.hpp"

#include <array>
#include <cstring>

#include "common/mesh/rdm/row_strips.hpp"

// The rest of this file is compiled once per instruction set; Highway picks one at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "common/mesh/rdm/layer_mesher.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace runstone::rdm {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Bit i: voxels a[i] and b[i] differ, i < bits; what lies behind is unspecified.
template <class Row>
HWY_INLINE Row differing(const Material* a, const Material* b, std::uint32_t bits) {
  const hn::CappedTag<Material, 32> d;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  Row out = 0;
  for (std::uint32_t i = 0; i < bits; i += kLanes) {
    std::array<std::uint8_t, 8> bytes{};
    hn::StoreMaskBits(d, hn::Ne(hn::LoadU(d, a + i), hn::LoadU(d, b + i)), bytes.data());
    std::uint32_t lanes = 0;
    std::memcpy(&lanes, bytes.data(), sizeof lanes);
    out |= Row{lanes} << i;
  }
  return out;
}

template <class Row>
void mesh(const LayerFaces<Row>& in, std::vector<Quad>& opaque, std::vector<Quad>& transparent) {
  const LayerVoxels<Row>& own = *in.own;
  const LayerVoxels<Row>& beyond = *in.beyond;
  const std::uint32_t bits = in.bits;
  const QuadShape shape = in.shape;
  std::array<Quad, kRowBits<Row>> open;
  RowStrips<Row> before;
  Row clear_before = 0;
  const auto close = [&](Row closing, Row clear, std::uint32_t row) {
    for (; closing != 0; closing &= closing - 1) {
      const unsigned end = lowest_bit(closing);
      ((clear >> end & 1) != 0 ? transparent : opaque).push_back(shape.close(open[end], row));
    }
  };
  for (std::uint32_t r = 0; r < in.rows; ++r) {
    const Material* const voxels = own.voxels() + std::size_t{r} * bits;
    const Row clear = own.clear[r];
    Row face = (own.opaque[r] | clear) & ~beyond.opaque[r];
    // Only transparent voxels look at what may be their own kind.
    if ((face & clear) != 0) {
      face &= ~clear | differing<Row>(voxels, beyond.voxels() + std::size_t{r} * bits, bits);
    }
    if ((face | before.face) == 0) continue;
    const RowStrips<Row> now = strips_along<Row>(face, differing<Row>(voxels, voxels - 1, bits));
    const Row shared = face & before.face;
    const Row x =
        changed<Row>(now, before, shared == 0 ? Row{0} : differing<Row>(voxels, voxels - bits, bits));
    close(ends_with(before, x), clear_before, r);
    for (Row opening = ends_with(now, x); opening != 0; opening &= opening - 1) {
      const unsigned end = lowest_bit(opening);
      const unsigned begin = highest_bit(now.start & (opening ^ (opening - 1)));
      open[end] = shape.open({in.layer, begin, end - begin + 1, r}, voxels[begin]);
    }
    before = now;
    clear_before = clear;
  }
  close(before.end, clear_before, in.rows);
}

void mesh_64(const LayerFaces<Row64>& in, std::vector<Quad>& opaque, std::vector<Quad>& transparent) {
  mesh(in, opaque, transparent);
}
void mesh_128(const LayerFaces<Row128>& in, std::vector<Quad>& opaque, std::vector<Quad>& transparent) {
  mesh(in, opaque, transparent);
}

}  // namespace HWY_NAMESPACE
}  // namespace runstone::rdm
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace runstone::rdm {

HWY_EXPORT(mesh_64);
HWY_EXPORT(mesh_128);

void mesh_layer(const LayerFaces<Row64>& faces, std::vector<Quad>& opaque, std::vector<Quad>& transparent) {
  HWY_DYNAMIC_DISPATCH(mesh_64)(faces, opaque, transparent);
}
void mesh_layer(const LayerFaces<Row128>& faces, std::vector<Quad>& opaque, std::vector<Quad>& transparent) {
  HWY_DYNAMIC_DISPATCH(mesh_128)(faces, opaque, transparent);
}

}  // namespace runstone::rdm
#endif
