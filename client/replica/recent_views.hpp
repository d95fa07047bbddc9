// RecentViews: the view in force on a connection and the views before it. The server's answers for
// chunks carry the number of the view that they answer. A chunk that leaves the view is forgotten.
// If it comes back, answers to earlier views are for the forgotten chunk. They are ignored, and a
// newer answer follows. One thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/core/coords.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// Views before the one in force that are remembered. With ViewPace they last for 25 seconds.
inline constexpr std::size_t kRecentViewsMax = 256;

class RecentViews {
 public:
  /// Begins a new connection, on which views are counted from 1 again. The view in force stays.
  void reopen();
  /// Replaces the view in force. Requires ascending numbers. A view with the number of the one
  /// before replaces it as if that one had never been: no view of this number was sent yet.
  void set(const View& view);

  /// Returns the newest view, or nullopt before the first one.
  const std::optional<View>& current() const { return current_; }
  bool contains(const ChunkKey& key) const;
  /// Returns true if the chunk is in the view in force and did not leave it since the view of this
  /// number: then an answer to that view counts. An answer to a view that is older than all
  /// remembered ones counts if these contain the chunk. Cost: O(views since that one).
  bool accepts(const ChunkKey& key, std::uint32_t number) const;

 private:
  std::optional<View> current_;
  /// Number of the first view with the chunks of `current_`. Views that differ in the direction
  /// only follow it.
  std::uint32_t since_ = 0;
  /// Views with other chunks before `current_`, ascending. Of views that differ in the direction
  /// only, this has the first one.
  std::vector<View> before_;
};

}  // namespace runstone
