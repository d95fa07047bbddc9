// ProductPlanes: the pictures of the product's renderer, drawn from merged quads and from single
// faces. The colour of a pixel tells its plane. Thread: the one whose context is current.
#pragma once
#include "bench/frames/drawn_picture.hpp"
#include "bench/frames/frames_world.hpp"
#include "client/render/renderer.hpp"

namespace runstone::bench {

class ProductPlanes {
 public:
  ProductPlanes(GlContextLoader loader, const FramesWorld& world);

  /// Returns `expected`, the picture of PlainRenderer from the same place, with another colour in
  /// each pixel in which merged quads and single faces differ. So the difference of both pictures
  /// has the seams and pinholes of the product.
  DrawnPicture changed(const Camera& camera, const DrawnPicture& expected);

 private:
  Renderer merged_, faces_;
};

}  // namespace runstone::bench
