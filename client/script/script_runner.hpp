// ScriptRunner: runs a script against a host, a step at a time, on the clock that it is told. One thread.
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
  /// Both must outlive the runner.
  ScriptRunner(const Script& script, ScriptHost& host) : script_(script), host_(host) {}

  /// Runs commands until one has to wait. Cheap while waiting. At most kStepCommandsMax commands a call.
  void step(TimeUs now_us);
  bool finished() const { return finished_; }
  /// When something is due without news from outside; none if only news can go on.
  std::optional<TimeUs> due_us() const { return due_us_; }
  /// "file:line: what", in order. An expectation that fails does not end the script; a command that cannot
  /// run does.
  const std::vector<std::string>& failures() const { return failures_; }

  static constexpr int kStepCommandsMax = 256;

 private:
  enum class Progress { done, waits, stop };
  struct Started {  // the command that waits
    TimeUs at_us = 0;
    TimeUs last_us = 0;       // walk: moved up to here
    std::uint64_t mark = 0;   // synced
    std::uint32_t count = 0;  // burst: edits handed in
    SplitMix64 random{0};     // burst
    WorldPos centre;          // burst: the player at its start
  };

  Progress run(const script::Move& c);
  Progress run(const script::Walk& c);
  Progress run(const script::Roam& c);
  Progress run(const script::Look& c);
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
  Progress run(const script::Command& c);
  Progress run(const script::Quit& c);

  void run_commands();
  void fail(const std::string& what);
  /// A command that cannot run ends the script.
  Progress give_up(const std::string& what);
  Progress submit(const EditDescriptor& edit);
  std::optional<WorldPos> resolve(const ScriptPosition& position);
  std::optional<VoxelPos> resolve_voxel(const ScriptPosition& position);
  std::optional<Material> resolve_material(const std::string& name);
  std::optional<Mask> resolve_mask(const ScriptMask& mask);
  void start();
  /// Takes the player along the way of a roam, if there is one.
  void roam();
  /// Straight towards `to`. Returns whether it is there.
  bool go(const WorldPos& to, double distance);

  const Script& script_;
  ScriptHost& host_;
  std::size_t next_ = 0;
  std::size_t current_ = 0;  // the command that runs
  bool started_ = false;
  Started state_;
  std::vector<std::uint32_t> turns_left_;  // of the open repeats, innermost last
  std::map<std::string, std::shared_ptr<const Clipboard>> clipboards_;
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
