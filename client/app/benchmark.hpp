// Benchmark: flies a camera path and prints how long its frames took. A frame is ordered when the
// one before is presented, so no pause is measured. Thread: the main thread.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "client/app/flight_path.hpp"
#include "client/display/mesh_pipeline.hpp"
#include "client/play/player.hpp"
#include "client/play/view_follower.hpp"

namespace runstone {

class Benchmark {
 public:
  explicit Benchmark(FlightPath path) : path_(std::move(path)) {}

  /// Moves the player to the place of the next frame if the last one was presented. Begins when the
  /// view at the first place is complete and meshed.
  void step(Player& player, MeshPipeline& pipeline, const ViewFollower& view);
  bool finished() const { return frame_ == path_.frames(); }
  /// Returns one line with the percentiles of the time that frames took, in ms, and the renderer
  /// and quality that drew them. Requires finished().
  std::string table(const std::string& renderer, const std::string& quality) const;

 private:
  FlightPath path_;
  std::uint32_t frame_ = 0;  // frames that are measured
  bool is_flying_ = false;
  std::uint64_t presented_ = 0;  // frames presented when the last step was made
  std::vector<double> frame_ms_;
};

}  // namespace runstone
