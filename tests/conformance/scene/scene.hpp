// Scenes: what the server plays to a client, and what the client must do. Each scene is a row of the
// checklist.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "tests/conformance/scene/stage.hpp"

namespace runstone::conformance {

/// The chunk in which most scenes edit.
inline constexpr ChunkCoord kHome{0, 0, 0};

/// The two parts of the checklist.
enum class Part {
  minimum,  // the minimum client of docs/protocol.md
  further,  // what a client may leave out
};

struct Scene {
  std::string name;     // such as "lost-commit"
  std::string section;  // of docs/protocol.md
  Part part = Part::minimum;
  std::string words;  // what the client must do
  /// Throws SceneFailed or SceneUntried.
  std::function<void(Stage&)> play;
};

/// Returns all scenes in the order of the checklist.
std::vector<Scene> all_scenes();

// The scenes by what they are about.
std::vector<Scene> join_scenes();
std::vector<Scene> terrain_scenes();
std::vector<Scene> commit_scenes();
std::vector<Scene> edit_scenes();
std::vector<Scene> end_scenes();
std::vector<Scene> frame_scenes();
std::vector<Scene> message_scenes();
std::vector<Scene> further_scenes();

}  // namespace runstone::conformance
