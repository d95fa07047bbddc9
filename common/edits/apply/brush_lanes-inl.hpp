// Brush: the mask and the material of one edit as vectors. It draws over stretches of a line
// without a branch on mask or material. Highway includes this file once per instruction set,
// outside of any namespace.
#if defined(RUNSTONE_EDITS_BRUSH_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef RUNSTONE_EDITS_BRUSH_LANES_INL
#undef RUNSTONE_EDITS_BRUSH_LANES_INL
#else
#define RUNSTONE_EDITS_BRUSH_LANES_INL
#endif

#include <hwy/highway.h>

#include <array>
#include <cstdint>
#include <cstring>

#include "common/core/ids.hpp"
#include "common/edits/apply/layer_canvas.hpp"
#include "common/edits/apply/line_bits.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"

HWY_BEFORE_NAMESPACE();
namespace runstone {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The voxels of one vector, at most the voxels of a canvas block.
using Voxels = hn::CappedTag<Material, LayerCanvas::kBlock>;

class Brush {
 public:
  Brush(const Mask& mask, Material material)
      : material_(material),
        looked_at_(mask.kind == MaskKind::everything ? kEmpty : Material{0xffff}),
        wanted_(mask.kind == MaskKind::only_material ? mask.material : kEmpty),
        refused_(mask.kind == MaskKind::only_solid ? 1 : 0) {}

  static std::int32_t lanes() { return static_cast<std::int32_t>(hn::Lanes(Voxels())); }

  /// Draws the voxels [first, last) of a line of the canvas, and nothing if last <= first. Reads
  /// and writes whole vectors around them.
  HWY_INLINE void stroke(Material* line, std::int32_t first, std::int32_t last) const {
    for (std::int32_t at = first & -lanes(); at < last; at += lanes())
      stroke_at(at, line, first, last);
  }
  /// Draws the voxels [first, last) of a line of at most lanes() voxels.
  HWY_INLINE void stroke_short(Material* line, std::int32_t first, std::int32_t last) const {
    stroke_at(0, line, first, last);
  }

 private:
  HWY_INLINE void stroke_at(std::int32_t at, Material* line, std::int32_t first,
                            std::int32_t last) const {
    const Voxels voxels;
    const hn::RebindToSigned<Voxels> places;
    const auto place = hn::Iota(places, static_cast<std::int16_t>(at));
    const auto inside =
        hn::And(hn::Gt(place, hn::Set(places, static_cast<std::int16_t>(first - 1))),
                hn::Lt(place, hn::Set(places, static_cast<std::int16_t>(last))));
    const auto present = hn::Load(voxels, line + at);
    const auto same =
        hn::Eq(hn::And(present, hn::Set(voxels, looked_at_)), hn::Set(voxels, wanted_));
    const auto admitted =
        hn::Xor(same, hn::Eq(hn::Set(voxels, refused_), hn::Set(voxels, Material{1})));
    const auto written = hn::And(hn::RebindMask(voxels, inside), admitted);
    hn::Store(hn::IfThenElse(written, hn::Set(voxels, material_), present), voxels, line + at);
  }

  // A voxel is written if (present & looked_at) == wanted. If refused is 1, it is written if they
  // differ.
  Material material_, looked_at_, wanted_, refused_;
};

/// Sets the voxels [from, stop), and up to one vector of voxels behind them. Runs are unpacked in
/// ascending order, so the next run overwrites the excess.
inline void fill_ahead(Material* from, const Material* stop, Material material) {
  const auto v = hn::Set(Voxels(), material);
  for (; from < stop; from += Brush::lanes()) hn::StoreU(v, Voxels(), from);
}

/// Returns the voxels i < count for which a[i] != b[i], as differing_plain() does. Reads whole
/// vectors, so both must be lines of a canvas, or begin one voxel before one.
inline LineBits differing_lanes(const Material* a, const Material* b, std::uint32_t count) {
  std::array<std::uint64_t, 2> word{};
  for (std::uint32_t i = 0; i < count; i += static_cast<std::uint32_t>(Brush::lanes())) {
    const auto same = hn::Eq(hn::LoadU(Voxels(), a + i), hn::LoadU(Voxels(), b + i));
    std::array<std::uint8_t, 8> bytes{};
    hn::StoreMaskBits(Voxels(), hn::Not(same), bytes.data());
    std::uint64_t bits = 0;
    std::memcpy(&bits, bytes.data(), sizeof bits);
    word[i / 64] |= bits << (i % 64);
  }
  return LineBits{word[0], word[1]} & bits_below(count);
}

/// Copies a line of `count` voxels from canvas to canvas, and its padding.
inline void copy_line(const Material* from, Material* to, std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; i += static_cast<std::uint32_t>(Brush::lanes()))
    hn::Store(hn::Load(Voxels(), from + i), Voxels(), to + i);
}

}  // namespace HWY_NAMESPACE
}  // namespace runstone
HWY_AFTER_NAMESPACE();

#endif
