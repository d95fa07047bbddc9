#include "common/formats/schematic_palette.hpp"

#include <utility>

#include "common/formats/schematic_names.hpp"

namespace runstone {

Result<void> SchematicPalette::add(std::int64_t number, std::string_view text, ForeignBlock block,
                                   std::size_t& bytes_left) {
  if (number < 0 || number >= static_cast<std::int64_t>(kBlocksMax))
    return fail(ErrorCode::bad_value, "schematic: a number of the palette is not 0 .. 65533");
  const auto index = static_cast<std::size_t>(number);
  if (index < materials_.size() && materials_[index] != kNone)
    return fail(ErrorCode::bad_value, "schematic: two blocks of the palette have one number");
  const std::size_t bytes = sizeof(block) + block.name.size() + block.states.size();
  if (bytes > bytes_left) {
    return fail(ErrorCode::limit_exceeded,
                "schematic: the names and states of the blocks take more than 24 MiB");
  }
  bytes_left -= bytes;
  if (index >= materials_.size()) materials_.resize(index + 1, kNone);
  if (is_untouched_in_schematic(text)) {
    materials_[index] = kEmpty;
    return {};
  }
  blocks_.push_back(std::move(block));
  materials_[index] = static_cast<Material>(blocks_.size());
  return {};
}

}  // namespace runstone
