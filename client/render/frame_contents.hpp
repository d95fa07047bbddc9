// FrameContents: everything that a frame shows besides the chunks.
#pragma once
#include <vector>

#include "client/render/body.hpp"
#include "client/render/frame_look.hpp"
#include "client/render/ghost.hpp"
#include "client/render/inspection.hpp"
#include "client/render/marker.hpp"
#include "common/core/ids.hpp"

namespace runstone {

struct FrameContents {
  FrameLook look;
  Material at_eye = kEmpty;  // of the voxel that holds the eye
  std::vector<Marker> markers;
  std::vector<Body> bodies;
  std::vector<GhostChunk> ghosts;
  Inspection inspection;
};

}  // namespace runstone
