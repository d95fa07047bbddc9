// Draw answers: what `runstone-client --draw` writes to its standard output, a line each, so that whoever
// orders pictures (draw_order.hpp) can wait for them:
//   ready VERSION RENDERER                     once, when there is OpenGL
//   drawn quads=N chunks=N us=N FILE           a picture is on the disk
//   unwritten FILE                             the picture could not be written; the next one may succeed
//   error TEXT                                 no OpenGL (any more), or a wrong order: the program ends
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
  std::uint64_t quads = 0;   // drawn
  std::uint64_t chunks = 0;  // that had some in view
  std::uint64_t us = 0;      // from the order until the file was written
  std::string file;
  friend bool operator==(const PictureDrawn&, const PictureDrawn&) = default;
};
struct PictureUnwritten {
  std::string file;
  friend bool operator==(const PictureUnwritten&, const PictureUnwritten&) = default;
};
struct DrawFailed {
  std::string text;
  friend bool operator==(const DrawFailed&, const DrawFailed&) = default;
};
using DrawAnswer = std::variant<DrawReady, PictureDrawn, PictureUnwritten, DrawFailed>;

/// The line with its line feed. What would break the line becomes blanks; what is too long is cut.
std::string to_line(const DrawAnswer& answer);
/// `line` without its line feed. Nothing if it is no answer, or has control characters.
std::optional<DrawAnswer> parse_draw_answer(std::string_view line);

}  // namespace runstone
