// FrameScene: makes the camera and the contents of a frame, besides the chunks and the interface:
// other players, outlines and ghosts. Thread: the main thread.
#pragma once
#include <optional>
#include <vector>

#include "client/app/edit_tool.hpp"
#include "client/app/player.hpp"
#include "client/app/preview_exchange.hpp"
#include "client/app/view_follower.hpp"
#include "client/app/world_panels.hpp"
#include "client/render/frame_contents.hpp"
#include "client/render/renderer.hpp"
#include "client/session/client_session.hpp"

namespace runstone {

class FrameScene {
 public:
  /// All must outlive the scene.
  FrameScene(const ClientSession& session, const Player& player, const EditTool& tool,
             const PreviewExchange& previews, const ViewFollower& view, const WorldPanels& panels)
      : session_(session),
        player_(player),
        tool_(tool),
        previews_(previews),
        view_(view),
        panels_(panels) {}

  /// `field_of_view` is vertical, in degrees; nullopt: that of screenshots of scripts.
  Camera camera(std::optional<double> field_of_view) const;
  /// Returns the distance up to which ground is seen, in voxels: that of the tiles if some have
  /// arrived, otherwise that of the chunks.
  double reach() const;
  /// `outlines_aim`: the voxel in sight is outlined. `shows_ground`: protected boxes are outlined.
  FrameContents contents(bool outlines_aim, bool shows_ground) const;

 private:
  double draw_distance() const;  // of chunks, voxels
  void add_bodies(std::vector<Body>& bodies) const;
  void add_ground(std::vector<Marker>& markers) const;
  void add_aim(std::vector<Marker>& markers) const;
  /// Adds the outlines of the selection and of the places that a tool has so far.
  void add_selection(std::vector<Marker>& markers) const;

  const ClientSession& session_;
  const Player& player_;
  const EditTool& tool_;
  const PreviewExchange& previews_;
  const ViewFollower& view_;
  const WorldPanels& panels_;
};

}  // namespace runstone
