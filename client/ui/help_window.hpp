// The help window: the table of keys and mouse buttons.
#pragma once
#include <vector>

#include "client/input/key_rows.hpp"

namespace runstone {

/// Makes the window with ImGui. Clears `is_open` if the user closed it.
void build_help(const std::vector<KeyRow>& rows, bool& is_open);

}  // namespace runstone
