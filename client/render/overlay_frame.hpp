// OverlayFrame: the user interface as it is drawn over a frame: triangles in pixels, with clip
// rectangles, an atlas of glyphs and images. It has no types of the library that makes it, so that
// the draw thread needs only OpenGL. A frame is never changed after it was made, and any thread may
// read it.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace runstone {

/// A corner of a triangle. x and y are pixels from the upper left corner of the frame. u and v are
/// places in the atlas or image, 0 to 1. The colour is sRGB; red is the lowest byte, alpha the
/// highest.
struct OverlayVertex {
  float x = 0, y = 0;
  float u = 0, v = 0;
  std::uint32_t colour = 0;
  friend bool operator==(const OverlayVertex&, const OverlayVertex&) = default;
};
static_assert(sizeof(OverlayVertex) == 20);

/// Triangles that are clipped by the same rectangle and have the same texture. Commands are drawn
/// in their order.
struct OverlayCommand {
  std::array<float, 4> clip{};     // left, top, right, bottom in pixels
  std::uint32_t first_index = 0;   // in OverlayFrame::indices
  std::uint32_t index_count = 0;   // a multiple of 3
  std::uint32_t first_vertex = 0;  // is added to each index
  std::uint32_t image = 0;         // 0: the atlas; otherwise the number in OverlayFrame::images + 1
  friend bool operator==(const OverlayCommand&, const OverlayCommand&) = default;
};

/// The coverage of each pixel of the glyphs, 0 to 255, rows from the top.
struct OverlayAtlas {
  int width = 0, height = 0;
  std::vector<std::uint8_t> coverage;  // width * height
};

/// An image in a window, such as a part of a map. It is uploaded with the first frame that has it.
/// It never changes: changed contents are a new image.
struct OverlayImage {
  int width = 0, height = 0;
  std::vector<std::uint32_t> pixels;  // width * height, in the form of OverlayVertex::colour
};

struct OverlayFrame {
  int width = 0, height = 0;  // pixels of the frame that it was made for
  std::vector<OverlayVertex> vertices;
  std::vector<std::uint16_t> indices;
  std::vector<OverlayCommand> commands;
  std::shared_ptr<const OverlayAtlas> atlas;  // not null; frames of one interface share it
  std::vector<std::shared_ptr<const OverlayImage>> images;  // not null
};

}  // namespace runstone
