// KeyRow: a row of the table of keys and mouse buttons, for the help window and for docs/client.md.
#pragma once
#include <string>
#include <vector>

#include "client/input/action.hpp"
#include "client/input/key_map.hpp"

namespace runstone {

struct KeyRow {
  std::string input;  // keys or buttons, such as "T, enter"
  std::string what;   // the effect
  ActionGroup group{};
};

/// Returns the rows in the order of the groups, with the mouse among `building`. The keys of the
/// slots are one row while they are the default keys, and so are the keys of the tools.
std::vector<KeyRow> key_rows(const KeyMap& keys);

}  // namespace runstone
