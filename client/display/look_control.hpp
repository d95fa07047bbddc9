// LookControl: chooses the look of the next frame. The automatic quality measures how long frames
// take and takes the highest level whose frames are short enough. Pure: durations are arguments.
//   - The levels are those of Quality, and below `low` two that draw the world in a lower
//     resolution.
//   - A lower level is taken if the median of kFrames frames is above the target, or earlier, after
//     kSlowFrames frames one after another that took more than twice the target.
//   - A higher level is taken if the median is below kUpShare of the target. If it turns out too
//     slow, the next attempt waits twice as many frames, so that the level does not change to and
//     fro.
// Thread: one.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "client/render/frame_look.hpp"
#include "common/core/ids.hpp"

namespace runstone {

class LookControl {
 public:
  /// With `exact`, every frame is a picture that depends only on the world and the view: quality
  /// high unless it is set, and still water.
  explicit LookControl(bool exact) : exact_(exact) {}

  void set_exact(bool exact) { exact_ = exact; }
  void set_time_of_day(double share) { look_.time_of_day = share; }
  double time_of_day() const { return look_.time_of_day; }
  /// Sets the quality. nullopt: automatic.
  void set_quality(std::optional<Quality> quality);
  std::optional<Quality> quality() const { return fixed_; }
  void set_antialiasing(Antialiasing antialiasing) { look_.antialiasing = antialiasing; }
  Antialiasing antialiasing() const { return look_.antialiasing; }

  /// Returns the name of the level that frames have now, such as "auto: medium" or "auto: low at
  /// 50 %".
  std::string name() const;
  /// Returns the look of a frame that begins now.
  FrameLook look(TimeUs now_us) const;
  /// Call it for each frame, with the time that drawing took.
  void frame_took(TimeUs us);

  /// A level of the automatic quality. kLevels begins with the level of least effort.
  struct Level {
    Quality quality;
    double scale;  // as FrameLook::scale
  };
  static constexpr std::array<Level, 5> kLevels = {{{Quality::low, 0.5},
                                                    {Quality::low, 0.75},
                                                    {Quality::low, 1},
                                                    {Quality::medium, 1},
                                                    {Quality::high, 1}}};
  /// Returns the index of the automatic level in kLevels.
  std::size_t level() const { return level_; }

  static constexpr TimeUs kTargetUs = 25'000;
  static constexpr double kUpShare = 0.45;
  static constexpr std::size_t kFrames = 24, kSlowFrames = 6;
  static constexpr unsigned kPatienceMax = 4096;  // frames

 private:
  void step_to(std::size_t level);

  bool exact_;
  FrameLook look_;
  std::optional<Quality> fixed_;
  std::size_t level_ = 3;  // automatic, of kLevels
  std::array<TimeUs, kFrames> took_{};
  std::size_t count_ = 0;         // of took_
  std::size_t slow_ = 0;          // how many of the last frames in a row took over twice the target
  unsigned waited_ = 0;           // frames since the last step
  unsigned patience_ = 120;       // frames before a step upwards
  bool came_from_below_ = false;  // the last step was upwards
};

/// Returns the quality of that name, or nullopt. "auto" is none of them.
std::optional<Quality> parse_quality(std::string_view name);
const char* to_string(Quality quality);

}  // namespace runstone
