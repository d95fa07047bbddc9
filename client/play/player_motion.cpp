#include "client/play/player_motion.hpp"

#include <utility>

#include "client/body/shown_space.hpp"

namespace runstone {
namespace {

/// A stick of a gamepad that is wholly to the side turns as the mouse does by so many units a
/// second.
constexpr double kStickLook = 1'000;

}  // namespace

void PlayerMotion::set_materials(const MaterialTable& materials, ShapeTablePtr shapes) {
  body_materials_ = body_materials(materials, std::move(shapes));
}

void PlayerMotion::step(const WindowInput& input, double seconds, const LookSettings& look) {
  WindowInput turned = input;
  turned.look_dx += input.turn_x * kStickLook * seconds;
  turned.look_dy += input.turn_y * kStickLook * seconds;
  turned.look_dx *= look.sensitivity;
  turned.look_dy *= look.sensitivity * (look.invert_y ? -1 : 1);
  player_.turn(turned);
  if (!player_.is_walking()) return player_.fly(input, seconds);
  if (replica_.opened()) player_.walk(input, seconds, ShownSpace(replica_), body_materials_);
}

}  // namespace runstone
