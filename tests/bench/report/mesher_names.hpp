// The names of mesher cases on the page, and their roles.
#pragma once
#include <string>
#include <string_view>

#include "tests/bench/report/chart/role.hpp"

namespace runstone::bench {

/// Returns "decode + binary greedy" for "decode_binary"; for an unknown name, the name with blanks
/// for underscores.
std::string long_name_of(std::string_view mesher);
/// Returns the name for a narrow table.
std::string short_name_of(std::string_view mesher);
chart::Role role_of(std::string_view mesher);
/// Returns true if the case makes the same polygons as another one in another way.
bool is_variant(std::string_view mesher);

}  // namespace runstone::bench
