#include "client/app/picture.hpp"

#include <spdlog/spdlog.h>

#include <utility>

#include "client/net/steady_clock.hpp"
#include "common/mesh/visibility.hpp"

namespace runstone {

Picture::Picture(const Replica& replica, std::unique_ptr<Screen> screen, unsigned workers,
                 std::function<void()> wake)
    : screen_(std::move(screen)),
      workers_(workers),
      wake_(std::move(wake)),
      recorder_(screen_ ? LatencyStage::presented : LatencyStage::meshed),
      planner_(replica) {}

void Picture::set_materials(const MaterialTable& materials) {
  if (pool_ && materials_ == materials) return;
  materials_ = materials;
  if (screen_) screen_->renderer().set_materials(materials_);
  pool_.reset();
  pool_ = std::make_unique<MeshPool>(VisibilityTable(materials_), workers_, steady_now_ns, wake_);
}

void Picture::take(const ReplicaNews& news, const ClockOffset& clock, TimeUs now_us) {
  recorder_.take(news, clock, now_us);
  planner_.take(news.chunks);
  if (!screen_) return;
  for (const ChunkNews& chunk : news.chunks) {
    if (!chunk.removed) continue;
    screen_->renderer().remove(chunk.key);
    changed_ = true;
  }
}

void Picture::mesh() {
  if (!pool_) return;
  take_results();
  push_jobs();
}

void Picture::take_results() {
  for (const MeshResult& result : pool_->take_results()) {
    mesh_ns_.add(result.mesh_ns);
    if (!planner_.accept(result.key, result.number)) continue;
    recorder_.meshed(result.key, result.serial, result.meshed_us);
    if (!screen_) continue;
    screen_->renderer().upload(result.key, result.edge, result.mesh);
    recorder_.uploaded(result.key, result.serial, steady_now_us());
    changed_ = true;
    edits_uploaded_ = edits_uploaded_ || recorder_.open_edits() != 0;
  }
}

void Picture::push_jobs() {
  while (pool_->in_flight() < pool_->capacity()) {
    auto job = planner_.next();
    if (!job) return;
    pool_->push(std::move(*job));
  }
}

bool Picture::draw(TimeUs now_us, const Camera& camera, const std::function<std::vector<Marker>()>& markers) {
  if (!screen_) return false;
  const bool screenshot_due =
      !screenshots_.empty() && (is_idle() || now_us - screenshot_since_us_ > kScreenshotWaitUs);
  // Off screen nobody watches terrain arrive: frames are for edits and pictures, and would only slow the
  // loading.
  const TimeUs pause = screen_->window() != nullptr ? kFrameUs : kFrameOffScreenUs;
  const bool due = changed_ && now_us - drawn_us_ >= pause;
  if (!due && !screenshot_due && !edits_uploaded_) return false;
  const auto drawn_markers = markers();
  screen_->draw(camera, drawn_markers);
  drawn_us_ = steady_now_us();
  recorder_.presented(drawn_us_);
  changed_ = false;
  edits_uploaded_ = false;
  if (screenshot_due) take_screenshots();
  return true;
}

void Picture::request_screenshot(std::string path, TimeUs now_us) {
  screenshots_.push_back(std::move(path));
  screenshot_since_us_ = now_us;
}

void Picture::take_screenshots() {
  const Image image = screen_->renderer().read_image();
  for (const std::string& path : std::exchange(screenshots_, {})) {
    if (!write_png(path, image)) spdlog::error("cannot write {}", path);
  }
}

void Picture::report(ChunkStats& stats) const {
  stats.mesh_ns = mesh_ns_;
  stats.mesh_jobs = planner_.jobs();
  stats.chunks_meshed = planner_.chunks_meshed();
}

}  // namespace runstone
