// Wireframe: a drawing of a mesh's quads, seen from above a corner, without perspective, with dark
// outlines over pale sides and without hidden lines. It is drawn in software, so that it looks the
// same on every machine.
#pragma once
#include <span>

#include "client/render/image.hpp"
#include "common/mesh/quad.hpp"

namespace runstone::wireframe {

/// The place of a drawing in an image, in pixels.
struct Panel {
  int left = 0, top = 0, width = 0, height = 0;
};

/// Returns a white image.
Image blank(int width, int height);

/// Draws quads as large as the panel allows, with outlines `line` pixels thick. Only directions +x,
/// +y and +z are visible. Sides are tinted by material. Requires a panel inside the image.
void draw(std::span<const Quad> quads, const Panel& panel, int line, Image& image);

}  // namespace runstone::wireframe
