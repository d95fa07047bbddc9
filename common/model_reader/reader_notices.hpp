// ReaderNotices: what a reader could not read of a model, as lines for the user, a bounded number of them.
// Thread: one.
#pragma once
#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "common/models/model_bytes.hpp"
#include "common/models/printable_line.hpp"

namespace runstone {

class ReaderNotices {
 public:
  /// Adds a line unless it is there. The bytes of files in it are made printable.
  void add(const std::string& text) {
    std::string line = printable_line(text, kModelNoticeBytesMax);
    if (std::find(lines_.begin(), lines_.end(), line) != lines_.end()) return;
    if (lines_.size() + 1 < kModelNoticesMax) {
      lines_.push_back(std::move(line));
    } else {
      ++left_out_;
    }
  }
  /// Returns the lines, at most kModelNoticesMax.
  std::vector<std::string> take() {
    if (left_out_ > 0) lines_.push_back("and " + std::to_string(left_out_) + " notices more");
    return std::move(lines_);
  }

 private:
  std::vector<std::string> lines_;
  std::size_t left_out_ = 0;
};

}  // namespace runstone
