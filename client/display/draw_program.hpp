// The draw program: `runstone-client --draw`. Reads draw orders (protocol/codec/draw_order.hpp), draws each
// picture off screen into its PNG and answers it with a line (draw_answer.hpp). A program that has no OpenGL
// of its own, the server or runstone-replay, starts it as a child: the renderer stays on this side of the
// house, and a driver that crashes takes down nobody else.
// Orders are read, meshed and drawn by one thread, one after another; whoever writes them is held back by the
// pipe meanwhile. Runs at low priority: nobody watches.
#pragma once
#include <functional>
#include <memory>

#include "client/display/screen.hpp"

namespace runstone {

/// Serves the descriptor `orders` until its last order, answering on `answers`. `workers`: mesh threads.
/// Returns an exit code: kExitOk; kExitFailed if a picture could not be written (the answer said so, and the
/// orders after it were served); kExitNoStart if there is no OpenGL or no more, or an order is wrong: the last
/// answer says which. Who no longer reads the answers ends the process (SIGPIPE).
int draw_program(int orders, int answers, unsigned workers,
                 const std::function<std::unique_ptr<Screen>()>& make_screen);

}  // namespace runstone
