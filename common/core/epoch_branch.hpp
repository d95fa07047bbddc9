// Branches of a log. A world that is put back from a backup, or has lost edits, gives the sequences
// behind that point to other edits: its log is a new branch. Epochs tell branches apart: each
// branch has a block of kEpochsPerBranch epochs, and each start of a server raises the epoch by one
// within it. A client that finds a world on another branch drops the chunks that it kept.
//   - An edit is named by (epoch, sequence). No branch uses an epoch of another one, so a version
//     of an abandoned branch is never taken for a version of the present one.
//   - The number of a restored branch is that of a ten-minute interval since 2026, or the next
//     number if that is greater. So two worlds that were put back from one backup differ, unless
//     both were put back within ten minutes.
//   - A world that is started more than kEpochsPerBranch times without being put back moves to the
//     next block. Clients then drop chunks that they could have kept, which costs them a download.
#pragma once
#include "common/core/ids.hpp"

namespace runstone {

inline constexpr Epoch kEpochsPerBranch = 512;

constexpr bool is_same_branch(Epoch a, Epoch b) {
  return a / kEpochsPerBranch == b / kEpochsPerBranch;
}

/// Returns the first epoch of a new branch. It is greater than `epoch`, the newest epoch of the old
/// branch that is known. `now_us` is the time in UTC; 0 for the next branch.
Epoch next_branch(Epoch epoch, TimeUs now_us);

}  // namespace runstone
