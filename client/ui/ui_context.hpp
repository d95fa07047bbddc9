// UiContext: one Dear ImGui context without a window and without OpenGL. It takes input events and
// gives overlay frames, so that a headless client, a script or a test drives it as a window does.
// Thread: one thread; several contexts may live on it.
#pragma once
#include <array>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "client/input/input_event.hpp"
#include "client/render/overlay_frame.hpp"
#include "common/core/bytes.hpp"

struct ImGuiContext;

namespace runstone {

class UiContext {
 public:
  /// `scale` multiplies the size of text and of everything else; 1 is made for 1280x720. `font` has
  /// the bytes of a TrueType file, or none; nullopt reads the file of DejaVu Sans. Without a font
  /// the text has only the letters of Western Europe.
  explicit UiContext(double scale = 1, std::optional<ByteView> font = std::nullopt);
  ~UiContext();
  UiContext(const UiContext&) = delete;
  UiContext& operator=(const UiContext&) = delete;

  /// If `is_on`, arrows and tab choose buttons, space and enter press them, and control and tab change
  /// the window. Otherwise these keys do nothing in windows.
  void set_keyboard(bool is_on);
  /// Gives the keyboard to the window that was used last, and chooses its first button.
  void focus_window();
  /// Queues events for the next frame.
  void feed(const std::vector<InputEvent>& events);
  /// Drops the events that wait, and takes every key and button as released.
  void release_all();
  /// Calls `build`, which makes windows with ImGui, and returns the overlay of these windows.
  /// `size` is in pixels, `seconds` is the time since the last frame. If the queued events do not
  /// fit one frame, such as a press and a release of the same key, `build` is called several times,
  /// and the last call is the one that is returned. Cost: some 100 µs for a dozen windows.
  std::shared_ptr<const OverlayFrame> make_frame(std::array<int, 2> size, double seconds,
                                                 const std::function<void()>& build);

  /// Shows an image in the frame that is made, and returns its name for ImGui. Call it from
  /// `build`.
  void* add_image(std::shared_ptr<const OverlayImage> image);

  /// Makes a frame that takes no events and no time and is not returned. A text field that was
  /// asked to take the keyboard has it after at most kFocusFrames such frames, before it would miss
  /// events.
  void make_hidden_frame(std::array<int, 2> size, const std::function<void()>& build);
  static constexpr int kFocusFrames = 3;

  /// Returns true if, after the last frame, a text field had the keyboard.
  bool types() const;
  /// Returns the text of that field in UTF-8, or an empty one if no field has the keyboard.
  std::string field_text() const;
  /// Returns true if, after the last frame, the cursor was over a window.
  bool over_window() const;
  /// Returns true if, after the last frame, a window that takes the mouse was at this pixel.
  bool has_window_at(double x, double y) const;
  double scale() const { return scale_; }

 private:
  /// Applies queued events until one must wait for the next frame.
  void apply_events();
  void run_frame(std::array<int, 2> size, double seconds, const std::function<void()>& build);
  std::shared_ptr<const OverlayFrame> overlay_frame() const;

  struct Deleter {
    void operator()(ImGuiContext* context) const;
  };

  const double scale_;
  std::unique_ptr<ImGuiContext, Deleter> context_;
  std::shared_ptr<const OverlayAtlas> atlas_;
  std::vector<std::shared_ptr<const OverlayImage>> images_;  // of the frame that is made
  std::deque<InputEvent> events_;
};

}  // namespace runstone
