#include "client/display/draw_thread.hpp"

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <utility>

#include "common/core/assert.hpp"
#include "common/os/low_priority.hpp"
#include "common/os/steady_clock.hpp"

namespace runstone {
namespace {

FrameDone draw_frame(Screen& screen, const FrameOrder& order) {
  FrameDone done;
  done.started_us = steady_now_us();
  screen.set_overlay(order.overlay);
  done.stats = screen.draw(order.camera, order.width, order.height, order.contents);
  done.presented_us = steady_now_us();
  if (order.screenshots.empty()) return done;
  const Image image = screen.read_image();
  for (const std::string& file : order.screenshots) {
    if (!write_png(file, image)) done.unwritten.push_back(file);
  }
  return done;
}

}  // namespace

DrawThread::DrawThread(std::function<std::unique_ptr<Screen>()> make_screen, DrawPriority priority,
                       std::function<void()> wake)
    : wake_(std::move(wake)),
      thread_([this, make = std::move(make_screen), priority](const std::stop_token& stop) {
        run(stop, make, priority);
      }) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return state_ != State::starting; });
  if (state_ == State::failed) throw std::runtime_error(failure_);
}

DrawThread::~DrawThread() = default;

void DrawThread::set_materials(const MaterialTable& materials) {
  {
    const std::lock_guard lock(mutex_);
    work_.materials = materials;
  }
  changed_.notify_one();
}

void DrawThread::upload(const ChunkKey& key, ChunkUpload upload) {
  queued_.insert(key);
  {
    const std::lock_guard lock(mutex_);
    work_.changes.insert_or_assign(key, std::move(upload));
  }
  changed_.notify_one();
}

void DrawThread::remove(const ChunkKey& key) {
  queued_.erase(key);
  {
    const std::lock_guard lock(mutex_);
    work_.changes.insert_or_assign(key, std::nullopt);
  }
  changed_.notify_one();
}

void DrawThread::clear() {
  {
    std::unique_lock lock(mutex_);
    work_ = {};
    changed_.wait(lock, [this] { return !is_busy_ || state_ == State::failed; });
    if (state_ == State::failed) throw std::runtime_error(failure_);
    done_.clear();
    for (const ChunkKey& key : queued_) work_.changes.emplace(key, std::nullopt);
  }
  queued_.clear();
  frame_ordered_ = false;
  changed_.notify_all();
}

void DrawThread::draw(FrameOrder order) {
  RUNSTONE_ASSERT(!frame_ordered_);
  frame_ordered_ = true;
  {
    const std::lock_guard lock(mutex_);
    work_.frame = std::move(order);
  }
  changed_.notify_one();
}

std::vector<DrawDone> DrawThread::take_done() {
  std::vector<DrawDone> out;
  {
    const std::lock_guard lock(mutex_);
    if (state_ == State::failed) throw std::runtime_error(failure_);
    out.swap(done_);
  }
  if (std::any_of(out.begin(), out.end(),
                  [](const DrawDone& d) { return std::holds_alternative<FrameDone>(d); }))
    frame_ordered_ = false;
  return out;
}

std::size_t DrawThread::waiting() const {
  const std::lock_guard lock(mutex_);
  return work_.changes.size();
}

void DrawThread::run(const std::stop_token& stop,
                     const std::function<std::unique_ptr<Screen>()>& make_screen,
                     DrawPriority priority) {
  // No exception may leave this function, because it would end the program.
  try {
    if (priority == DrawPriority::background) lower_priority();
    const std::unique_ptr<Screen> screen = make_screen();
    name_ = screen->name();
    {
      const std::lock_guard lock(mutex_);
      state_ = State::drawing;
    }
    changed_.notify_all();
    serve(stop, *screen);
  } catch (const std::exception& error) {
    fail(error.what());
  } catch (...) {
    fail("drawing failed for an unknown reason");
  }
}

void DrawThread::serve(const std::stop_token& stop, Screen& screen) {
  while (const std::optional<Work> work = next(stop)) {
    if (work->materials) screen.set_materials(*work->materials);
    std::vector<DrawDone> uploads;
    for (const auto& [key, upload] : work->changes) {
      if (upload) {
        screen.upload(key, upload->edge, *upload->mesh, upload->voxels.get());
        uploads.emplace_back(UploadDone{key, upload->serial, steady_now_us()});
      } else {
        screen.remove(key);
      }
    }
    if (!uploads.empty()) done(std::move(uploads));
    if (!work->frame) continue;
    std::vector<DrawDone> frame;
    frame.emplace_back(draw_frame(screen, *work->frame));
    done(std::move(frame));
  }
}

std::optional<DrawThread::Work> DrawThread::next(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  is_busy_ = false;
  changed_.notify_all();
  if (!changed_.wait(lock, stop, [this] { return !work_.empty(); }) || stop.stop_requested())
    return std::nullopt;
  is_busy_ = true;
  return std::exchange(work_, {});
}

void DrawThread::done(std::vector<DrawDone> done) {
  {
    const std::lock_guard lock(mutex_);
    std::move(done.begin(), done.end(), std::back_inserter(done_));
  }
  if (wake_) wake_();
}

void DrawThread::fail(const char* why) {
  {
    const std::lock_guard lock(mutex_);
    failure_ = why;
    state_ = State::failed;
  }
  changed_.notify_all();
  if (wake_) wake_();
}

}  // namespace runstone
