// A build whose palette entries get other materials, of which several may become equal.
#pragma once
#include <cstddef>
#include <vector>

#include "common/core/result.hpp"
#include "common/formats/rsb_build.hpp"

namespace runstone {

/// Returns the cells of a build with these materials, by palette entry. Entries with one name and
/// the same states become one, whose row is that of the first of them; all that are empty become
/// one. The palette of the result ascends by name and states, and what is empty comes first.
/// Untouched cells stay untouched. Fails with limit_exceeded if the result takes more than
/// `bytes_max`. Requires one material for each entry. Cost: O(sections + runs).
Result<FileBuild> named_build(const BuildInfo& info, const Build& build,
                              std::vector<BuildMaterial> materials,
                              std::size_t bytes_max = kBuildBytesMax);

}  // namespace runstone
