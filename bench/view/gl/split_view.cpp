#include "bench/view/gl/split_view.hpp"

#include <algorithm>
#include <cstddef>

#include "bench/harness/clocks.hpp"

namespace runstone::bench {
namespace {

/// Returns where pane `i` of `count` begins.
int left_of(std::size_t i, std::size_t count, int width) {
  return static_cast<int>(i) * width / static_cast<int>(count);
}

}  // namespace

SplitView::SplitView(GlContextLoader loader, const FramesWorld& world,
                     const MaterialTable& materials, std::span<const ViewPane> panes,
                     bool has_edges)
    : captions_(panes.size()), has_edges_(has_edges) {
  for (const ViewPane& pane : panes) {
    Renderer& renderer = *renderers_.emplace_back(std::make_unique<Renderer>(loader));
    renderer.set_materials(materials);
    for (std::size_t i = 0; i < pane.chunks.size(); ++i) {
      const ViewChunk& chunk = pane.chunks[i];
      renderer.upload({0, chunk.at}, static_cast<std::int32_t>(world.edge), chunk.mesh,
                      &world.chunks[i].volume.scene.chunk);
    }
  }
}

double SplitView::draw(std::size_t pane, const Camera& camera, int width, int height,
                       double time_of_day, bool is_plain) {
  Renderer& renderer = *renderers_[pane];
  FrameContents contents;
  contents.look.time_of_day = time_of_day;
  contents.inspection.modes.set(InspectionMode::wireframe, has_edges_ && !is_plain);
  const std::uint64_t start = now_ns();
  renderer.draw(camera, width, height, contents);
  renderer.finish();
  const double us = static_cast<double>(now_ns() - start) * 1e-3;
  if (is_plain || captions_[pane].title.empty()) return us;
  renderer.draw_overlay(*caption_frame(ui_, captions_[pane], {width, height}));
  return us;
}

Image SplitView::picture(const Camera& camera, int width, int height, double time_of_day) {
  const auto row = static_cast<std::size_t>(width) * 3;
  Image out{width, height, std::vector<std::uint8_t>(row * static_cast<std::size_t>(height))};
  for (std::size_t i = 0; i < size(); ++i) {
    const int left = left_of(i, size(), width), right = left_of(i + 1, size(), width);
    draw(i, camera, right - left, height, time_of_day, false);
    const Image pane = renderers_[i]->read_image();
    const auto pane_row = static_cast<std::ptrdiff_t>(pane.width) * 3;
    for (int y = 0; y < height; ++y) {
      std::copy_n(pane.rgb.begin() + y * pane_row, pane_row,
                  out.rgb.begin() + static_cast<std::ptrdiff_t>(row) * y + left * 3);
    }
  }
  return out;
}

void SplitView::present(const Camera& camera, int width, int height, double time_of_day) {
  for (std::size_t i = 0; i < size(); ++i) {
    const int left = left_of(i, size(), width), right = left_of(i + 1, size(), width);
    draw(i, camera, right - left, height, time_of_day, false);
    renderers_[i]->present(left, 0, right - left, height);
  }
}

}  // namespace runstone::bench
