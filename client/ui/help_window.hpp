// HelpWindow: the table of keys and mouse buttons. It fits the frame, and scrolls by the wheel, the
// arrow keys and pages. One thread.
#pragma once
#include <utility>
#include <vector>

#include "client/input/key_rows.hpp"

namespace runstone {

class HelpWindow {
 public:
  void toggle() { is_open_ = !is_open_; }
  /// Closes the window. Returns false if it was closed before.
  bool close() { return std::exchange(is_open_, false); }
  bool is_open() const { return is_open_; }
  /// Scrolls by so many pages down when the window is made next. A negative number scrolls up.
  void scroll(int pages) { pages_ += pages; }
  /// Makes the window with ImGui.
  void build(const std::vector<KeyRow>& rows);

 private:
  bool is_open_ = false;
  int pages_ = 0;  // to scroll
};

}  // namespace runstone
