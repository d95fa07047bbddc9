#include "tests/conformance/scene/scene.hpp"

#include <iterator>
#include <utility>

namespace runstone::conformance {

std::vector<Scene> all_scenes() {
  std::vector<Scene> out;
  for (auto* make : {join_scenes, terrain_scenes, commit_scenes, edit_scenes, end_scenes,
                     frame_scenes, message_scenes, further_scenes}) {
    std::vector<Scene> some = make();
    out.insert(out.end(), std::make_move_iterator(some.begin()),
               std::make_move_iterator(some.end()));
  }
  return out;
}

}  // namespace runstone::conformance
