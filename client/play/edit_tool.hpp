// EditTool: gives clicks to the tool box, proposes the edits of clicks and scripts to the session,
// and records when each was proposed. Edits that are too large for one descriptor become an action of
// many (ActionSender), of which one is under way at a time. One thread.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "client/build/action_sender.hpp"
#include "client/play/player.hpp"
#include "client/replica/ray_pick.hpp"
#include "client/schedule/latency_recorder.hpp"
#include "client/session/client_session.hpp"
#include "client/tools/action_part.hpp"
#include "client/tools/tool_box.hpp"
#include "client/tools/tool_command.hpp"
#include "common/core/result.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/shapes/shape_table.hpp"

namespace runstone {

class EditTool {
 public:
  /// Gets the reason of each edit that the client did not accept.
  using OnRefused = std::function<void(const std::string&)>;

  /// The first four must outlive the tool. `on_refused` may be null.
  EditTool(ClientSession& session, const Player& player, LatencyRecorder& recorder, ToolBox& box,
           OnRefused on_refused = nullptr)
      : session_(session),
        player_(player),
        recorder_(recorder),
        box_(box),
        on_refused_(std::move(on_refused)) {}

  const Replica& replica() const { return session_.replica(); }
  /// Sets the shapes of the world's materials, which pick() hits.
  void set_shapes(ShapeTablePtr shapes) { shapes_ = std::move(shapes); }
  const ShapeTable& shapes() const { return *shapes_; }
  ToolBox& box() { return box_; }
  const ToolBox& box() const { return box_; }
  /// Returns the voxel that the player looks at, or nullopt if there is none within kReach. The
  /// look goes through liquids, unless the player holds one.
  std::optional<RayHit> pick() const;
  /// Returns the place at which the player points, or at which a script aims.
  Aim aim() const;
  /// Aims at a face of a voxel, wherever the player looks; nullopt follows the look again.
  void fix_aim(std::optional<FixedAim> aim) { fixed_aim_ = aim; }

  /// Pass a press, a held button and a release to the tool box, and propose the edits that it
  /// returns. They never place a single voxel where the player is. They fail with words for the
  /// player.
  Result<void, std::string> press(ToolButton button, TimeUs now_us);
  void drag();
  Result<void, std::string> release(TimeUs now_us);
  /// Returns true if the tool acts again and again while the button is held.
  bool repeats() const { return &box_.tool() == box_.tools().front().get(); }
  /// Proposes the edits in their order, as one action. Fails with the first refusal; the edits
  /// after it are not proposed. Those that only follow the first one (ToolAction::has_followers)
  /// are left out if they are refused. An action that needs_build() is begun by
  /// build(). If `made` is a failure, fails with it.
  Result<void, std::string> propose(const ToolEdits& made, TimeUs now_us);

  /// Begins an action of any size. `name` is a verb for the player, such as "fill". Fails if one is
  /// under way.
  Result<void, std::string> build(std::string name, std::unique_ptr<EditSource> source,
                                  OnRefusal on_refusal = OnRefusal::skip);
  /// Begins an action of the tools, whatever its size. If it clears at its end, the clearing edits are
  /// sent when those before were applied, and not if one of them was refused. Fails as build() does.
  Result<void, std::string> build(const ToolAction& action);
  /// Returns true if a part of the action is too large to be proposed, or if the action has so many
  /// edits that the budget may end in the middle. Requires an open replica.
  bool needs_build(const ToolAction& action) const;
  /// Takes what the server rejected. Call it for each drained ReplicaChanges, before step_build().
  void take(const ReplicaChanges& changes, TimeUs now_us);
  /// Offers what fits of the action under way. Returns a line for the player when it has ended.
  std::optional<std::string> step_build(TimeUs now_us);
  bool is_building() const { return sender_ != nullptr; }
  /// Sends nothing more of the action under way. Returns false if there is none.
  bool stop_building();
  /// Returns true if an edit of the action under way was sent and not refused: then an undo takes
  /// back that action.
  bool has_built() const;
  /// Returns how far the action under way is, as a line for the player, or an empty text.
  std::string build_text() const;
  /// Returns how the last action ended; an empty stop_reason if all of it was sent.
  const ActionProgress& last_build() const { return last_build_; }

  /// Carries out a command of the tool window, and proposes its edits. Fails with words for the
  /// player.
  Result<void, std::string> carry_out(const ToolCommand& command, TimeUs now_us);

  /// Makes the preview of the next click for a bounded time. Returns true if the ghosts changed.
  bool step_preview();
  /// Returns the ghosts to draw. There are none while the past is shown, and none of the plain
  /// voxel tool, for which the outline of the voxel in sight suffices.
  std::span<const GhostChunk> ghosts() const;
  /// The stroke of the next click of a tool that is drawn.
  struct SharedStroke {
    /// A line along the stroke, as an edit that may be shared: a long stroke is cut at its
    /// beginning, and a wide one is narrower.
    EditDescriptor line;
    /// The whole stroke, if the tool is a brush whose work others may do.
    std::optional<BrushStroke> stroke;
  };
  /// Returns the stroke for others to see, or nullopt if there is none or the preview itself may be
  /// shared. Without a stroke of a brush, nothing is shared before a line is drawn.
  std::optional<SharedStroke> drawn_stroke() const;
  /// Returns true if the next click has a preview. A click of the plain voxel tool has none unless
  /// its place is typed.
  bool has_preview() const;
  /// Returns the chosen tool, its parameters and the symmetry as a line for the player. It is empty
  /// for the plain voxel tool.
  std::string text() const;

  /// Returns corners and size of the box that the next click would complete, as a line for the
  /// player, or an empty text if there is none.
  std::string measure_text() const;

  /// Proposes an edit that was due at `due_us`. Fails with the reason, which `on_refused` gets as
  /// well, if the client does not accept it. If the client had no room for it, the edit counts as
  /// infinitely late. Any other refusal, such as that of an edit while the view shows the past,
  /// counts in refused() only.
  Result<void, std::string> propose(const EditDescriptor& edit, TimeUs due_us, TimeUs now_us,
                                    ActionPart part = ActionPart::alone);

  std::uint64_t refused() const { return refused_; }

 private:
  /// Proposes the edits, unless they would put a voxel where the player stands.
  Result<void, std::string> propose_beside(const ToolEdits& made, TimeUs now_us);
  /// Proposes an edit that follows the first one of its action. It is left out if the client does
  /// not accept it.
  void follow(const EditDescriptor& edit, TimeUs now_us);

  ClientSession& session_;
  const Player& player_;
  LatencyRecorder& recorder_;
  ToolBox& box_;
  const OnRefused on_refused_;
  ShapeTablePtr shapes_ = std::make_shared<const ShapeTable>();
  std::optional<FixedAim> fixed_aim_;
  std::unique_ptr<ActionSender> sender_;  // of the action under way, or null
  std::string build_name_;
  ActionProgress last_build_;
  ClientSequence action_ = 0;  // first edit of the current action; 0: none was accepted yet
  std::uint64_t refused_ = 0;
};

}  // namespace runstone
