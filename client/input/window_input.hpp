// WindowInput: the input for the player from keyboard, mouse and gamepad since the last turn.
#pragma once
#include <vector>

#include "client/input/action.hpp"

namespace runstone {

struct WindowInput {
  bool forward = false, back = false, left = false, right = false, up = false, down = false,
       fast = false;                // keys held down
  double look_dx = 0, look_dy = 0;  // how far the mouse moved while captured, y downward
  double turn_x = 0, turn_y = 0;    // the stick by which the player turns, -1 to 1, y downward
  int remove_clicks = 0;            // left button presses
  int place_clicks = 0;             // right button presses
  int pick_clicks = 0;              // middle button presses
  bool remove_held = false, place_held = false;  // left and right button held down
  int scroll = 0;                                // wheel steps, up positive
  bool shows_players = false;                    // the key for the list of players is held
  bool resizes = false;                          // the key that gives the wheel to the tool is held
  std::vector<Action> actions;                   // of keys that were pressed, in their order
  bool close = false;                            // the window's close button
};

}  // namespace runstone
