// PlainRenderer: a minimal renderer. It draws indexed triangles of one vertex format, or packed
// quads, with one small shader. It culls back faces and draws near chunks first. The picture does
// not depend on the mesher. Thread: the one whose context is current.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "bench/frames/drawn_picture.hpp"
#include "bench/frames/gl/plain_scene.hpp"
#include "client/render/frame_target.hpp"
#include "client/render/gl_handle.hpp"
#include "client/render/renderer.hpp"

namespace runstone::bench {

class PlainRenderer {
 public:
  /// Throws std::runtime_error with the driver's log if a shader does not compile, or if no target
  /// of that size can be made.
  PlainRenderer(GlContextLoader loader, int width, int height);

  /// Draws one frame and does not wait for it.
  void draw(const PlainScene& scene, const Camera& camera);
  /// Returns the picture of the last draw(). Waits for it.
  DrawnPicture read();

  /// Draws a frame and returns the fragments that pass the depth test when they are drawn. read()
  /// then returns the picture.
  std::uint64_t fragments_drawn(const PlainScene& scene, const Camera& camera);
  /// Draws a frame without depth test and returns its fragments: all that front faces cover.
  std::uint64_t fragments_covered(const PlainScene& scene, const Camera& camera);
  /// Draws a frame and returns the lanes that shade the fragments of fragments_drawn() in blocks of
  /// 2 x 2, helper lanes included. Returns nullopt if the context is older than OpenGL 4.5.
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
