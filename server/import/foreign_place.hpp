// What a place is that holds no Luanti world, in words for the one who gave it to an import.
#pragma once
#include <string>

namespace runstone {

/// Returns what a file or folder is, and what can be done with it. Reads a few bytes of a file and
/// the names in a folder.
std::string words_of_foreign_place(const std::string& place);

}  // namespace runstone
