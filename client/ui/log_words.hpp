// Words and colours for records of the log.
#pragma once
#include <cstdint>
#include <string>

#include "common/core/ids.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone {

/// Returns what a record did, for people: "box", "undo", "new materials".
std::string record_words(EditKind kind, Cause cause);

/// Returns author_rgb() in ImGui's form.
std::uint32_t author_colour(AuthorId author);

}  // namespace runstone
