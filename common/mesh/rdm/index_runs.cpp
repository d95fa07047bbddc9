#include "common/mesh/rdm/index_runs.hpp"

// The rest of this file is compiled once per instruction set. Highway selects one at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "common/mesh/rdm/index_runs.cpp"
#include <hwy/foreach_target.h>
// Highway requires these includes after foreach_target.h.
#include <hwy/highway.h>

#include <array>
#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace runstone::rdm {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_EMU128 && HWY_TARGET != HWY_SCALAR && !HWY_HAVE_SCALABLE
using Lanes = hn::CappedTag<std::uint16_t, 32>;
static_assert(sizeof(Material) == sizeof(std::uint16_t));

/// Returns the materials of as many runs as a vector has lanes, from run `i` on.
HWY_INLINE hn::Vec<Lanes> materials_at(const NarrowRuns& runs, std::size_t i) {
  const Lanes d;
  // The second half of each PackedRun is its material.
  const auto* words = reinterpret_cast<const std::uint16_t*>(runs.packed().data() + i);
  return hn::ConcatOdd(d, hn::LoadU(d, words + hn::Lanes(d)), hn::LoadU(d, words));
}
HWY_INLINE hn::Vec<Lanes> materials_at(const WideRuns& runs, std::size_t i) {
  return hn::LoadU(Lanes(), runs.materials().data() + i);
}

/// The materials of a palette and their indices, while they are few.
class FewMaterials {
 public:
  /// More than these are looked up one by one.
  static constexpr std::size_t kMax = 16;

  /// Takes over the materials that were added to the palette. Returns false if they are too many.
  bool follow(const ChunkPalette& palette) {
    const std::span<const Material> seen = palette.seen();
    if (seen.size() > kMax) return false;
    for (; count_ < seen.size(); ++count_) {
      material_[count_] = seen[count_];
      index_[count_] = index_as<BytePaletteIndex>(palette.index(seen[count_]));
    }
    return true;
  }

  /// Writes the indices of two vectors of materials. Returns false, and writes nothing, if one of
  /// them is none of the few.
  HWY_INLINE bool find(hn::Vec<Lanes> a, hn::Vec<Lanes> b, BytePaletteIndex* out) const {
    const Lanes d;
    const auto none = hn::Set(d, kNone);
    auto index_a = none, index_b = none;
    for (std::size_t k = 0; k < count_; ++k) {
      const auto material = hn::Set(d, material_[k]), index = hn::Set(d, index_[k]);
      index_a = hn::IfThenElse(hn::Eq(a, material), index, index_a);
      index_b = hn::IfThenElse(hn::Eq(b, material), index, index_b);
    }
    if (!hn::AllFalse(d, hn::Eq(hn::Max(index_a, index_b), none))) return false;
    store(index_a, out);
    store(index_b, out + hn::Lanes(d));
    return true;
  }

 private:
  static constexpr std::uint16_t kNone = 0xffff;

  static HWY_INLINE void store(hn::Vec<Lanes> index, BytePaletteIndex* out) {
    const hn::RebindToSigned<Lanes> words;
    const hn::Rebind<BytePaletteIndex, Lanes> bytes;
    hn::StoreU(hn::DemoteTo(bytes, hn::BitCast(words, index)), bytes, out);
  }

  std::size_t count_ = 0;
  std::array<std::uint16_t, kMax> material_{}, index_{};
};

template <class Runs>
void list(const Runs& runs, const VisibilityTable& visibility, ChunkPalette& palette,
          BytePaletteIndex* out) {
  const std::size_t size = runs.size(), lanes = hn::Lanes(Lanes()), step = 2 * lanes;
  FewMaterials few;
  std::size_t i = 0;
  for (; i + step <= size && few.follow(palette); i += step) {
    if (!few.find(materials_at(runs, i), materials_at(runs, i + lanes), out + i)) {
      palette.list(runs, i, i + step, visibility, out);
    }
  }
  palette.list(runs, i, size, visibility, out);
}
#else
template <class Runs>
void list(const Runs& runs, const VisibilityTable& visibility, ChunkPalette& palette,
          BytePaletteIndex* out) {
  palette.list(runs, 0, runs.size(), visibility, out);
}
#endif

void index_narrow(const NarrowRuns& runs, const VisibilityTable& visibility, ChunkPalette& palette,
                  BytePaletteIndex* out) {
  list(runs, visibility, palette, out);
}
void index_wide(const WideRuns& runs, const VisibilityTable& visibility, ChunkPalette& palette,
                BytePaletteIndex* out) {
  list(runs, visibility, palette, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace runstone::rdm
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace runstone::rdm {

HWY_EXPORT(index_narrow);
HWY_EXPORT(index_wide);

void index_runs(const NarrowRuns& runs, const VisibilityTable& visibility, ChunkPalette& palette,
                BytePaletteIndex* out) {
  HWY_DYNAMIC_DISPATCH(index_narrow)(runs, visibility, palette, out);
}
void index_runs(const WideRuns& runs, const VisibilityTable& visibility, ChunkPalette& palette,
                BytePaletteIndex* out) {
  HWY_DYNAMIC_DISPATCH(index_wide)(runs, visibility, palette, out);
}

}  // namespace runstone::rdm
#endif
