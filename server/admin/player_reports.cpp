#include "server/admin/player_reports.hpp"

#include <algorithm>
#include <utility>

#include "server/limits/player_addresses.hpp"

namespace runstone {

Result<std::uint64_t, std::string> PlayerReports::add(PlayerReport report, TimeUs steady_us) {
  std::erase_if(pauses_, [&](const auto& pause) { return steady_us - pause.second >= kPauseUs; });
  if (const auto pause = pauses_.find(report.key); pause != pauses_.end()) {
    const TimeUs left_s = (kPauseUs - (steady_us - pause->second)) / 1'000'000 + 1;
    return failure("you have just reported: again in " + std::to_string(left_s) + " s");
  }
  const auto of_player = static_cast<std::size_t>(std::ranges::count_if(
      open_, [&](const PlayerReport& other) { return other.key == report.key; }));
  if (of_player >= kOpenOfPlayerMax) {
    return failure("you have " + std::to_string(of_player) +
                   " open reports: wait until a moderator closes one");
  }
  const auto is_near = [&](const PlayerReport& other) {
    return !is_of_host(other.from) && address_range_of(other.from) == address_range_of(report.from);
  };
  if (static_cast<std::size_t>(std::ranges::count_if(open_, is_near)) >= kOpenOfRangeMax) {
    return failure("there are " + std::to_string(kOpenOfRangeMax) +
                   " open reports from your range of addresses: wait until a moderator closes one");
  }
  if (open_.size() >= kOpenMax)
    return failure("there are " + std::to_string(open_.size()) +
                   " open reports, as many as there may be: a moderator must close some");
  pauses_[report.key] = steady_us;
  report.number = ++newest_;
  open_.push_back(std::move(report));
  return newest_;
}

std::optional<PlayerReport> PlayerReports::close(std::uint64_t number) {
  const auto found = std::ranges::find(open_, number, &PlayerReport::number);
  if (found == open_.end()) return std::nullopt;
  PlayerReport report = std::move(*found);
  open_.erase(found);
  return report;
}

}  // namespace runstone
