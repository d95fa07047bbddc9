// The setting `border` as text.
#pragma once
#include <optional>
#include <string>

#include "common/core/coords.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// Parses four numbers, x and z of two opposite columns, or six, x y z of two opposite corners, with
/// blanks or commas between them; the columns and corners are inside. An empty text is no border. Fails
/// with what is wrong.
Result<std::optional<VoxelBox>, std::string> parse_border(const std::string& text);
/// Returns a text that means the border.
std::string border_setting_text(const std::optional<VoxelBox>& border);

}  // namespace runstone
