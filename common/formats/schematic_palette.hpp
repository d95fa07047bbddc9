// SchematicPalette: the blocks that the numbers of cells in a file stand for.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "common/core/result.hpp"
#include "common/formats/format.hpp"

namespace runstone {

/// The bytes that the names and states of a file may take in memory.
inline constexpr std::size_t kSchematicNameBytesMax = std::size_t{24} << 20;

class SchematicPalette {
 public:
  /// Numbers have 16 bits, and material 0 is an untouched cell.
  static constexpr std::size_t kBlocksMax = 65'534;

  /// Adds the block of a number. `text` is its name, with or without "[states]". Fails with bad_value if
  /// the number has a block or is not 0 .. kBlocksMax - 1, and with limit_exceeded if the blocks take
  /// more than `bytes_left`, from which it takes the bytes of this block.
  Result<void> add(std::int64_t number, std::string_view text, ForeignBlock block,
                   std::size_t& bytes_left);

  /// Returns the number of numbers, those that no block has included.
  std::size_t size() const { return materials_.size(); }
  /// Returns the material of a number. Returns nullopt if it has none.
  std::optional<Material> find(std::uint64_t number) const {
    if (number >= materials_.size() || materials_[number] == kNone) return std::nullopt;
    return materials_[number];
  }
  /// Returns the blocks: that of material i + 1 is [i].
  const std::vector<ForeignBlock>& blocks() const { return blocks_; }

 private:
  static constexpr Material kNone = 65'535;
  std::vector<Material> materials_;  // by number; 0: untouched
  std::vector<ForeignBlock> blocks_;
};

}  // namespace runstone
