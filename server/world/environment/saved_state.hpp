// SavedState: the state of a world that the store keeps besides the log and writes once a minute:
// where players were last, how far the clock of the world has come, and a spawn that was set. No
// edit depends on it.
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "common/core/ids.hpp"
#include "common/core/public_key.hpp"
#include "common/core/world_pos.hpp"
#include "common/core/world_time.hpp"
#include "protocol/codec/pose.hpp"

namespace runstone {

/// The places that are kept: those of the players who were seen last.
inline constexpr std::size_t kPlayerPlacesMax = 4096;

struct LastPlace {
  PublicKey key{};
  Pose pose;
  friend bool operator==(const LastPlace&, const LastPlace&) = default;
};

struct SavedClock {
  Sequence record = 0;  // the record of the log that set the clock last
  WorldTime time;       // with which the clock goes on at the next start
  friend bool operator==(const SavedClock&, const SavedClock&) = default;
};

struct SavedState {
  std::vector<LastPlace> places;    // at most kPlayerPlacesMax, those seen last at the end
  std::optional<SavedClock> clock;  // nullopt: nobody has set it
  std::optional<WorldPos> spawn = std::nullopt;  // that was set since the start; nullopt: none was
  friend bool operator==(const SavedState&, const SavedState&) = default;
};

}  // namespace runstone
