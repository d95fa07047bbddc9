// Wireframe: quads of a mesh as a drawing: seen from above a corner, without perspective, outlines dark over
// pale sides, hidden lines left out. In software, so that it looks the same on every machine.
#pragma once
#include <span>

#include "client/render/image.hpp"
#include "common/mesh/quad.hpp"

namespace runstone::wireframe {

/// Where a drawing lies in an image, in pixels.
struct Panel {
  int left = 0, top = 0, width = 0, height = 0;
};

/// White.
Image blank(int width, int height);

/// Draws quads as large as the panel takes them, with outlines `line` pixels thick. Only directions +x, +y
/// and +z can be seen from there. Sides are tinted by material. Requires a panel inside the image.
void draw(std::span<const Quad> quads, const Panel& panel, int line, Image& image);

}  // namespace runstone::wireframe
