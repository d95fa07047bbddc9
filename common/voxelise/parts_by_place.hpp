// PartsByPlace: gives the triangles (or points) of a model that meet a band, band after band. Each
// part has a range of bands. It holds two numbers a part, not one for each band that a part meets.
// Internal to this room.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace runstone {

/// Bands first .. last, both included.
struct BandRange {
  std::int32_t first = 0, last = 0;
};

class PartsByPlace {
 public:
  /// Parts are numbered 0 .. count - 1; `bands_of(i)` is the range of part i, inside 0 .. bands -
  /// 1, and must stay valid. Cost: O(parts + bands).
  template <class F>
  PartsByPlace(std::size_t count, std::int32_t bands, F&& bands_of)
      : begins_(static_cast<std::size_t>(bands) + 1), parts_(count) {
    for (std::size_t i = 0; i < count; ++i) ++begins_[place(bands_of(i).first) + 1];
    for (std::size_t i = 1; i < begins_.size(); ++i) begins_[i] += begins_[i - 1];
    std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
    for (std::size_t i = 0; i < count; ++i)
      parts_[next[place(bands_of(i).first)]++] = static_cast<std::uint32_t>(i);
  }

  /// Returns the parts that meet a band, the numbers of which the caller gave to bands_of().
  /// Requires bands in order, from 0 on, each once. The view is invalid after the next call. Cost:
  /// O(parts that meet this band or the one before).
  template <class F>
  std::span<const std::uint32_t> at(std::int32_t band, F&& bands_of) {
    std::erase_if(active_, [&](std::uint32_t part) { return bands_of(part).last < band; });
    active_.insert(active_.end(),
                   parts_.begin() + static_cast<std::ptrdiff_t>(begins_[place(band)]),
                   parts_.begin() + static_cast<std::ptrdiff_t>(begins_[place(band) + 1]));
    return active_;
  }

 private:
  static std::size_t place(std::int32_t band) { return static_cast<std::size_t>(band); }
  std::vector<std::size_t> begins_;
  std::vector<std::uint32_t> parts_;   // by first band
  std::vector<std::uint32_t> active_;  // of the present band
};

}  // namespace runstone
