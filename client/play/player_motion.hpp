// PlayerMotion: turns and moves the player by the input of keyboard, mouse and gamepad. One thread.
#pragma once
#include "client/body/body_materials.hpp"
#include "client/input/window_input.hpp"
#include "client/play/player.hpp"
#include "client/replica/replica.hpp"
#include "common/materials/material_table.hpp"
#include "common/shapes/shape_table.hpp"

namespace runstone {

/// How the mouse turns the player.
struct LookSettings {
  double sensitivity = 1;
  bool invert_y = false;  // mouse up looks down
};

class PlayerMotion {
 public:
  /// Both must outlive the object.
  PlayerMotion(const Replica& replica, Player& player) : replica_(replica), player_(player) {}

  /// Takes the materials of the world and their shapes: they decide where a walking player is
  /// stopped.
  void set_materials(const MaterialTable& materials, ShapeTablePtr shapes);
  /// Applies the input of the last `seconds`. Cost: that of Player::walk().
  void step(const WindowInput& input, double seconds, const LookSettings& look);

 private:
  const Replica& replica_;
  Player& player_;
  BodyMaterials body_materials_;
};

}  // namespace runstone
