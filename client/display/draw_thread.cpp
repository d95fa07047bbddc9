#include "client/display/draw_thread.hpp"

#include <exception>
#include <utility>

#include "common/os/low_priority.hpp"

namespace runstone {

DrawThread::DrawThread(std::function<std::unique_ptr<Screen>()> make_screen, DrawPriority priority,
                       std::function<void()> wake, UploadBudget budget)
    : DrawQueue(std::move(wake), budget),
      thread_([this, make = std::move(make_screen), priority] { run(make, priority); }) {
  try {
    await_start();
  } catch (...) {
    thread_.join();
    throw;
  }
}

DrawThread::~DrawThread() {
  stop();
  thread_.join();
}

void DrawThread::run(const std::function<std::unique_ptr<Screen>()>& make_screen,
                     DrawPriority priority) {
  // No exception may leave this function, because it would end the program.
  try {
    if (priority == DrawPriority::background) lower_priority();
    const std::unique_ptr<Screen> screen = make_screen();
    set_drawing(screen->name());
    while (await_work()) serve(*screen);
  } catch (const std::exception& error) {
    fail(error.what());
  } catch (...) {
    fail("drawing failed for an unknown reason");
  }
}

}  // namespace runstone
