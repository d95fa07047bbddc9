// EditTool: makes edits from clicks, submits the edits of clicks and scripts to the session, and
// records when each was submitted. One thread.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "client/app/player.hpp"
#include "client/replica/ray_pick.hpp"
#include "client/schedule/latency_recorder.hpp"
#include "client/session/client_session.hpp"
#include "common/core/result.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone {

class EditTool {
 public:
  /// All three must outlive the tool.
  EditTool(ClientSession& session, const Player& player, LatencyRecorder& recorder)
      : session_(session), player_(player), recorder_(recorder) {}

  /// Returns the voxel that the player looks at, or nullopt if there is none within kReach.
  std::optional<RayHit> pick() const;
  /// Removes the voxel that the player looks at. Fails with words for the player.
  Result<void, std::string> remove(TimeUs now_us);
  /// Places the player's material against the voxel that the player looks at, but never where the
  /// player is. Fails with words for the player.
  Result<void, std::string> place(TimeUs now_us);
  /// Submits an edit that was due at `due_us`. Fails with the reason, which is also logged, if the
  /// client does not accept it. If the client had no room for it, the edit counts as infinitely
  /// late. Any other refusal, such as that of an edit while the view shows the past, counts in
  /// refused() only.
  Result<void, std::string> submit(const EditDescriptor& edit, TimeUs due_us, TimeUs now_us);

  std::uint64_t refused() const { return refused_; }

 private:
  ClientSession& session_;
  const Player& player_;
  LatencyRecorder& recorder_;
  std::uint64_t refused_ = 0;
};

}  // namespace runstone
