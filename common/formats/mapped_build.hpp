// A build whose materials become others, as a MaterialMap says.
#pragma once
#include <cstddef>

#include "common/core/result.hpp"
#include "common/formats/material_map.hpp"
#include "common/formats/rsb_build.hpp"

namespace runstone {

/// Returns the build with the materials that the map chooses. Materials that become equal are one.
/// If a mapped material gets the name of one that stays as it is, the latter says what they look
/// like. Untouched cells stay untouched. Notes the rows that applied in `applied`. Fails with
/// limit_exceeded if the result takes more than `bytes_max`. Cost: O(sections + runs).
Result<FileBuild> mapped_build(const FileBuild& build, const MaterialMap& map, AppliedRows& applied,
                               std::size_t bytes_max = kBuildBytesMax);

}  // namespace runstone
