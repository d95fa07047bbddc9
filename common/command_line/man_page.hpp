// Man pages, in the roff macros `man` that groff and mandoc read.
#pragma once
#include <string>

#include "common/command_line/command_help.hpp"

namespace runstone {

/// Returns the man page of a program for section 1. `version` is that of Runstone. The same help makes
/// the same bytes: the page has no date.
std::string man_page(const CommandHelp& program, const std::string& version);

}  // namespace runstone
