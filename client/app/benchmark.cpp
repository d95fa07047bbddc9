#include "client/app/benchmark.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace runstone {

void Benchmark::step(Player& player, MeshPipeline& pipeline, const ViewFollower& view) {
  if (finished()) return;
  const auto go = [&](std::uint32_t frame) {
    const FlightPath::Place place = path_.place(frame);
    player.move_to(place.at);
    player.look(place.yaw, place.pitch);
    pipeline.moved();
    presented_ = pipeline.frames_presented();
  };
  if (!is_flying_) {
    if (presented_ == 0) go(0);
    // The first frames compile shaders and draw all shadows.
    is_flying_ = view.is_complete() && pipeline.is_up_to_date() &&
                 pipeline.frames_presented() >= presented_ + 2;
    if (is_flying_) {
      pipeline.set_unpaced(true);
      pipeline.look().set_exact(false);
      go(0);
    } else {
      pipeline.moved();
    }
    return;
  }
  if (pipeline.frames_presented() == presented_) return;
  frame_ms_.push_back(static_cast<double>(pipeline.last_frame_us()) / 1000);
  if (++frame_ < path_.frames()) go(frame_);
}

std::string Benchmark::table(const std::string& renderer, const std::string& quality) const {
  std::vector<double> sorted = frame_ms_;
  std::sort(sorted.begin(), sorted.end());
  const auto quantile = [&sorted](double q) {
    return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1) + 0.5)];
  };
  return fmt::format(
      "benchmark: {} frames, ms each: p50 {:.2f}, p90 {:.2f}, p99 {:.2f}, max {:.2f} "
      "(renderer {}, quality {})\n",
      sorted.size(), quantile(0.5), quantile(0.9), quantile(0.99), sorted.back(), renderer,
      quality);
}

}  // namespace runstone
