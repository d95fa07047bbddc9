// VirtualDisplay: an X server without a screen (Xvfb) on a free display number. xdotool controls
// its mouse and keys. Pixels are read from the framebuffer file of Xvfb.
#pragma once
#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "tests/integration/client/window/child_process.hpp"

namespace runstone::test {

using Pixel = std::array<int, 3>;  // red, green, blue

/// A part of the display.
struct Grab {
  int width = 0, height = 0;
  std::vector<Pixel> pixels;  // rows from the top
  Pixel mean() const {
    Pixel sum{};
    for (const Pixel& p : pixels) {
      for (std::size_t c = 0; c < 3; ++c) sum[c] += p[c];
    }
    for (int& c : sum) c /= static_cast<int>(pixels.size());
    return sum;
  }
  friend bool operator==(const Grab&, const Grab&) = default;
};

/// Returns the share of pixels that differ by more than `step` in some colour. Requires equal
/// sizes.
inline double changed_share(const Grab& a, const Grab& b, int step = 12) {
  REQUIRE(a.pixels.size() == b.pixels.size());
  std::size_t changed = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    bool differs = false;
    for (std::size_t c = 0; c < 3; ++c)
      differs = differs || std::abs(a.pixels[i][c] - b.pixels[i][c]) > step;
    changed += differs ? 1 : 0;
  }
  return static_cast<double>(changed) / static_cast<double>(a.pixels.size());
}

class VirtualDisplay {
 public:
  /// `folder` is for the framebuffer and logs. Requires that both programs are installed.
  VirtualDisplay(const std::string& folder, int width, int height)
      : folder_(folder), xdotool_(find_program("xdotool").value()) {
    int ends[2];
    REQUIRE(::pipe2(ends, O_CLOEXEC) == 0);
    server_.emplace(
        std::vector<std::string>{find_program("Xvfb").value(), "-displayfd",
                                 std::to_string(ends[1]), "-screen", "0",
                                 std::to_string(width) + "x" + std::to_string(height) + "x24",
                                 "-fbdir", folder, "-nolisten", "tcp", "-noreset"},
        folder + "/xvfb.log", std::vector<std::string>{}, ends[1]);
    ::close(ends[1]);
    std::string number;
    // Xvfb writes its display number when it is ready, and closes the pipe when it fails.
    for (char c = 0; ::read(ends[0], &c, 1) == 1 && c != '\n';) number.push_back(c);
    ::close(ends[0]);
    REQUIRE_FALSE(number.empty());
    name_ = ":" + number;
  }

  /// Returns DISPLAY=..., the setting for a driver without a GPU, and user folders inside the
  /// folder of this display.
  std::vector<std::string> environment() const {
    return {"DISPLAY=" + name_, "LIBGL_ALWAYS_SOFTWARE=1", "XDG_CONFIG_HOME=" + folder_ + "/config",
            "XDG_DATA_HOME=" + folder_ + "/data", "XDG_STATE_HOME=" + folder_ + "/state"};
  }

  /// Runs xdotool. Returns true if it succeeded.
  bool hand(std::vector<std::string> words) {
    words.insert(words.begin(), xdotool_);
    ChildProcess process(std::move(words), folder_ + "/xdotool.log", environment());
    return process.wait(std::chrono::seconds(20)) == 0;
  }

  /// Ends the X server, even if programs have windows on it.
  void end() { server_.reset(); }

  /// Returns the pixels [x, x + width) x [y, y + height). During a draw they may be partly old and
  /// partly new. Requires that they are on the display.
  Grab grab(int x, int y, int width, int height) const {
    std::ifstream file(folder_ + "/Xvfb_screen0", std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    constexpr std::size_t kHeaderBytes = 100;
    REQUIRE(bytes.size() >= kHeaderBytes);  // Xvfb maps the whole file before it writes its number
    // XWD: big-endian words; header size, ..., 12: bytes per line, ..., 19: colours, each of 12
    // bytes.
    const auto word = [&bytes](std::size_t i) {
      std::size_t value = 0;
      for (std::size_t b = 0; b < 4; ++b)
        value = value << 8 | static_cast<std::uint8_t>(bytes[i * 4 + b]);
      return value;
    };
    const std::size_t start = word(0) + word(19) * 12;
    const auto offset = [&](int column, int row) {
      return start + word(12) * static_cast<std::size_t>(row) +
             static_cast<std::size_t>(column) * 4;
    };
    REQUIRE(bytes.size() >= offset(x + width, y + height - 1));
    Grab out{width, height, {}};
    for (int row = y; row < y + height; ++row) {
      for (int column = x; column < x + width; ++column) {
        const std::size_t at = offset(column, row);
        const auto colour = [&](std::size_t c) {
          return int{static_cast<std::uint8_t>(bytes[at + c])};
        };
        out.pixels.push_back({colour(2), colour(1), colour(0)});
      }
    }
    return out;
  }

 private:
  const std::string folder_, xdotool_;
  std::string name_;
  std::optional<ChildProcess> server_;
};

}  // namespace runstone::test
