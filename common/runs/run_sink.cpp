#include "common/runs/run_sink.hpp"

#include <utility>

namespace runstone {

RunList RunSink::runs_of(std::uint32_t volume) const {
  RUNSTONE_ASSERT(!starts_.empty() && starts_.front().voxel == 0);
  const auto end = [&](std::size_t i) {
    return i + 1 < starts_.size() ? starts_[i + 1].voxel : volume;
  };
  if (volume <= kNarrowVolumeMax) {
    std::vector<PackedRun> runs(starts_.size());
    for (std::size_t i = 0; i < runs.size(); ++i)
      runs[i] = {static_cast<std::uint16_t>(end(i)), starts_[i].material};
    return RunList::of_narrow(std::move(runs));
  }
  std::vector<std::uint32_t> ends(starts_.size());
  std::vector<Material> materials(starts_.size());
  for (std::size_t i = 0; i < ends.size(); ++i) {
    ends[i] = end(i);
    materials[i] = starts_[i].material;
  }
  return RunList::of_wide(std::move(ends), std::move(materials));
}

}  // namespace runstone
