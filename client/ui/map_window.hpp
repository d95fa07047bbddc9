// MapWindow: the map from above. The wheel zooms at the cursor, dragging moves the map, and a click
// makes a place the centre. +x is to the right and +z is down. One thread.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "client/map/world_map.hpp"
#include "client/ui/ui_context.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

/// A player on the map.
struct MapPlayer {
  std::string name;
  double x = 0, z = 0;  // voxels
  double yaw = 0;       // radians; 0 looks along +z, and it grows towards +x
};

/// The content of the map besides its tiles.
struct MapState {
  const WorldMap* map = nullptr;  // null: there is no world yet
  MapPlayer me;
  std::vector<MapPlayer> others;
  double spawn_x = 0, spawn_z = 0;
};

class MapWindow {
 public:
  /// Pixels for each voxel at scale 1.
  static constexpr double kZoomMin = 1.0 / 8, kZoomMax = 16;

  void toggle() { is_open_ = !is_open_; }
  void set_open(bool is_open) { is_open_ = is_open; }
  bool close() { return std::exchange(is_open_, false); }
  bool is_open() const { return is_open_; }
  /// Lets the window take all of the frame, or a part of it.
  void set_full(bool is_full) { is_full_ = is_full; }
  /// Sets the pixels for each voxel, within the limits.
  void set_zoom(double zoom);
  double zoom() const { return zoom_; }
  bool follows() const { return follows_; }
  /// Returns the place in the middle of the map, as of the last build().
  double centre_x() const { return centre_x_; }
  double centre_z() const { return centre_z_; }

  /// Makes the window with ImGui. The images of the tiles join the frame of `context`.
  void build(const MapState& state, const MaterialTable& materials, UiContext& context);

 private:
  struct Canvas;
  void build_buttons(const MapState& state);
  /// Takes wheel, drags and clicks on the canvas.
  void take_mouse(const Canvas& canvas);
  static void draw(const Canvas& canvas, const MapState& state, UiContext& context);
  static std::string text_at(const Canvas& canvas, const MapState& state,
                             const MaterialTable& materials);

  bool is_open_ = false, is_full_ = false;
  bool follows_ = true;  // the player is in the middle
  bool is_dragged_ = false;
  double zoom_ = 2;
  double centre_x_ = 0, centre_z_ = 0;  // voxels
};

}  // namespace runstone
