// The setting `border` as text.
#pragma once
#include <optional>
#include <string>

#include "common/core/result.hpp"
#include "server/world/environment/world_border.hpp"

namespace runstone {

/// Parses four numbers, x and z of two opposite columns, or six, x y z of two opposite corners,
/// with blanks or commas between them; the columns and corners are inside. Or parses "circle" and
/// three numbers: x and z of the column in the middle, and a radius in voxels. An empty text is no
/// border. Fails with the fault in words.
Result<std::optional<WorldBorder>, std::string> parse_border(const std::string& text);
/// Returns a text that means the border.
std::string border_setting_text(const std::optional<WorldBorder>& border);

}  // namespace runstone
