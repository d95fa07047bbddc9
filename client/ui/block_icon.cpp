#include "client/ui/block_icon.hpp"

#include <algorithm>
#include <array>

#include "client/ui/ui_draw.hpp"
#include "common/materials/default_look.hpp"

namespace runstone {
namespace {

/// A visible face: a parallelogram with its brightness. Places on it are u to the right and v
/// downward, 0 .. 1.
struct Face {
  ImVec2 corner, right, down;
  double shade;

  ImVec2 at(double u, double v) const {
    const auto x = static_cast<float>(u), y = static_cast<float>(v);
    return {corner.x + right.x * x + down.x * y, corner.y + right.y * x + down.y * y};
  }
};

class IconPainter {
 public:
  IconPainter(ImDrawList& list, const MaterialInfo& material)
      : list_(list), colour_(material.colour), look_(look_of(material)) {}

  void paint(const Face& face) const {
    rectangle(face, 0, 0, 1, 1, brightness(face));
    switch (look_.pattern) {
      case MaterialPattern::planks:
        for (int row = 1; row < 4; ++row) line(face, 0, row / 4.0, 1, row / 4.0);
        return;
      case MaterialPattern::bricks:
        return bricks(face);
      case MaterialPattern::tiles:
        return frame(face);
      case MaterialPattern::cobble:
        return cobble(face);
      case MaterialPattern::bark:
        for (int groove = 1; groove < 5; ++groove) line(face, groove / 5.0, 0, groove / 5.0, 1);
        return;
      case MaterialPattern::weave:
        return weave(face);
      case MaterialPattern::none:
      case MaterialPattern::blades:
      case MaterialPattern::flower:
      case MaterialPattern::foliage:
        return grain(face);
    }
  }

 private:
  /// A block that gives off light is as bright on all sides.
  double brightness(const Face& face) const {
    const double light = look_.emission / 100.0;
    return face.shade + (1.15 - face.shade) * light;
  }
  ImU32 colour(double factor) const { return shaded_colour(colour_, factor); }
  void rectangle(const Face& face, double u, double v, double u_end, double v_end,
                 double factor) const {
    list_.AddQuadFilled(face.at(u, v), face.at(u_end, v), face.at(u_end, v_end), face.at(u, v_end),
                        colour(factor));
  }
  void line(const Face& face, double u, double v, double u_end, double v_end) const {
    list_.AddLine(face.at(u, v), face.at(u_end, v_end), colour(0.68 * brightness(face)));
  }
  void bricks(const Face& face) const {
    for (int row = 0; row < 4; ++row) {
      if (row != 0) line(face, 0, row / 4.0, 1, row / 4.0);
      for (const double u : row % 2 == 0 ? std::array{0.5, 1.0} : std::array{0.25, 0.75})
        line(face, u, row / 4.0, u, (row + 1) / 4.0);
    }
  }
  void frame(const Face& face) const {
    constexpr double kIn = 0.06;
    line(face, kIn, kIn, 1 - kIn, kIn);
    line(face, 1 - kIn, kIn, 1 - kIn, 1 - kIn);
    line(face, 1 - kIn, 1 - kIn, kIn, 1 - kIn);
    line(face, kIn, 1 - kIn, kIn, kIn);
  }
  void cobble(const Face& face) const {
    struct Stone {
      double u, v, u_end, v_end, factor;
    };
    constexpr Stone kStones[] = {{0.04, 0.06, 0.5, 0.4, 1.12},  {0.56, 0.06, 0.96, 0.34, 0.9},
                                 {0.04, 0.48, 0.34, 0.94, 0.9}, {0.42, 0.46, 0.96, 0.66, 1.06},
                                 {0.42, 0.72, 0.7, 0.94, 1.14}, {0.76, 0.74, 0.96, 0.94, 0.94}};
    rectangle(face, 0, 0, 1, 1, 0.66 * brightness(face));
    for (const Stone& stone : kStones) {
      rectangle(face, stone.u, stone.v, stone.u_end, stone.v_end, stone.factor * brightness(face));
    }
  }
  void weave(const Face& face) const {
    for (int i = 0; i < 4; ++i) {
      const double u = (i % 2) * 0.5, v = i / 4.0;
      rectangle(face, u, v, u + 0.5, v + 0.25, 0.9 * brightness(face));
    }
  }
  /// Some darker and lighter spots for a material that is not even.
  void grain(const Face& face) const {
    const double strength = (look_.grain + look_.variation) / 100.0;
    if (strength < 0.2) return;
    constexpr double kSpots[][3] = {{0.1, 0.15, -1}, {0.6, 0.1, 1},    {0.35, 0.4, -0.7},
                                    {0.75, 0.5, -1}, {0.1, 0.65, 0.8}, {0.5, 0.75, -0.5}};
    for (const auto& [u, v, sign] : kSpots)
      rectangle(face, u, v, u + 0.16, v + 0.16, brightness(face) * (1 + 0.5 * strength * sign));
  }

  ImDrawList& list_;
  const MaterialColour& colour_;
  const MaterialLook look_;
};

}  // namespace

void block_icon(ImDrawList& list, ImVec2 from, ImVec2 to, const MaterialInfo& material) {
  const float side = std::min(to.x - from.x, to.y - from.y);
  const ImVec2 middle{(from.x + to.x) / 2, (from.y + to.y) / 2};
  const MaterialLook look = look_of(material);
  if (look.emission != 0) {
    const auto glow = static_cast<int>(look.emission);
    const MaterialColour& c = material.colour;
    for (const float reach : {0.68F, 0.6F, 0.54F})
      list.AddCircleFilled(middle, reach * side, IM_COL32(c[0], c[1], c[2], glow * 2 / 5));
  }
  // The block is seen from above one of its edges: half of the width is one side, and the upper
  // face is half as high as it is wide.
  const float half = side / 2, quarter = side / 4;
  const ImVec2 top{middle.x, middle.y - half}, left{middle.x - half, middle.y - quarter};
  const ImVec2 front{middle.x, middle.y};
  const IconPainter painter(list, material);
  painter.paint({left, {half, -quarter}, {half, quarter}, 1.12});
  painter.paint({left, {half, quarter}, {0, half}, 0.9});
  painter.paint({front, {half, -quarter}, {0, half}, 0.72});
  const ImVec2 right{middle.x + half, middle.y - quarter};
  const ImVec2 outline[] = {
      top, right, {right.x, right.y + half}, {front.x, front.y + half}, {left.x, left.y + half},
      left};
  list.AddPolyline(outline, static_cast<int>(std::size(outline)), IM_COL32(0, 0, 0, 120),
                   ImDrawFlags_Closed, 1);
  // A smooth material has a light edge where the sun is mirrored.
  if (look.roughness < 50)
    list.AddLine(left, front, IM_COL32(255, 255, 255, 180 - 3 * look.roughness), 1.5F);
}

}  // namespace runstone
