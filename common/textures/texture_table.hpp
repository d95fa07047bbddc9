// TextureTable: the pictures of a world without their bytes, and which side of a material shows
// which one. It only grows: what a side shows never changes.
// Threads: const access from anywhere.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/core/texture.hpp"

namespace runstone {

class TextureTable {
 public:
  /// Adds a picture, or uses of one that the table has, which is known by its hash. Fails, and
  /// changes nothing, if the uses are not valid, if a side has a picture already, if the size of
  /// the picture is out of range or not that of the picture with this hash, or if the world would
  /// have too many pictures or bytes. If a side has a picture already, the error's code is
  /// not_permitted and its offset the material. Cost: O(uses + log pictures).
  Result<void> add(const TextureEntry& entry);
  /// Adds all of them, or fails as add() at the first one that does not fit. Those before it were
  /// added then.
  Result<void> add(std::span<const TextureEntry> entries);
  /// Checks what add() checks.
  Result<void> check(const TextureEntry& entry) const;

  bool empty() const { return entries_.empty(); }
  /// Returns the pictures in the order in which they were added, each with all of its uses. The
  /// uses of one add() ascend by material, those of a later one follow.
  std::span<const TextureEntry> entries() const { return entries_; }
  /// Returns the bytes of the PNGs of all pictures.
  std::size_t bytes() const { return bytes_; }
  /// Returns 0 if the side of the material has no picture, otherwise 1 + its index in entries().
  /// Cost: O(1).
  std::uint16_t number(Material material, Direction side) const {
    return material < numbers_.size() ? numbers_[material][static_cast<std::size_t>(side)]
                                      : std::uint16_t{0};
  }
  /// Returns the index of the picture with this hash, or nullopt if there is none.
  std::optional<std::uint16_t> find(const TextureHash& hash) const;

 private:
  std::vector<TextureEntry> entries_;
  std::map<TextureHash, std::uint16_t> index_of_;
  std::vector<std::array<std::uint16_t, kDirectionCount>> numbers_;  // up to the last material
  std::size_t bytes_ = 0;
};

using TextureTablePtr = std::shared_ptr<const TextureTable>;

}  // namespace runstone
