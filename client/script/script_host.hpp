// ScriptHost: what a script can do to a client. The client program implements it; tests do with a few lines.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "client/replica/ray_pick.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

class ScriptHost {
 public:
  virtual ~ScriptHost() = default;

  /// The world is open for the first time; nothing of a script runs before.
  virtual bool ready() const = 0;
  virtual WorldPos eye() const = 0;
  virtual void move_to(const WorldPos& eye) = 0;
  /// Radians.
  virtual void look(double yaw, double pitch) = 0;

  /// By name or number; none if the world has no such material.
  virtual std::optional<Material> material(std::string_view name) const = 0;
  virtual std::optional<Material> shown_at(VoxelPos at) const = 0;
  /// The shown voxels of a box; with `solid` the empty ones become untouched. Errors as of copy_box().
  virtual Result<std::shared_ptr<const Clipboard>> copy(const VoxelBox& box, bool solid) const = 0;
  /// What the player looks at, within reach.
  virtual std::optional<RayHit> pick() const = 0;
  /// y of the highest shown voxel of the column that is not empty.
  virtual std::optional<std::int32_t> surface(std::int32_t x, std::int32_t z) const = 0;
  /// Hands in an edit that was due at `due_us`. False: the client holds too many; it counts as never seen.
  virtual bool submit(const EditDescriptor& edit, TimeUs due_us, TimeUs now_us) = 0;

  /// Every chunk in the view around the player is here, and drawn by a client that draws.
  virtual bool loaded() const = 0;
  /// No own edit is left that is not known to be on disk.
  virtual bool durable() const = 0;
  /// A mark for synced(): what the server had ordered before now will have arrived.
  virtual std::uint64_t sync_mark() const = 0;
  virtual bool synced(std::uint64_t mark) const = 0;

  /// Asks to go to a moment of the past, or back.
  virtual void travel(const HistoryRequest& travel) = 0;
  /// Gives the server a command. Empty, or why it cannot be given.
  virtual std::string command(const std::string& text) = 0;
  /// Its answer is not complete.
  virtual bool commanding() const = 0;
  /// What came of it, once it is complete: shows its lines, and says whether it did what it was asked.
  virtual bool show_answer() = 0;
  /// Not all of what was asked for is here.
  virtual bool travelling() const = 0;
  /// Why the last travel() was refused; empty if it was not.
  virtual std::string travel_refusal() const = 0;
  /// UTC, for travels so and so long ago.
  virtual TimeUs utc_now_us() const = 0;

  /// Asks for a picture of the current view; poll screenshot_written(). False: this client draws nothing.
  virtual bool screenshot(const std::string& file) = 0;
  /// None while it is under way; then whether its file could be written.
  virtual std::optional<bool> screenshot_written() const = 0;
  /// Writes the digests of all confirmed chunks; false if the file cannot be written.
  virtual bool digests(const std::string& file) = 0;
};

}  // namespace runstone
