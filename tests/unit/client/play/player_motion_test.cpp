#include "client/play/player_motion.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

struct MotionBench {
  Replica replica;
  Player player;
  PlayerMotion motion{replica, player};
};

WindowInput mouse(double dx, double dy) {
  WindowInput out;
  out.look_dx = dx;
  out.look_dy = dy;
  return out;
}

}  // namespace

TEST_CASE("sensitivity scales the mouse, and the vertical axis can be inverted", "[client_app]") {
  MotionBench plain, fast, inverted;
  plain.motion.step(mouse(10, 10), 0.01, {});
  fast.motion.step(mouse(10, 10), 0.01, {2, false});
  inverted.motion.step(mouse(10, 10), 0.01, {1, true});
  const auto pitch = [](const MotionBench& bench) { return bench.player.pose().pitch; };
  CHECK(pitch(plain) < 0);  // the mouse moved down
  CHECK(pitch(fast) == Approx(2 * pitch(plain)).margin(1));
  CHECK(pitch(inverted) == -pitch(plain));
}

TEST_CASE("a stick turns with time, as a mouse turns with its way", "[client_app]") {
  MotionBench once, twice;
  WindowInput stick;
  stick.turn_x = 1;
  once.motion.step(stick, 0.02, {});
  twice.motion.step(stick, 0.01, {});
  CHECK(once.player.pose().yaw != twice.player.pose().yaw);
  twice.motion.step(stick, 0.01, {});
  CHECK(once.player.pose().yaw == twice.player.pose().yaw);
}

TEST_CASE("a walking player stays in place while no world is open", "[client_app]") {
  MotionBench bench;
  bench.player.set_walking(true);
  WindowInput input;
  input.forward = true;
  bench.motion.step(input, 1, {});
  CHECK(bench.player.eye() == WorldPos{});
  bench.player.set_walking(false);
  bench.motion.step(input, 1, {});
  CHECK(bench.player.eye().z > 1);
}
