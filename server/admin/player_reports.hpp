// PlayerReports: what players have reported to the moderators, until somebody closes it. It is kept
// in memory alone: a restart, and another owner of the world, begin without reports.
// Memory: bounded by the limits below. Thread: one. Times are arguments.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "common/core/address_block.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/public_key.hpp"
#include "common/core/result.hpp"

namespace runstone {

struct PlayerReport {
  std::uint64_t number = 0;  // from 1, in the order of the reports
  PublicKey key{};
  AddressBlock from{};  // of the player's session; never written or shown
  std::string who;      // name, author number and fingerprint, as they were
  TimeUs time_us = 0;   // UTC
  VoxelPos at;          // where the player was
  std::string text;
};

class PlayerReports {
 public:
  static constexpr std::size_t kOpenMax = 256;
  static constexpr std::size_t kOpenOfPlayerMax = 4;
  // So that nobody closes the reports for all others with many keys.
  static constexpr std::size_t kOpenOfRangeMax = 8;  // of one address_range_of()
  static constexpr TimeUs kPauseUs = 10'000'000;     // between two reports of one player

  /// Adds a report and gives it a number. Fails, with a sentence for the player, if the player has
  /// too many open ones or has reported within the pause, or if there are too many from the range
  /// of addresses or in all. Addresses for which is_of_host() holds have no bound of their own.
  /// `steady_us`: the steady clock. Cost: O(reports).
  Result<std::uint64_t, std::string> add(PlayerReport report, TimeUs steady_us);
  /// Removes a report and returns it, or nullopt if no open one has the number. Cost: O(reports).
  std::optional<PlayerReport> close(std::uint64_t number);
  /// Returns the open reports, the oldest first.
  const std::deque<PlayerReport>& open() const { return open_; }

 private:
  std::deque<PlayerReport> open_;
  std::map<PublicKey, TimeUs>
      pauses_;  // when the player reported last; without those that are over
  std::uint64_t newest_ = 0;
};

}  // namespace runstone
