// The draw program is `runstone-client --draw`. It reads draw orders
// (protocol/codec/draw_order.hpp), draws each picture off screen into a PNG file and answers with a
// line (protocol/codec/draw_answer.hpp). Programs without OpenGL, the server and runstone-replay,
// start it as a child process. A driver that crashes ends only the child. One thread handles the
// orders one after another. A sender that is faster waits at the full pipe. The process runs at low
// priority.
#pragma once
#include <functional>
#include <memory>

#include "client/display/screen.hpp"

namespace runstone {

/// Handles the orders of the descriptor `orders` until the last one, and answers on the descriptor
/// `answers`. `workers` is the number of mesh threads. It ends if the reader of the answers closes
/// its end. Returns an exit code:
///   kExitOk       all pictures were written
///   kExitFailed   a picture could not be written; its answer named it, and later orders were
///                 handled
///   kExitNoStart  OpenGL is missing or failed, or an order is wrong, and the last answer gives the
///                 reason; or nobody reads the answers
int draw_program(int orders, int answers, unsigned workers,
                 const std::function<std::unique_ptr<Screen>()>& make_screen);

}  // namespace runstone
