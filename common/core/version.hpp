// The version of the programs and of the libraries. Its one place is project() in CMakeLists.txt.
#pragma once
#include <string_view>

namespace runstone {

/// Returns the version as MAJOR.MINOR.PATCH.
std::string_view version();

}  // namespace runstone
