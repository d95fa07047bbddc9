// What mesher_cases are called on the page, and what they are to its reader.
#pragma once
#include <string>
#include <string_view>

#include "tests/bench/report/chart/role.hpp"

namespace runstone::bench {

/// "decode + binary greedy" of "decode_binary"; an unknown name with blanks for underscores.
std::string long_name_of(std::string_view mesher);
/// As it stands in a narrow table.
std::string short_name_of(std::string_view mesher);
chart::Role role_of(std::string_view mesher);
/// The same polygons as another mesher_case's, by another way.
bool is_variant(std::string_view mesher);

}  // namespace runstone::bench
