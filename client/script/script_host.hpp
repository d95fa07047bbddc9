// ScriptHost: the interface between ScriptRunner and a client.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "client/input/key.hpp"
#include "client/render/inspection.hpp"
#include "client/replica/ray_pick.hpp"
#include "client/script/script.hpp"
#include "client/tools/action_part.hpp"
#include "client/tools/tool_box.hpp"
#include "common/builds/build.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

class ScriptHost {
 public:
  virtual ~ScriptHost() = default;

  /// Returns true once a world was opened. No command runs before that.
  virtual bool ready() const = 0;
  /// Returns true while the connection is open. Commands for the server wait for it.
  virtual bool connected() const = 0;
  /// Returns how often the connection was opened.
  virtual std::uint64_t connections() const = 0;
  virtual WorldPos eye() const = 0;
  virtual void move_to(const WorldPos& eye) = 0;
  /// Sets the direction, in radians.
  virtual void look(double yaw, double pitch) = 0;
  /// Sets the time of day of the picture, as FrameLook::time_of_day.
  virtual void set_time_of_day(double share) = 0;
  /// Sets how the edges of the next frames are smoothed.
  virtual void set_antialiasing(Antialiasing antialiasing) = 0;

  /// Returns a material by number or, as find_material() does, by name. Fails with one line of
  /// text.
  virtual Result<Material, std::string> material(std::string_view name) const = 0;
  /// Returns nullopt if the chunk is not here.
  virtual std::optional<Material> shown_at(VoxelPos at) const = 0;
  /// Copies the shown voxels of a box. Fails as copy_box() does.
  virtual Result<BuildPtr> copy(const VoxelBox& box) const = 0;
  /// Returns the voxel that the player looks at, or nullopt if there is none within reach.
  virtual std::optional<RayHit> pick() const = 0;
  /// Returns the building tools, and the replica and the aim with which they work.
  virtual ToolBox& tool_box() = 0;
  virtual const Replica& replica() const = 0;
  virtual Aim aim() const = 0;
  /// Aims at a face of a voxel, wherever the player looks; nullopt follows the look again.
  virtual void fix_aim(std::optional<FixedAim> aim) = 0;
  /// Puts a material into the player's hand.
  virtual void hold(Material material) = 0;
  /// Keeps, takes or forgets a hotbar. Fails with one line of text.
  virtual Result<void, std::string> use_hotbar(const script::NamedHotbar& order) = 0;
  /// Makes the preview of the next click completely, if previews are shown.
  virtual void finish_preview() = 0;
  /// Returns the y of the highest shown voxel of the column that is not empty, or nullopt if there
  /// is none.
  virtual std::optional<std::int32_t> surface(std::int32_t x, std::int32_t z) const = 0;
  /// Returns how long this edit must wait for the player's edit budget. Requires a valid edit.
  virtual TimeUs edit_wait_us(const EditDescriptor& edit, TimeUs now_us) = 0;
  /// Proposes an edit that was due at `due_us`. Fails with the reason if the client refuses it.
  virtual Result<void, std::string> propose(const EditDescriptor& edit, TimeUs due_us,
                                            TimeUs now_us, ActionPart part) = 0;

  /// Returns true if a part of the action is too large to be proposed: build() sends it.
  virtual bool needs_build(const ToolAction& /*action*/) const { return false; }
  /// Begins an action, whatever its size. Fails with the reason.
  virtual Result<void, std::string> build(const ToolAction& /*action*/) {
    return failure(std::string("this client sends no large actions"));
  }
  /// Returns nullopt while the action is under way, and then why a part of it is missing, if so.
  virtual std::optional<Result<void, std::string>> built() const {
    return Result<void, std::string>();
  }

  /// Reads the clipboard of the tools from a file, or writes it to one; the ending names the format.
  /// `model` counts for a file with a model. Fails with one line. Blocks until it is done.
  virtual Result<void, std::string> load_clipboard(const std::string& /*file*/,
                                                   const ModelChoices& /*model*/) {
    return failure(std::string("this client reads no files"));
  }
  virtual Result<void, std::string> save_clipboard(const std::string& /*file*/) {
    return failure(std::string("this client writes no files"));
  }

