#include "common/core/epoch_branch.hpp"

#include <algorithm>
#include <limits>

namespace runstone {
namespace {

constexpr TimeUs kFirstBranchUs = 1'767'225'600'000'000;  // 2026-01-01T00:00:00Z
constexpr TimeUs kIntervalUs = 600'000'000;               // ten minutes
constexpr Epoch kBranchMax = std::numeric_limits<Epoch>::max() / kEpochsPerBranch;

}  // namespace

Epoch next_branch(Epoch epoch, TimeUs now_us) {
  const TimeUs intervals =
      std::clamp<TimeUs>((now_us - kFirstBranchUs) / kIntervalUs, 0, TimeUs{kBranchMax} - 1);
  const Epoch following = epoch / kEpochsPerBranch + 1;
  // The last block has no successor. A world reaches it in 2185.
  if (following > kBranchMax) return std::numeric_limits<Epoch>::max();
  return std::max(following, static_cast<Epoch>(intervals)) * kEpochsPerBranch;
}

}  // namespace runstone
