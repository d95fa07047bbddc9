// Makes a RunList, narrow or wide by the volume, from decoded ends and materials. Internal to the
// chunk codec.
#pragma once
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/core/result.hpp"
#include "common/runs/run_list.hpp"

namespace runstone {

/// Returns the runs that `read` delivers. `read(put)` calls put(i, end, material) for each i below
/// `count`, or returns an error, which the function returns.
template <class Read>
Result<RunList> read_runs(std::uint32_t volume, std::size_t count, Read&& read) {
  if (volume <= kNarrowVolumeMax) {
    std::vector<PackedRun> narrow(count);
    const auto put = [out = narrow.data()](std::size_t i, std::uint32_t end, Material material) {
      out[i] = {static_cast<std::uint16_t>(end), material};
    };
    if (const Result<void> done = read(put); !done) return failure(done.error());
    return RunList::of_narrow(std::move(narrow));
  }
  std::vector<std::uint32_t> ends(count);
  std::vector<Material> materials(count);
  const auto put = [e = ends.data(), m = materials.data()](std::size_t i, std::uint32_t end,
                                                           Material material) {
    e[i] = end;
    m[i] = material;
  };
  if (const Result<void> done = read(put); !done) return failure(done.error());
  return RunList::of_wide(std::move(ends), std::move(materials));
}

}  // namespace runstone
