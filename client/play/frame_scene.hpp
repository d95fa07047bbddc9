// FrameScene: makes the camera and the contents of a frame, besides the chunks and the interface:
// other players, outlines and ghosts. Thread: the main thread.
#pragma once
#include <optional>
#include <vector>

#include "client/panels/world_panels.hpp"
#include "client/play/edit_tool.hpp"
#include "client/play/others_previews.hpp"
#include "client/play/player.hpp"
#include "client/play/view_follower.hpp"
#include "client/render/frame_contents.hpp"
#include "client/render/renderer.hpp"
#include "client/session/client_session.hpp"

namespace runstone {

class FrameScene {
 public:
  /// All must outlive the scene.
  FrameScene(const ClientSession& session, const Player& player, const EditTool& tool,
             const ViewFollower& view, const WorldPanels& panels, const OthersPreviews& others)
      : session_(session),
        player_(player),
        tool_(tool),
        view_(view),
        panels_(panels),
        others_(others) {}

  /// Returns the camera. `field_of_view` is vertical, in degrees; nullopt means the field of view
  /// of the screenshots of scripts.
  Camera camera(std::optional<double> field_of_view) const;
  /// Returns the distance up to which ground is seen, in voxels: the reach of the tiles if some
  /// have arrived, otherwise the reach of the chunks.
  double reach() const;
  /// Returns the contents, with the ghosts of the tool, of a rollback and of the other players.
  /// `outlines_aim`: the voxel in sight is outlined. `shows_ground`: protected boxes are outlined.
  FrameContents contents(bool outlines_aim, bool shows_ground) const;

 private:
  double draw_distance() const;  // of chunks, voxels
  /// Returns the material around the eye. Above the surface of a liquid it is kEmpty.
  Material material_at_eye() const;
  void add_bodies(std::vector<Body>& bodies) const;
  void add_ground(std::vector<Marker>& markers) const;
  void add_aim(std::vector<Marker>& markers) const;
  /// Adds the outlines of the selection and of the places that a tool has so far.
  void add_selection(std::vector<Marker>& markers) const;

  const ClientSession& session_;
  const Player& player_;
  const EditTool& tool_;
  const ViewFollower& view_;
  const WorldPanels& panels_;
  const OthersPreviews& others_;
};

}  // namespace runstone
