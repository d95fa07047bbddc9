// runstone-client key: shows a player's key, exports it as a line of text and imports it, or moves
// it to another device by a one-time code.
#pragma once
#include <iosfwd>

#include "client/app/key_options.hpp"
#include "client/net/sealed_key.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// Passphrases of fewer bytes are refused for an export.
inline constexpr std::size_t kPassphraseBytesMin = 8;

/// Carries out the command. `in` is read by an import without a file, and for a code that the
/// command lacks; `cost` is that of an export. No file is overwritten. The error is one line.
Result<void, std::string> run_key_program(const KeyCommand& command, std::istream& in,
                                          std::ostream& out, SealCost cost = {});

}  // namespace runstone
