// Straight paste: a turned or mirrored paste as one that is not, with the clipboard turned instead.
#pragma once
#include <optional>

#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone {

/// Returns a paste with the same effect whose clipboard has no orientation, or nullopt if that
/// clipboard would be too long. Such a paste is applied faster, and a caller who applies it at many
/// places turns it once. Requires a valid paste. Cost: O(runs log runs + lines of the clipboard).
std::optional<Paste> straight_paste(const Paste& paste);

}  // namespace runstone
