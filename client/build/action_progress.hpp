// ActionProgress: how far an action is, in numbers and as a line for the player.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "common/core/ids.hpp"

namespace runstone {

struct ActionProgress {
  std::uint64_t voxels = 0;       // of all edits; 0: not known
  std::uint64_t voxels_sent = 0;  // offered, answered or not
  std::uint64_t voxels_done = 0;  // applied
  std::uint64_t edits_done = 0;
  std::uint64_t edits_refused = 0, voxels_refused = 0;  // skipped
  std::string refusal;                                  // of the last of them
  std::string waits_for;                                // why nothing is sent now, or empty
  std::string stop_reason;         // why the action ended before its source, or empty
  std::optional<TimeUs> began_us;  // when the first edit was offered
  TimeUs now_us = 0;               // of the last step that sent or got something

  /// Returns the answered part in percent, or nullopt if the whole is not known.
  std::optional<unsigned> percent() const;
  /// Returns the applied voxels a second since the begin.
  std::uint64_t voxels_per_second() const;
  /// Returns the time that the rest takes at this rate, or nullopt if it is not known.
  std::optional<TimeUs> left_us() const;
};

/// Returns a line such as "fill: 41 percent, 1,200,000 voxels a second, 30 s left; waits: your edit
/// budget".
std::string text_of(const std::string& name, const ActionProgress& progress);
/// Returns a line about an action that has ended, with what was refused.
std::string end_text_of(const std::string& name, const ActionProgress& progress);

}  // namespace runstone