  /// Returns true if every chunk in the view around the player is here and, in a client that draws,
  /// drawn.
  virtual bool loaded() const = 0;
  /// Returns true if loaded(), and every tile of distant ground in the view is here and drawn, too.
  virtual bool sees_horizon() const = 0;
  /// Returns true if all local edits are known to be on the server's disk.
  virtual bool durable() const = 0;
  /// Returns a mark for synced().
  virtual std::uint64_t sync_mark() const = 0;
  /// Returns true if everything that the server ordered before sync_mark() returned `mark` has
  /// arrived, and every local edit was answered.
  virtual bool synced(std::uint64_t mark) const = 0;

  /// Requests a moment of the past, or the live world.
  virtual void travel(const HistoryRequest& request) = 0;
  /// Sends a line of chat. Returns an empty text, or why it cannot be sent.
  virtual std::string say(const std::string& text) = 0;
  /// Returns true if a line of chat has arrived that contains the text, as it is printed. Forgets
  /// the lines up to it.
  virtual bool take_chat(const std::string& text) = 0;
  /// Sends a command to the server. Returns an empty text, or why it cannot be sent.
  virtual std::string command(const std::string& text) = 0;
  /// Returns true until the answer to the command is complete.
  virtual bool commanding() const = 0;
  /// Prints the lines of the complete answer. Returns true if the command succeeded.
  virtual bool show_answer() = 0;
  /// Returns true if the connection ended before the answer to the newest command was complete.
  virtual bool answer_lost() const = 0;
  /// Returns true until all chunks of the requested moment are here, or the request was refused.
  virtual bool travelling() const = 0;
  /// Returns why the last travel() was refused, or an empty text.
  virtual std::string travel_refusal() const = 0;
  /// Returns the time in UTC, for requests of a moment some seconds ago.
  virtual TimeUs utc_now_us() const = 0;

  /// Presses a key chord and releases it, types a text in UTF-8, and clicks with the left button at
  /// a place of the frame in pixels.
  virtual void press(const KeyChord& chord) = 0;
  virtual void type(const std::string& text) = 0;
  virtual void click(double x, double y) = 0;
  /// Returns true until the client has handled this input.
  virtual bool handling_input() const = 0;
  /// Shows or hides the user interface.
  virtual void show_interface(bool is_shown) = 0;
  /// Shows or hides a mode of inspection.
  virtual void inspect(InspectionMode mode, bool is_on) = 0;

  /// Shows or hides the map from above; `is_full`: in all of the frame.
  virtual void show_map(bool is_shown, bool is_full) = 0;
  /// Sets the pixels of the map for each voxel.
  virtual void zoom_map(double pixels) = 0;
  virtual void show_timeline(bool is_shown) = 0;
  virtual void show_library(bool /*is_shown*/) {}
  /// List the builds of the library whose names have this part, put one into the clipboard of the
  /// tools, and add that clipboard as a build. Poll using_library().
  virtual void list_library(const std::string& /*name*/) {}
  virtual void take_build(Sequence /*number*/) {}
  virtual void add_build(const std::string& /*name*/) {}
  virtual bool using_library() const { return false; }
  /// Prints the answer. Returns why the last of them failed, or an empty text.
  virtual std::string show_library_answer() { return "this client uses no library of builds"; }
  /// Returns true until the open map is drawn, the open timeline has its marks, and the open library
  /// its list.
  virtual bool loading_panels() const = 0;
  /// Send the commands that preview, apply and undo a rollback, and forget its preview. Return an
  /// empty text, or why the command cannot be sent.
  virtual std::string preview_rollback(const std::string& filters) = 0;
  virtual std::string apply_rollback() = 0;
  virtual std::string undo_rollback() = 0;
  virtual std::string forget_rollback() = 0;
  /// Returns true until the answer to it is complete and the ghosts are made.
  virtual bool rolling_back() const = 0;
  /// Prints the answer. Returns true if the command succeeded.
  virtual bool show_rollback_answer() = 0;

  /// Requests a screenshot; poll screenshot_written(). Returns false if this client draws nothing.
  virtual bool screenshot(const std::string& file) = 0;
  /// Returns nullopt while the screenshot is in progress, and then its result. The error begins with
  /// the name of the file.
  virtual std::optional<Result<void, std::string>> screenshot_written() const = 0;
  /// Writes the digests of all confirmed chunks. The error begins with the name of the file.
  virtual Result<void, std::string> digests(const std::string& file) = 0;
};

}  // namespace runstone
