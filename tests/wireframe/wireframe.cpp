#include "tests/wireframe/wireframe.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "common/core/assert.hpp"
#include "common/mesh/quad_corners.hpp"

namespace runstone::wireframe {
namespace {

/// A point of the drawing, y downwards, with its depth in voxels.
struct Point {
  float x = 0, y = 0, near = 0;
};

using Colour = std::array<std::uint8_t, 3>;
constexpr Colour kLine = {40, 44, 52};
constexpr std::array<Colour, 4> kTints = {
    {{196, 200, 206}, {214, 190, 160}, {176, 210, 150}, {226, 214, 164}}};  // by material

/// Projects a corner: x goes right and down, z left and down, y up, with all three axes equally
/// long.
Point seen(const Corner& corner) {
  const auto x = static_cast<float>(corner[0]), y = static_cast<float>(corner[1]),
             z = static_cast<float>(corner[2]);
  return {(x - z) * std::numbers::sqrt3_v<float> / 2, (x + z) / 2 - y, x + y + z};
}

/// A quad that is visible if nothing lies before it.
struct Side {
  QuadFields fields;
  std::array<Point, 4> corners;
};

/// Returns the visible quads in pixels of the panel, as large as fits, in its middle.
std::vector<Side> sides_of(std::span<const Quad> quads, const Panel& panel) {
  std::vector<Side> out;
  constexpr float kFar = std::numeric_limits<float>::max();
  Point low = {kFar, kFar}, high = {-kFar, -kFar};
  for (const Quad quad : quads) {
    Side side{unpack(quad), {}};
    if (!is_positive(side.fields.direction)) continue;
    const std::array<Corner, 4> corners = quad_corners(quad);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Point p = side.corners[i] = seen(corners[i]);
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    out.push_back(side);
  }
  const auto width = static_cast<float>(panel.width), height = static_cast<float>(panel.height);
  const float scale = std::min(width / (high.x - low.x), height / (high.y - low.y));
  for (Side& side : out) {
    for (Point& p : side.corners) {
      p.x = (p.x - (low.x + high.x) / 2) * scale + width / 2;
      p.y = (p.y - (low.y + high.y) / 2) * scale + height / 2;
    }
  }
  return out;
}

class Drawing {
 public:
  Drawing(const Panel& panel, Image& image)
      : panel_(panel),
        image_(image),
        nearest_(static_cast<std::size_t>(panel.width) * static_cast<std::size_t>(panel.height),
                 -std::numeric_limits<float>::infinity()) {}

  /// Fills a parallelogram, given by three consecutive corners.
  void fill(const Point& corner, const Point& next, const Point& across, const Colour& colour) {
    const Point u = {next.x - corner.x, next.y - corner.y, next.near - corner.near};
    const Point v = {across.x - next.x, across.y - next.y, across.near - next.near};
    const float area = u.x * v.y - u.y * v.x;
    const auto [left, right] = std::minmax({corner.x, next.x, across.x, corner.x + v.x});
    const auto [top, bottom] = std::minmax({corner.y, next.y, across.y, corner.y + v.y});
    for (int y = std::max(0, static_cast<int>(top));
         y <= static_cast<int>(bottom) && y < panel_.height; ++y) {
      for (int x = std::max(0, static_cast<int>(left));
           x <= static_cast<int>(right) && x < panel_.width; ++x) {
        const float dx = static_cast<float>(x) + 0.5F - corner.x,
                    dy = static_cast<float>(y) + 0.5F - corner.y;
        const float a = (dx * v.y - dy * v.x) / area, b = (u.x * dy - u.y * dx) / area;
        if (a < 0 || a > 1 || b < 0 || b > 1) continue;
        const float near = corner.near + a * u.near + b * v.near;
        if (near <= nearest(x, y)) continue;
        nearest(x, y) = near;
        paint(x, y, colour);
      }
    }
  }

  /// Draws a line where nothing lies before it.
  void line(const Point& from, const Point& to, int thickness) {
    const float dx = to.x - from.x, dy = to.y - from.y;
    const int steps = 1 + static_cast<int>(2 * std::max(std::abs(dx), std::abs(dy)));
    for (int i = 0; i <= steps; ++i) {
      const float at = static_cast<float>(i) / static_cast<float>(steps);
      const int x = static_cast<int>(from.x + at * dx) - thickness / 2;
      const int y = static_cast<int>(from.y + at * dy) - thickness / 2;
      const float near = from.near + at * (to.near - from.near) + kBefore;
      for (int py = std::max(0, y); py < std::min(panel_.height, y + thickness); ++py) {
        for (int px = std::max(0, x); px < std::min(panel_.width, x + thickness); ++px) {
          if (near > nearest(px, py)) paint(px, py, kLine);
        }
      }
    }
  }

 private:
  // The voxels by which a line lies before the sides that it bounds.
  static constexpr float kBefore = 0.25F;

  float& nearest(int x, int y) {
    return nearest_[static_cast<std::size_t>(y) * static_cast<std::size_t>(panel_.width) +
                    static_cast<std::size_t>(x)];
  }
  void paint(int x, int y, const Colour& colour) {
    const auto pixel =
        static_cast<std::size_t>(panel_.top + y) * static_cast<std::size_t>(image_.width) +
        static_cast<std::size_t>(panel_.left + x);
    std::copy(colour.begin(), colour.end(),
              image_.rgb.begin() + static_cast<std::ptrdiff_t>(pixel * colour.size()));
  }

  const Panel panel_;
  Image& image_;
  std::vector<float> nearest_;
};

Colour colour_of(const QuadFields& quad) {
  Colour out = kTints[(quad.material + kTints.size() - 1) % kTints.size()];
  const int percent = quad.direction == Direction::pos_y   ? 112
                      : quad.direction == Direction::pos_x ? 96
                                                           : 82;
  for (std::uint8_t& channel : out)
    channel = static_cast<std::uint8_t>(std::min(255, channel * percent / 100));
  return out;
}

}  // namespace

Image blank(int width, int height) {
  return {width, height,
          std::vector<std::uint8_t>(
              static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3, 255)};
}

void draw(std::span<const Quad> quads, const Panel& panel, int line, Image& image) {
  RUNSTONE_ASSERT(panel.left >= 0 && panel.left + panel.width <= image.width);
  RUNSTONE_ASSERT(panel.top >= 0 && panel.top + panel.height <= image.height);
  const std::vector<Side> sides = sides_of(quads, panel);
  Drawing drawing(panel, image);
  for (const Side& side : sides) {
    drawing.fill(side.corners[0], side.corners[1], side.corners[2], colour_of(side.fields));
  }
  for (const Side& side : sides) {
    for (std::size_t i = 0; i < 4; ++i)
      drawing.line(side.corners[i], side.corners[(i + 1) % 4], line);
  }
}

}  // namespace runstone::wireframe
