// RareLine: a line for the operator that a peer can cause as often as it likes. It is printed once
// a minute at most, and says how often it was left out. Thread: one.
#pragma once
#include <cstdint>
#include <string>

#include "common/core/ids.hpp"
#include "server/web/web_log.hpp"

namespace runstone {

class RareLine {
 public:
  static constexpr TimeUs kEveryUs = 60'000'000;

  void print(TimeUs now_us, const std::string& line) {
    if (is_printed_ && now_us - printed_us_ < kEveryUs) {
      ++left_out_;
      return;
    }
    log_web_line(left_out_ == 0
                     ? line
                     : line + " (" + std::to_string(left_out_) + " more since the last such line)");
    is_printed_ = true;
    printed_us_ = now_us;
    left_out_ = 0;
  }

 private:
  bool is_printed_ = false;
  TimeUs printed_us_ = 0;
  std::uint64_t left_out_ = 0;
};

}  // namespace runstone
