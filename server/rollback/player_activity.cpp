#include "server/rollback/player_activity.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "server/rollback/log_windows.hpp"

namespace runstone {
namespace {

/// Counts records that come in windows: ascending within a window, and each window older than the
/// one before.
class ActivityCounter {
 public:
  void add(const EditRecord& record) {
    ++read_;
    if (from_us_ == 0 || record.time_us < from_us_) from_us_ = record.time_us;
    if (record.op.author == 0) return;
    Counted& counted = players_[record.op.author];
    PlayerActivity& activity = counted.activity;
    activity.author = record.op.author;
    if (!counted.previous_us) {  // the first record of this window
      counted.oldest_us = record.time_us;
    } else {
      add_gap(activity, record.time_us - *counted.previous_us);
    }
    counted.previous_us = record.time_us;
    if (activity.edits++ == 0 || record.time_us > activity.last_us)
      activity.last_us = record.time_us;
    activity.voxels += counted_voxels(record.edit);
  }
  /// Joins the window to the newer ones.
  void end_window() {
    for (auto& [author, counted] : players_) {
      if (!counted.previous_us) continue;  // no record in this window
      if (counted.newer_us) add_gap(counted.activity, *counted.newer_us - *counted.previous_us);
      counted.newer_us = counted.oldest_us;
      counted.previous_us.reset();
    }
  }
  std::size_t read() const { return read_; }
  TimeUs from_us() const { return from_us_; }
  std::vector<PlayerActivity> take() {
    std::vector<PlayerActivity> out;
    out.reserve(players_.size());
    for (auto& [author, counted] : players_) out.push_back(counted.activity);
    return out;
  }

 private:
  struct Counted {
    PlayerActivity activity;
    std::optional<TimeUs> previous_us;  // of the last record of this window
    TimeUs oldest_us = 0;               // of the first record of this window
    std::optional<TimeUs> newer_us;     // of the first record of the newer windows
  };
  /// The time of the log may have been corrected in between.
  static void add_gap(PlayerActivity& activity, TimeUs gap_us) {
    if (gap_us > 0 && gap_us <= kBuildingGapUs) activity.building_us += gap_us;
  }

  std::map<AuthorId, Counted> players_;
  std::size_t read_ = 0;
  TimeUs from_us_ = 0;
};

/// Returns the time of the first edit that the log has of an author.
StoreResult<TimeUs> first_edit_of(LogReader& reader, AuthorId author) {
  LogQuery query;
  query.author = author;
  TimeUs first_us = 0;
  const auto read = reader.query_log(query, [&](const EditRecord& record) {
    first_us = record.time_us;
    return false;
  });
  if (!read) return failure(read.error());
  return first_us;
}

}  // namespace

StoreResult<ActivityReport> read_activity(LogReader& reader, SelectionFilter filter,
                                          std::size_t count_max) {
  filter.cause = Cause::player;
  ActivityCounter counter;
  ActivityReport report;
  const auto wants_window = [&] {
    counter.end_window();
    report.is_complete = counter.read() < kActivityRecordsMax;
    return report.is_complete;
  };
  const auto read = read_log_backwards(reader, filter, wants_window,
                                       [&](const EditRecord& record) { counter.add(record); });
  if (!read) return failure(read.error());
  counter.end_window();
  report.from_us = counter.from_us();
  report.players = counter.take();
  report.players_found = report.players.size();
  std::sort(report.players.begin(), report.players.end(),
            [](const PlayerActivity& a, const PlayerActivity& b) {
              return std::pair(b.edits, a.author) < std::pair(a.edits, b.author);
            });
  if (report.players.size() > count_max) report.players.resize(count_max);
  for (PlayerActivity& player : report.players) {
    const auto first = first_edit_of(reader, player.author);
    if (!first) return failure(first.error());
    player.first_us = *first;
  }
  return report;
}

}  // namespace runstone
