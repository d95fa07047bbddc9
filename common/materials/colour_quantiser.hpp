// ColourQuantiser: at most 1,024 colours for the colours of a picture or of a surface. It counts
// colours in bins of 5 bits a channel, and cuts the bins by medians. Few colours stay exact.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace runstone {

inline constexpr std::size_t kQuantisedColoursMax = 1024;

class ColourQuantiser {
 public:
  using Rgb = std::array<std::uint8_t, 3>;

  ColourQuantiser() : bins_(std::size_t{1} << 15) {}
  /// Counts a colour `times` times. Cost: O(log colours_max).
  void add(Rgb colour, std::uint64_t times = 1);
  /// Chooses `colours_max` colours at most. Requires 1 .. kQuantisedColoursMax. Deterministic.
  /// Cost: O(bins * colours).
  void choose(std::size_t colours_max);
  /// Returns the chosen colours, and the index of the one for a colour that was added. Requires
  /// choose() before.
  const std::vector<Rgb>& colours() const { return colours_; }
  std::uint16_t index_of(Rgb colour) const;

 private:
  struct Bin {
    std::uint64_t count = 0;
    std::array<std::uint64_t, 3> sums{};
    std::uint16_t index = 0;
  };
  std::vector<Bin> bins_;
  std::map<Rgb, std::uint16_t> exact_;  // as long as they are few
  bool is_exact_ = true;
  std::vector<Rgb> colours_;
};

}  // namespace runstone
