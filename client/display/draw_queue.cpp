#include "client/display/draw_queue.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "client/display/eye_chunk.hpp"
#include "client/render/png_file.hpp"
#include "common/core/assert.hpp"
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
    if (const auto written = write_png(file, image); !written)
      done.unwritten.push_back(written.error());
  }
  return done;
}

}  // namespace

DrawQueue::DrawQueue(std::function<void()> wake, UploadBudget budget)
    : wake_(std::move(wake)), budget_(budget) {}

void DrawQueue::set_materials(const MaterialTable& materials, ShapeTablePtr shapes) {
  {
    const std::lock_guard lock(mutex_);
    work_.materials = Materials{materials, std::move(shapes)};
  }
  changed_.notify_one();
}

void DrawQueue::set_textures(DrawnTexturesPtr textures) {
  has_textures_ = textures != nullptr;
  {
    const std::lock_guard lock(mutex_);
    work_.textures = std::move(textures);
  }
  changed_.notify_one();
}

void DrawQueue::upload(const ChunkKey& key, ChunkUpload upload) {
  queued_.insert(key);
  {
    const std::lock_guard lock(mutex_);
    work_.changes.put(key, std::move(upload));
  }
  changed_.notify_one();
}

void DrawQueue::remove(const ChunkKey& key) {
  queued_.erase(key);
  {
    const std::lock_guard lock(mutex_);
    work_.changes.remove(key);
  }
  changed_.notify_one();
}

void DrawQueue::clear() {
  {
    std::unique_lock lock(mutex_);
    work_ = {};
    changed_.wait(lock, [this] { return !is_busy_ || state_ == State::failed; });
    if (state_ == State::failed) throw std::runtime_error(failure_);
    done_.clear();
    for (const ChunkKey& key : queued_) work_.changes.remove(key);
    if (std::exchange(has_textures_, false)) work_.textures = DrawnTexturesPtr();
  }
  queued_.clear();
  frame_ordered_ = false;
  changed_.notify_all();
}

void DrawQueue::draw(FrameOrder order) {
  RUNSTONE_ASSERT(!frame_ordered_);
  frame_ordered_ = true;
  {
    const std::lock_guard lock(mutex_);
    work_.frame = std::move(order);
  }
  changed_.notify_one();
}

std::vector<DrawDone> DrawQueue::take_done() {
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

std::size_t DrawQueue::waiting() const {
  const std::lock_guard lock(mutex_);
  return work_.changes.size();
}

void DrawQueue::set_drawing(const char* screen_name) {
  name_ = screen_name;
  {
    const std::lock_guard lock(mutex_);
    state_ = State::drawing;
  }
  changed_.notify_all();
}

void DrawQueue::await_start() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return state_ != State::starting; });
  if (state_ == State::failed) throw std::runtime_error(failure_);
}

void DrawQueue::stop() {
  {
    const std::lock_guard lock(mutex_);
    stops_ = true;
  }
  changed_.notify_all();
}

bool DrawQueue::await_work() {
  std::unique_lock lock(mutex_);
  is_busy_ = false;
  changed_.notify_all();
  changed_.wait(lock, [this] { return stops_ || !work_.empty(); });
  is_busy_ = !stops_;
  return is_busy_;
}

void DrawQueue::serve(Screen& screen) {
  std::optional<FrameOrder> order;
  {
    const std::lock_guard lock(mutex_);
    order = std::exchange(work_.frame, std::nullopt);
  }
  apply_removals(screen);
  if (!order) return upload_until_ordered(screen);
  const std::size_t carried = upload_for(*order, screen);
  std::vector<DrawDone> frame;
  frame.emplace_back(draw_frame(screen, *order));
  auto& drawn = std::get<FrameDone>(frame.back());
  drawn.upload_us = std::exchange(uploads_.us, 0);
  drawn.uploads = std::exchange(uploads_.count, 0);
  drawn.carried = carried;
  done(std::move(frame));
}

void DrawQueue::apply_removals(Screen& screen) {
  std::optional<Materials> materials;
  std::optional<DrawnTexturesPtr> textures;
  std::vector<ChunkKey> removals;
  {
    const std::lock_guard lock(mutex_);
    materials = std::exchange(work_.materials, std::nullopt);
    textures = std::exchange(work_.textures, std::nullopt);
    removals = work_.changes.take_removals();
  }
  if (materials) screen.set_materials(materials->table, materials->shapes);
  if (textures) screen.set_textures(*textures);
  for (const ChunkKey& key : removals) screen.remove(key);
}

void DrawQueue::upload_until_ordered(Screen& screen) {
  const TimeUs until_us = steady_now_us() + budget_.time_us;
  do {
    std::optional<std::pair<ChunkKey, ChunkUpload>> next;
    {
      const std::lock_guard lock(mutex_);
      if (work_.frame || work_.materials) break;
      next = work_.changes.take_upload();
    }
    if (!next) break;
    upload(screen, next->first, next->second);
  } while (steady_now_us() < until_us);
  report_uploads();
}

std::size_t DrawQueue::upload_for(const FrameOrder& order, Screen& screen) {
  if (order.shows_all) {
    UploadQueue all;
    {
      const std::lock_guard lock(mutex_);
      all = std::exchange(work_.changes, {});
    }
    for (const ChunkKey& key : all.take_removals()) screen.remove(key);
    while (const auto next = all.take_upload()) upload(screen, next->first, next->second);
    report_uploads();
    return 0;
  }
  const TimeUs until_us = steady_now_us() + budget_.time_us;
  std::size_t bytes = 0, carried = 0;
  bool is_first = true;
  while (true) {
    std::optional<std::pair<ChunkKey, ChunkUpload>> next;
    {
      const std::lock_guard lock(mutex_);
      UploadQueue& changes = work_.changes;
      if (is_first) {
        changes.set_eye(chunk_of_eye(order.camera, edge_));
        changes.frame_passed();
      }
      // A chunk behind new materials may use them, so it waits for the next frame.
      const bool is_spent =
          work_.materials || bytes >= budget_.bytes || steady_now_us() >= until_us;
      if (is_first || !is_spent) next = changes.take_upload();
      carried = changes.upload_count();
    }
    if (!next) break;
    is_first = false;
    upload(screen, next->first, next->second);
    bytes += gpu_bytes(next->second);
  }
  report_uploads();
  return carried;
}

void DrawQueue::upload(Screen& screen, const ChunkKey& key, const ChunkUpload& upload) {
  const TimeUs start_us = steady_now_us();
  if (upload.tile) {
    screen.upload_tile(key, upload.edge, *upload.tile);
  } else {
    screen.upload(key, upload.edge, *upload.mesh, upload.voxels.get());
  }
  const TimeUs end_us = steady_now_us();
  edge_ = upload.edge;
  uploads_.us += end_us - start_us;
  ++uploads_.count;
  uploads_.done.emplace_back(UploadDone{key, upload.number, upload.serial, end_us});
}

void DrawQueue::report_uploads() {
  if (!uploads_.done.empty()) done(std::exchange(uploads_.done, {}));
}

void DrawQueue::done(std::vector<DrawDone> done) {
  {
    const std::lock_guard lock(mutex_);
    std::move(done.begin(), done.end(), std::back_inserter(done_));
  }
  if (wake_) wake_();
}

void DrawQueue::fail(const char* why) {
  {
    const std::lock_guard lock(mutex_);
    failure_ = why;
    state_ = State::failed;
  }
  changed_.notify_all();
  if (wake_) wake_();
}

}  // namespace runstone
