// Draw answers: lines that `runstone-client --draw` writes to its standard output, so that the
// sender of draw orders (draw_order.hpp) can wait for its pictures:
//   ready VERSION RENDERER                     once, when there is OpenGL
//   drawn quads=N chunks=N us=N FILE           a picture is on disk
//   unwritten TEXT                             the picture could not be written: its file and why;
//                                              the next one may succeed
//   error TEXT                                 no OpenGL, or an invalid order: the program ends
// Any other line is no answer.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace runstone {

inline constexpr std::size_t kDrawAnswerBytesMax = 8192;  // with the line feed

struct DrawReady {
  std::uint32_t version = 0;
  std::string renderer;
  friend bool operator==(const DrawReady&, const DrawReady&) = default;
};
struct PictureDrawn {
  std::uint64_t quads = 0;   // that were drawn
  std::uint64_t chunks = 0;  // that had quads in view
  std::uint64_t us = 0;      // from the order until the file was written
  std::string file;
  friend bool operator==(const PictureDrawn&, const PictureDrawn&) = default;
};
struct PictureUnwritten {
  std::string text;  // begins with the name of the file, such as "a.png: cannot be written: ..."
  friend bool operator==(const PictureUnwritten&, const PictureUnwritten&) = default;
};
struct DrawFailed {
  std::string text;
  friend bool operator==(const DrawFailed&, const DrawFailed&) = default;
};
using DrawAnswer = std::variant<DrawReady, PictureDrawn, PictureUnwritten, DrawFailed>;

/// Returns the line with its line feed. Bytes that are not printable become blanks; a line that is
/// too long is cut.
std::string to_line(const DrawAnswer& answer);
/// Parses a line without its line feed. Returns nullopt if it is no answer or has control
/// characters.
std::optional<DrawAnswer> parse_draw_answer(std::string_view line);

}  // namespace runstone
