// DrawThread: a DrawQueue with the thread that owns the screen. A frame may take long (a tenth of a
// second in software). Meanwhile changes are queued. So the main thread never waits, and applies,
// meshes and sends edits on time.
// Threads: the main thread makes, calls and destroys it. `wake` is called from the draw thread.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <thread>

#include "client/display/draw_queue.hpp"

namespace runstone {

enum class DrawPriority : std::uint8_t {
  normal,
  background,  // below the threads that apply and mesh; for off-screen frames
};

class DrawThread final : public DrawQueue {
 public:
  /// Calls `make_screen` on the new thread. If that throws, throws std::runtime_error with the same
  /// text.
  DrawThread(std::function<std::unique_ptr<Screen>()> make_screen, DrawPriority priority,
             std::function<void()> wake, UploadBudget budget = {});
  /// Finishes the current frame and drops queued work.
  ~DrawThread() override;

 private:
  void run(const std::function<std::unique_ptr<Screen>()>& make_screen, DrawPriority priority);

  std::thread thread_;
};

}  // namespace runstone
