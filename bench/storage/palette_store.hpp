// PaletteStore: sections of 16 x 16 x 16 voxels, each with a palette of its materials and
// bit-packed indices, as Minecraft keeps a world in memory: no bits for a section of one material,
// then 4 to 8, and beyond 256 materials the materials themselves. A palette grows and never
// shrinks; only a rebuilt section has the fewest bits. x is the fastest axis, then z, then y.
// Source: wiki.vg, "Chunk Format".
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <utility>
#include <vector>

#include "bench/storage/heap_bytes.hpp"
#include "bench/storage/row_pieces.hpp"
#include "bench/storage/voxel_store.hpp"
#include "bench/wire/packed_longs.hpp"
#include "common/core/assert.hpp"
#include "common/runs/dense.hpp"

namespace runstone::bench::storage {

class PaletteStore {
 public:
  explicit PaletteStore(const RunChunk& chunk)
      : extent_(chunk.extent),
        side_(std::min(kSideMax, unsigned{chunk.extent.x})),
        bits_(static_cast<unsigned>(std::countr_zero(side_))),
        across_(chunk.extent.x / side_) {
    RUNSTONE_ASSERT(storable(chunk.extent));
    count_dense_expansion();
    const std::size_t volume = section_volume();
    std::vector<Material> voxels(chunk.volume());  // section by section
    const std::array<std::size_t, 3> steps = {1, std::size_t{side_} * side_, side_};
    const std::size_t step = steps[static_cast<std::size_t>(axes_of(chunk.order)[0])];
    for_each_row_piece(chunk, [&](OrderedPos first, std::uint32_t count, Material material) {
      for_each_section(first, count, [&](OrderedPos at, std::uint32_t here) {
        const LocalPos local = from_ordered(at, chunk.order);
        Material* to = voxels.data() + section_of(local) * volume + cell_of(local);
        for (; here > 0; --here, to += step) *to = material;
      });
    });
    sections_.resize(voxels.size() / volume);
    for (std::size_t s = 0; s < sections_.size(); ++s) {
      sections_[s].assign(std::span(voxels).subspan(s * volume, volume));
    }
  }

  Material at(LocalPos at) const { return sections_[section_of(at)].at(cell_of(at)); }
  void set(LocalPos at, Material material) { fill(at, 1, material); }
  void paint(const Ball& ball, Material material) {
    ball.for_each_row(extent_, AxisOrder::xyz, [&](OrderedPos first, std::uint32_t count) {
      for_each_section(first, count, [&](OrderedPos at, std::uint32_t here) {
        fill(from_ordered(at, AxisOrder::xyz), here, material);
      });
    });
  }
  template <class F>
  void walk(F&& stretch) const {
    for (const Section& section : sections_) {
      if (section.places.bits() == 0) {
        stretch(section_volume(), section.palette[0]);
      } else if (section.is_direct()) {
        section.places.for_each([&](std::uint32_t id) { stretch(1u, static_cast<Material>(id)); });
      } else {
        section.places.for_each([&](std::uint32_t place) { stretch(1u, section.palette[place]); });
      }
    }
  }
  std::size_t byte_size() const {
    std::size_t out = sizeof *this + heap_bytes(sections_.capacity() * sizeof(Section));
    for (const Section& section : sections_) {
      out += heap_bytes(section.palette.capacity() * sizeof(Material)) +
             heap_bytes(section.places.capacity() * sizeof(std::uint64_t));
    }
    return out;
  }

 private:
  static constexpr unsigned kSideMax = 16;
  static constexpr unsigned kDirectBits = 16;

  struct Section {
    std::vector<Material> palette;  // in order of appearance; none if direct
    PackedLongs places;

    bool is_direct() const { return places.bits() == kDirectBits; }
    Material at(std::size_t cell) const {
      if (places.bits() == 0) return palette[0];
      const std::uint32_t value = places[cell];
      return is_direct() ? static_cast<Material>(value) : palette[value];
    }

    void assign(std::span<const Material> voxels) {
      std::vector<std::uint32_t> place(voxels.size());
      std::vector<Material> met;
      for (std::size_t i = 0; i < voxels.size(); ++i) {
        place[i] = i > 0 && voxels[i] == voxels[i - 1] ? place[i - 1] : place_in(met, voxels[i]);
      }
      const unsigned bits = palette_bits(met.size());
      if (bits > kPaletteBitsMax) {
        palette.clear();
        places.reset(voxels.size(), kDirectBits);
        places.assign([&](std::size_t i) { return voxels[i]; });
        return;
      }
      palette.assign(met.begin(), met.end());  // without the spare capacity
      places.reset(voxels.size(), bits);
      places.assign([&](std::size_t i) { return place[i]; });
    }

    /// Returns the value for a material in `places`. Adds bits to `places` if the palette needs
    /// them.
    std::uint32_t value_of(Material material, std::size_t volume) {
      if (is_direct()) return material;
      const std::uint32_t place = place_in(palette, material);
      const unsigned bits = palette_bits(palette.size());
      if (bits <= places.bits()) return place;
      if (bits <= kPaletteBitsMax) {
        const PackedLongs old = std::exchange(places, PackedLongs(volume, bits));
        if (old.bits() > 0) places.assign([&](std::size_t i) { return old[i]; });
        return place;
      }
      const PackedLongs old = std::exchange(places, PackedLongs(volume, kDirectBits));
      places.assign([&](std::size_t i) { return palette[old[i]]; });
      palette = std::vector<Material>();  // "= {}" would keep its memory
      return material;
    }

    /// Linear search, as in the game up to 16 materials; few sections have more.
    static std::uint32_t place_in(std::vector<Material>& palette, Material material) {
      const auto at = std::find(palette.begin(), palette.end(), material);
      const auto place = static_cast<std::uint32_t>(at - palette.begin());
      if (at == palette.end()) palette.push_back(material);
      return place;
    }
  };

  std::uint32_t section_volume() const { return side_ * side_ * side_; }
  std::size_t section_of(LocalPos at) const {
    return (at.x >> bits_) + across_ * (std::size_t{at.z} >> bits_) +
           std::size_t{across_} * across_ * (std::size_t{at.y} >> bits_);
  }
  std::size_t cell_of(LocalPos at) const {
    const unsigned low = side_ - 1;
    return (at.x & low) | (at.z & low) << bits_ | (at.y & low) << (2 * bits_);
  }

  /// Calls piece(first, count) for the parts of a row, each inside one section.
  template <class F>
  void for_each_section(OrderedPos first, std::uint32_t count, F&& piece) const {
    while (count > 0) {
      const std::uint32_t here = std::min(count, side_ - (first.f & (side_ - 1)));
      piece(first, here);
      first.f += here;
      count -= here;
    }
  }

  /// Sets `count` voxels along x, in one section.
  void fill(LocalPos first, std::uint32_t count, Material material) {
    Section& section = sections_[section_of(first)];
    const std::uint32_t value = section.value_of(material, section_volume());
    if (section.places.bits() == 0) return;  // the whole section has that material
    const std::size_t cell = cell_of(first);
    for (std::size_t i = cell; i < cell + count; ++i) section.places.set(i, value);
  }

  Extent extent_;
  unsigned side_, bits_, across_;  // of a section, in voxels; its logarithm; sections along an axis
  std::vector<Section> sections_;
};
static_assert(VoxelStore<PaletteStore>);

}  // namespace runstone::bench::storage
