// ScriptRunner: runs a script against a ScriptHost. Time is an argument of step(). One thread.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/script/script.hpp"
#include "client/script/script_host.hpp"
#include "common/core/hash.hpp"

namespace runstone {

class ScriptRunner {
 public:
  /// Script and host must outlive the runner.
  ScriptRunner(const Script& script, ScriptHost& host) : script_(script), host_(host) {}

  /// Runs commands until one has to wait, and kStepCommandsMax at most. A call while a command
  /// waits is cheap.
  void step(TimeUs now_us);
  bool finished() const { return finished_; }
  /// Returns when step() is to be called again without an event, or nullopt if only an event can
  /// end the wait.
  std::optional<TimeUs> due_us() const { return due_us_; }
  /// Returns lines "file:line: what", in order. A failed expectation does not end the script. A
  /// command that cannot run ends it.
  const std::vector<std::string>& failures() const { return failures_; }

  static constexpr int kStepCommandsMax = 256;

 private:
  enum class Progress { done, waits, stop };
  struct Started {  // state of the command that waits
    TimeUs at_us = 0;
    TimeUs last_us = 0;             // walk: time of the last movement
    std::uint64_t mark = 0;         // synced
    bool is_sent = false;           // a command for the server
    std::uint64_t connections = 0;  // that were opened when it was sent
    std::uint32_t count = 0;        // burst: edits proposed
    SplitMix64 random{0};           // burst
    WorldPos centre;                // burst: the player at its start; walk: the destination
  };

  Progress run(const script::Move& c);
  Progress run(const script::Walk& c);
  Progress run(const script::Roam& c);
  Progress run(const script::Look& c);
  Progress run(const script::TimeOfDay& c);
  Progress run(const script::SmoothEdges& c);
  Progress run(const script::LookAt& c);
  Progress run(const script::Set& c);
  Progress run(const script::Box& c);
  Progress run(const script::Sphere& c);
  Progress run(const script::Stroke& c);
  Progress run(const script::Copy& c);
  Progress run(const script::Paste& c);
  Progress run(const script::Dig& c);
  Progress run(const script::Place& c);
  Progress run(const script::Wait& c);
  Progress run(const script::WaitUntil& c);
  Progress run(const script::Screenshot& c);
  Progress run(const script::Expect& c);
  Progress run(const script::Repeat& c);
  Progress run(const script::End& c);
  Progress run(const script::Burst& c);
  Progress run(const script::Digests& c);
  Progress run(const script::HistoryRequest& c);
  Progress run(const script::Say& c);
  Progress run(const script::WaitChat& c);
  Progress run(const script::Command& c);
  /// Waits until the connection is open. Ends the script if that takes too long.
  Progress wait_for_connection();
  /// Records that the server did not carry out a command, or may not have done so. `what` names it.
  void fail_answer(const std::string& what);
  /// Waits until the client has handled the input of this command.
  Progress after_input();
  Progress run(const script::PressKey& c);
  Progress run(const script::Type& c);
  Progress run(const script::Click& c);
  Progress run(const script::ShowInterface& c);
  Progress run(const script::Inspect& c);
  // Map, timeline, rollback and library: script_panels.cpp.
  Progress run(const script::ShowMap& c);
  Progress run(const script::ZoomMap& c);
  Progress run(const script::ShowTimeline& c);
  Progress run(const script::Rollback& c);
  Progress run(const script::ShowLibrary& c);
  Progress run(const script::ListBuilds& c);
  Progress run(const script::TakeBuild& c);
  Progress run(const script::AddBuild& c);
  /// Begins a command of the library, and waits for its end.
  template <class Begin>
  Progress use_library(const Begin& begin);
  /// Waits until `is_busy` is false. Ends the script if it takes too long.
  Progress wait_for_panel(bool is_busy, const char* what);
  // The building tools: script_tools.cpp.
  Progress run(const script::ChooseTool& c);
  Progress run(const script::SetParameter& c);
  Progress run(const script::AimAt& c);
  Progress run(const script::Hold& c);
  Progress run(const script::UseTool& c);
  Progress run(const script::Select& c);
  Progress run(const script::SelectionEdit& c);
  Progress run(const script::SetSymmetry& c);
  Progress run(const script::TypePlaces& c);
  Progress run(const script::RunToolCommand& c);
  Progress run(const script::FileOfClipboard& c);
  Progress run(const script::Quit& c);

  void run_commands();
  void fail(const std::string& what);
  /// Records a failure and ends the script.
  Progress give_up(const std::string& what);
  Progress build(const ToolAction& action);
  Progress propose(const EditDescriptor& edit, ActionPart part = ActionPart::alone);
  /// Proposes an edit with the joins of its voxels (joined_action()).
  Progress propose_joined(const EditDescriptor& edit);
  /// Proposes an edit with joins (propose_joined()), or the edit alone if the script names the
  /// states of the material.
  Progress propose_named(const EditDescriptor& edit);
  /// Starts a command with its edits. If they are refused, the command fails, and the script goes on.
  void start_edits(ToolEdits made);
  /// Proposes the edits of start_edits() that are left, or waits for the end of a large action.
  Progress propose_edits();
  /// Carries out a command of the tools. Returns the edits to propose.
  ToolEdits carry_out(const ToolCommand& command);
  std::optional<WorldPos> resolve(const ScriptPosition& position);
  std::optional<VoxelPos> resolve_voxel(const ScriptPosition& position);
  std::optional<Material> resolve_material(const std::string& name);
  std::optional<Mask> resolve_mask(const ScriptMask& mask);
  void start();
  /// Moves the player if a roam is in progress.
  void roam();
  /// Moves the player straight towards `to`. Returns true on arrival.
  bool go(const WorldPos& to, double distance);

  const Script& script_;
  ScriptHost& host_;
  std::size_t next_ = 0;
  std::size_t current_ = 0;  // index of the command that runs
  bool started_ = false;
  Started state_;
  std::vector<std::uint32_t> repeats_left_;  // rounds left of the open repeats, innermost last
  struct NamedBuild {
    BuildPtr build;
    EmptyCells empty = EmptyCells::pasted;
  };
  std::map<std::string, NamedBuild> clipboards_;
  ToolAction made_;           // of the tool command that runs
  bool is_building_ = false;  // a command waits for its action of any size
  struct Roaming {
    WorldPos to, back;
    double speed = 0;  // voxels a second
    TimeUs last_us = 0;
  };
  std::optional<Roaming> roaming_;
  TimeUs now_us_ = 0;
  std::optional<TimeUs> due_us_;
  bool finished_ = false;
  std::vector<std::string> failures_;
};

}  // namespace runstone
