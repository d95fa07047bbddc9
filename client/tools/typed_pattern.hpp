// Typed patterns: the texts of a tool with the materials of a world.
#pragma once
#include <optional>
#include <string>

#include "client/tools/tool.hpp"
#include "common/core/result.hpp"
#include "common/materials/material_table.hpp"
#include "common/patterns/bound_filter.hpp"
#include "common/patterns/bound_mix.hpp"

namespace runstone {

/// The parts of a text that is a pattern, a mix or a filter.
struct TypedPattern {
  std::optional<BoundMix> mix;        // nullopt: the text gives none
  std::optional<BoundFilter> filter;  // nullopt: every voxel passes
};

/// Returns the parts of a text; an empty text has none. Fails with words for the player that begin
/// with the name of the text.
Result<TypedPattern, std::string> typed_pattern(const ToolText& text, const MaterialTable& table,
                                                const PatternFrame& frame);

}  // namespace runstone
