// PackedLongs: small numbers of equal width in 64-bit longs, low bits first, none across two longs.
// Minecraft keeps and sends the voxels of a section in this form (since 1.16), as indices into its
// palette.
#pragma once
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace runstone::bench {

/// A section with more bits has no palette: its numbers are the ids themselves.
inline constexpr unsigned kPaletteBitsMax = 8;

/// Returns the bits of a number for a palette of `materials` entries: 0 for one, else at least 4.
constexpr unsigned palette_bits(std::size_t materials) {
  return materials <= 1 ? 0 : std::max(4u, static_cast<unsigned>(std::bit_width(materials - 1)));
}

class PackedLongs {
 public:
  static constexpr std::size_t kCountMax = 4096;
  PackedLongs() = default;
  /// Makes numbers that are all zero. Requires bits <= 16 and count <= kCountMax. With 0 bits there
  /// are no longs, and every number is 0.
  PackedLongs(std::size_t count, unsigned bits) { reset(count, bits); }
  void reset(std::size_t count, unsigned bits) {
    count_ = count;
    bits_ = bits;
    per_long_ = bits == 0 ? 0 : 64 / bits;
    reciprocal_ = bits == 0 ? 0 : (1u << kShift) / per_long_ + 1;
    longs_.assign(bits == 0 ? 0 : (count + per_long_ - 1) / per_long_, 0);
  }

  unsigned bits() const { return bits_; }
  std::span<const std::uint64_t> longs() const { return longs_; }
  /// Lets a reader fill the longs.
  std::span<std::uint64_t> longs() { return longs_; }
  std::size_t capacity() const { return longs_.capacity(); }

  /// Requires bits() > 0, as set() does.
  std::uint32_t operator[](std::size_t i) const {
    const Place place = place_of(i);
    return static_cast<std::uint32_t>(longs_[place.word] >> place.shift) & mask();
  }
  void set(std::size_t i, std::uint32_t value) {
    const Place place = place_of(i);
    std::uint64_t& word = longs_[place.word];
    word = (word & ~(std::uint64_t{mask()} << place.shift)) | std::uint64_t{value} << place.shift;
  }
  /// Sets every number i to value(i).
  template <class Value>
  void assign(Value&& value) {
    std::size_t i = 0;
    for (std::uint64_t& word : longs_) {
      word = 0;
      for (std::size_t k = 0; k < per_long_ && i < count_; ++k, ++i) {
        word |= std::uint64_t{value(i)} << (k * bits_);
      }
    }
  }
  /// Calls take(value) for every number in order; never if there are no bits.
  template <class Take>
  void for_each(Take&& take) const {
    std::size_t left = count_;
    for (std::uint64_t word : longs_) {
      const std::size_t here = std::min<std::size_t>(per_long_, left);
      for (std::size_t k = 0; k < here; ++k, word >>= bits_)
        take(static_cast<std::uint32_t>(word) & mask());
      left -= here;
    }
  }

 private:
  struct Place {
    std::size_t word;
    unsigned shift;
  };
  std::uint32_t mask() const { return (1u << bits_) - 1; }
  // Divides by a product with the reciprocal, as the game does. It is exact for all i below
  // kCountMax.
  Place place_of(std::size_t i) const {
    const std::size_t word = i * reciprocal_ >> kShift;
    return {word, static_cast<unsigned>(i - word * per_long_) * bits_};
  }

  static constexpr unsigned kShift = 24;
  std::vector<std::uint64_t> longs_;
  std::size_t count_ = 0;
  unsigned bits_ = 0, per_long_ = 0;
  std::uint32_t reciprocal_ = 0;
};

}  // namespace runstone::bench
