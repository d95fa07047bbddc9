// Passphrases: typed at the terminal without being shown.
#pragma once
#include <string>

#include "common/core/result.hpp"

namespace runstone {

/// Prints the prompt on the terminal of the process and reads a line that is not shown. Fails if
/// the process has no terminal, or if the input ends.
Result<std::string, std::string> ask_passphrase(const std::string& prompt);

/// Asks twice for a new one. Fails also if the two differ.
Result<std::string, std::string> ask_new_passphrase(const std::string& prompt);

}  // namespace runstone
