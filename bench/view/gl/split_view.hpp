// SplitView: a picture in parts side by side, in each of which the client's renderer draws the
// meshes of one pane from the same camera. Thread: the one whose context is current.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bench/view/view_pane.hpp"
#include "client/render/renderer.hpp"
#include "client/ui/caption.hpp"

namespace runstone::bench {

class SplitView {
 public:
  /// Uploads the meshes. Pictures show the edges of quads if `has_edges`. Throws std::runtime_error
  /// if a shader does not compile or the GPU has no memory left.
  SplitView(GlContextLoader loader, const FramesWorld& world, const MaterialTable& materials,
            std::span<const ViewPane> panes, bool has_edges);

  std::size_t size() const { return renderers_.size(); }
  void set_caption(std::size_t pane, Caption caption) { captions_[pane] = std::move(caption); }
  /// Draws one pane and waits for it. Returns the time of the drawing, in microseconds: without the
  /// caption and the edges of quads if `is_plain`.
  double draw(std::size_t pane, const Camera& camera, int width, int height, double time_of_day,
              bool is_plain);
  /// Draws all panes with captions, and returns them in one picture of width x height pixels.
  Image picture(const Camera& camera, int width, int height, double time_of_day);
  /// Draws the same into the window's default framebuffer.
  void present(const Camera& camera, int width, int height, double time_of_day);

 private:
  std::vector<std::unique_ptr<Renderer>> renderers_;
  std::vector<Caption> captions_;  // by pane; one without a title is not drawn
  UiContext ui_;
  bool has_edges_;
};

}  // namespace runstone::bench
