// RollbackControl: takes edits of others back by commands that the client sends to the server.
// Before a rollback is applied, ghosts show what it would change, also if the command was typed
// into the chat. Thread: the main thread.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "client/render/ghost.hpp"
#include "client/session/client_session.hpp"
#include "client/tools/edit_preview.hpp"
#include "client/ui/rollback_window.hpp"
#include "common/mesh/mesh_materials.hpp"

namespace runstone {

/// Returns the command that previews the rollback of these edits. `eye` is the place of the player.
/// `selection`: required if the area is the selection.
std::string preview_command(const RollbackChoice& choice, const WorldPos& eye,
                            const std::optional<VoxelBox>& selection);

class RollbackControl {
 public:
  /// `session` must outlive the object.
  explicit RollbackControl(ClientSession& session) : session_(session) {}

  /// Sets the materials of the world, which decide the faces of ghosts.
  void set_materials(MeshMaterialsPtr materials) { ghosts_.set_materials(std::move(materials)); }
  /// Gives a command to the server. Returns an empty text, or why it cannot be sent.
  std::string carry_out(const RollbackOrder& order, const WorldPos& eye,
                        const std::optional<VoxelBox>& selection);
  /// Gives the command that previews the rollback of edits by filters of the server, such as
  /// "author ana since 1h". Returns an empty text, or why it cannot be sent.
  std::string preview(const std::string& filters);
  /// Takes answers, and makes ghosts, kChunksPerStep chunks at most. Returns true if what is shown
  /// has changed. Call it every turn, before other commands may be sent.
  bool step();
  /// Returns true until the answer to the last order is complete and its ghosts are made.
  bool is_busy() const { return is_waiting_ || !ghosts_.is_complete(); }
  /// Returns true if the last order succeeded. Requires that it has been answered.
  bool has_succeeded() const { return has_succeeded_; }

  /// Returns the lines of the last answer, or why a command could not be sent.
  const std::vector<std::string>& answer() const { return answer_; }
  /// Fills phase, answer and counts.
  void fill(RollbackState& state) const;
  /// Returns the ghosts of the preview; none while the past is shown.
  std::span<const GhostChunk> ghosts() const;

  static constexpr std::size_t kChunksPerStep = 8;

 private:
  std::string give(RollbackPhase phase, const std::string& command);
  std::string ask(const std::string& command);
  void forget();
  std::string refuse(std::string why);
  void take_answer();
  void show(const RestorePreview& preview);

  ClientSession& session_;
  EditPreview ghosts_;
  RollbackPhase phase_ = RollbackPhase::idle;
  bool is_waiting_ = false;  // for the answer to a command
  bool has_succeeded_ = false;
  std::uint64_t connections_ = 0;  // when the state was made
  std::string preview_;            // id of the last one; empty: none
  std::uint64_t voxels_ = 0, chunks_ = 0;
  bool is_cut_ = false;
  std::vector<std::string> answer_;
};

}  // namespace runstone
