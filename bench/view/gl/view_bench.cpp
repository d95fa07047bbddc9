#include "bench/view/view_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <stdexcept>
#include <thread>

#include "bench/harness/statistics.hpp"
#include "bench/view/gl/split_view.hpp"
#include "bench/view/gl/view_camera.hpp"
#include "bench/view/view_world.hpp"
#include "client/platform/gl_context.hpp"
#include "client/platform/window.hpp"
#include "client/render/gl_handle.hpp"
#include "client/render/png_file.hpp"
#include "common/mesh/quad_corners.hpp"

namespace runstone::bench {
namespace {

std::string grouped(std::size_t number) {
  std::string out = std::to_string(number);
  for (auto at = static_cast<std::ptrdiff_t>(out.size()) - 3; at > 0; at -= 3)
    out.insert(static_cast<std::size_t>(at), ",");
  return out;
}

Caption caption_of(const ViewRow& row) {
  return {
      row.mesher,
      {fmt::format("{} quads", grouped(row.quads)),
       fmt::format("{} bytes on the GPU", grouped(row.gpu_bytes)),
       fmt::format("{} µs: {}", grouped(static_cast<std::size_t>(row.mesh_us + 0.5)), row.timed),
       fmt::format("{} µs to draw", grouped(static_cast<std::size_t>(row.draw_us + 0.5)))}};
}

std::string gl_renderer() {
  const GLubyte* const text = glGetString(GL_RENDERER);
  return text == nullptr ? "unknown" : reinterpret_cast<const char*>(text);
}

/// Returns a camera that sees all quads of a pane.
ViewCamera camera_of(const ViewPane& pane, int edge, const ViewOptions& options) {
  constexpr int kFar = std::numeric_limits<int>::max();
  std::array<int, 3> low = {kFar, kFar, kFar}, high = {-kFar, -kFar, -kFar};
  for (const ViewChunk& chunk : pane.chunks) {
    const std::array<int, 3> origin = {chunk.at.x * edge, chunk.at.y * edge, chunk.at.z * edge};
    for (const QuadLayers* layers : {&chunk.mesh.opaque, &chunk.mesh.transparent}) {
      for (const Quad quad : layers->quads) {
        for (const Corner& corner : quad_corners(quad)) {
          for (std::size_t i = 0; i < 3; ++i) {
            low[i] = std::min(low[i], origin[i] + static_cast<int>(corner[i]));
            high[i] = std::max(high[i], origin[i] + static_cast<int>(corner[i]));
          }
        }
      }
    }
  }
  if (pane.quads == 0) return {{0, 0, 0}, {edge, edge, edge}, options.turn, options.pitch};
  return {low, high, options.turn, options.pitch};
}

class ViewProgram {
 public:
  ViewProgram(const ViewOptions& options, const FramesWorld& world, GlContextLoader loader)
      : options_(options),
        panes_(view_panes(world, options.repetitions, options.mesher)),
        view_(loader, world, materials_of(world), panes_, options.edges),
        camera_(camera_of(panes_.front(), static_cast<int>(world.edge), options)) {
    result_.world = world.name;
    result_.chunks = world.chunks.size();
    result_.renderer = gl_renderer();
    for (const ViewPane& pane : panes_)
      result_.rows.push_back(
          {pane.name, pane.timed, pane.quads, pane.gpu_bytes(), pane.mesh_us, 0});
    time_frames();
    for (std::size_t i = 0; options.captions && i < panes_.size(); ++i)
      view_.set_caption(i, caption_of(result_.rows[i]));
  }

  /// Fails as write_png().
  Result<void, std::string> write(const std::string& file) {
    return write_png(file, view_.picture(camera_.camera(), options_.width, options_.height,
                                         options_.time_of_day));
  }

  void show(Window& window, GlContext& context) {
    constexpr std::chrono::milliseconds kPause{10};
    std::array<int, 2> drawn{};
    for (WindowEvents events = window.poll(); !events.close; events = window.poll()) {
      const std::array<int, 2> size = window.framebuffer_size();
      if (!camera_.feed(events.events) && size == drawn) {
        std::this_thread::sleep_for(kPause);
        continue;
      }
      view_.present(camera_.camera(), size[0], size[1], options_.time_of_day);
      context.swap();
      drawn = size;
    }
  }

  ViewResult take_result() { return std::move(result_); }

 private:
  /// Times the panes in turns, after a frame that compiles shaders and draws shadows.
  void time_frames() {
    const int width = options_.width / static_cast<int>(panes_.size());
    std::vector<std::vector<double>> us(panes_.size());
    for (unsigned frame = 0; frame <= options_.frames; ++frame) {
      for (std::size_t i = 0; i < panes_.size(); ++i) {
        const double took =
            view_.draw(i, camera_.camera(), width, options_.height, options_.time_of_day, true);
        if (frame != 0) us[i].push_back(took);
      }
    }
    for (std::size_t i = 0; i < panes_.size(); ++i) result_.rows[i].draw_us = median(us[i]);
  }

  const ViewOptions& options_;
  ViewResult result_;
  std::vector<ViewPane> panes_;
  SplitView view_;
  ViewCamera camera_;
};

}  // namespace

Result<ViewResult, std::string> run_view(const ViewOptions& options) {
  const auto world = view_world(options.world, options.luanti);
  if (!world) return failure(world.error());
  try {
    if (!options.out.empty()) {
      const auto context = make_headless_context();
      ViewProgram program(options, *world, context->loader());
      if (const auto written = program.write(options.out); !written)
        return failure(written.error());
      return program.take_result();
    }
    Window window(options.width, options.height, "Runstone  " + options.world);
    const auto context = make_window_context(window);
    ViewProgram program(options, *world, context->loader());
    program.show(window, *context);
    return program.take_result();
  } catch (const std::runtime_error& error) {  // the platform and the renderer throw
    return failure(error.what());
  }
}

}  // namespace runstone::bench
