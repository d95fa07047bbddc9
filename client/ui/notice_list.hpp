// NoticeList: short texts for the player that fade after some seconds: why an edit was refused,
// where a picture was written, that the server is read-only. One thread.
#pragma once
#include <cstdint>
#include <deque>
#include <string>

namespace runstone {

enum class NoticeKind : std::uint8_t { information, warning };

class NoticeList {
 public:
  static constexpr std::size_t kNoticesMax = 6;  // beyond it the oldest one is dropped
  static constexpr double kShownSeconds = 6, kFadeSeconds = 1;

  /// Adds a notice. If the newest one has the same text, counts it instead.
  void add(std::string text, NoticeKind kind);
  /// Lets time pass, and drops notices that have faded.
  void advance(double seconds);
  bool is_fading() const { return !notices_.empty() && notices_.front().age > kShownSeconds; }
  /// Makes the notices with ImGui, over all windows. Their lowest line is above `bottom` pixels.
  /// Warnings have a mark before them. Texts are wrapped to the width of the frame.
  void build(double bottom, double scale) const;

 private:
  struct Notice {
    std::string text;
    NoticeKind kind = NoticeKind::information;
    int count = 1;
    double age = 0;  // seconds
  };
  std::deque<Notice> notices_;
};

}  // namespace runstone
