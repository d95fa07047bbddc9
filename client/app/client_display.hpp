// ClientDisplay: the window, the draw thread and the tools of runstone-client. They outlive a
// server: the player leaves one and joins another in the same window, with the same clipboard.
// Thread: the main thread.
#pragma once
#include <memory>

#include "client/app/clipboard_file.hpp"
#include "client/app/options.hpp"
#include "client/display/draw_thread.hpp"
#include "client/net/wake_up.hpp"
#include "client/platform/window.hpp"
#include "client/tools/tool_box.hpp"

namespace runstone {

struct ClientDisplay {
  /// Makes the window and the draw thread that the options require. Throws std::runtime_error if
  /// there is no display or OpenGL is missing.
  explicit ClientDisplay(const ClientOptions& options);

  WakeUp wake;                              // of the main thread, from all other threads
  std::unique_ptr<Window> window;           // null off screen
  std::unique_ptr<DrawThread> draw_thread;  // null if nothing is drawn
  ToolBox tools;
  /// Keeps the clipboard; null unless a person plays in a window.
  std::unique_ptr<ClipboardFile> clipboard;
};

}  // namespace runstone
