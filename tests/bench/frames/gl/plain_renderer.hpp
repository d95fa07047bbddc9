// PlainRenderer: the plainest way to draw a mesh: indexed triangles of one vertex format, or packed quads, with
// one small shader, back faces culled, chunks from near to far. What it draws looks the same whoever made the mesh.
// All calls from the one thread whose context is current.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "client/render/frame_target.hpp"
#include "client/render/gl_handle.hpp"
#include "client/render/renderer.hpp"
#include "tests/bench/frames/drawn_picture.hpp"
#include "tests/bench/frames/gl/plain_scene.hpp"

namespace runstone::bench {

class PlainRenderer {
 public:
  /// Throws std::runtime_error with the driver's log if a shader does not compile, or if there can be no
  /// target of that size.
  PlainRenderer(GlContextLoader loader, int width, int height);

  /// One frame; does not wait for it.
  void draw(const PlainScene& scene, const Camera& camera);
  /// Of the last draw(). Waits for it.
  DrawnPicture read();

  /// Fragments of a frame that pass the depth test when it is their turn. Draws it; what it drew can be read.
  std::uint64_t fragments_drawn(const PlainScene& scene, const Camera& camera);
  /// Fragments of a frame without any depth test: all that front faces cover. Draws it.
  std::uint64_t fragments_covered(const PlainScene& scene, const Camera& camera);
  /// Lanes that shade those of fragments_drawn() in blocks of 2 x 2, helpers included. Draws it. None if the
  /// context is older than OpenGL 4.5.
  std::optional<double> lanes_shaded(const PlainScene& scene, const Camera& camera);

 private:
  struct Programs {
    GlProgram indexed, packed;
  };
  void draw_with(const Programs& programs, const PlainScene& scene, const Camera& camera);
  void bind(bool depth_test);

  int width_, height_;
  Programs colour_, lanes_;
  FrameTarget target_;
  GlFramebuffer lanes_framebuffer_;
  GlRenderbuffer lanes_colour_, lanes_depth_;
};

}  // namespace runstone::bench
