// The name of a material for people. Commands, scripts and files keep the name of the table.
#pragma once
#include <string>
#include <string_view>

namespace runstone {

/// Returns "Acacia wood" for "default:acacia_wood" and "Red wool" for "wool:red" and "wool_red":
/// the part behind the last colon, with blanks for underscores, a colour first and a capital
/// letter. If that part is nothing but a colour, the part before the colon is the noun. Other bytes
/// stay. Cost: O(length of the name).
std::string readable_name(std::string_view name);

}  // namespace runstone
