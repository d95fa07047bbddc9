#include "client/render/renderer.hpp"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <optional>
#include <stdexcept>
#include <vector>

#include "client/render/antialiasing.hpp"
#include "client/render/body_painter.hpp"
#include "client/render/eye_medium.hpp"
#include "client/render/frame_target.hpp"
#include "client/render/fxaa_painter.hpp"
#include "client/render/gl_handle.hpp"
#include "client/render/glow_painter.hpp"
#include "client/render/marker_painter.hpp"
#include "client/render/multisample_target.hpp"
#include "client/render/noise_texture.hpp"
#include "client/render/overlay_painter.hpp"
#include "client/render/sky_painter.hpp"
#include "client/render/terrain.hpp"

namespace runstone {
namespace {

/// The far plane lies beyond the distance at which fog hides everything, as a factor of it.
constexpr double kFarPlane = 1.1;

/// Returns the map from eye-relative coordinates to clip space.
glm::mat4 clip_of(const Camera& camera, const DepthRange& depth, int width, int height) {
  const glm::vec3 forward{static_cast<float>(std::sin(camera.yaw) * std::cos(camera.pitch)),
                          static_cast<float>(std::sin(camera.pitch)),
                          static_cast<float>(std::cos(camera.yaw) * std::cos(camera.pitch))};
  // The up vector must not be parallel to the view, which may point straight up or down.
  const glm::vec3 up = std::abs(forward.y) > 0.999F
                           ? glm::vec3{static_cast<float>(std::sin(camera.yaw)), 0,
                                       static_cast<float>(std::cos(camera.yaw))}
                           : glm::vec3{0, 1, 0};
  const glm::mat4 view = glm::lookAt(glm::vec3{0}, forward, up);
  return depth.projection(camera.fov_y, static_cast<double>(width) / height) * view;
}

AntialiasingMeans antialiasing_means() {
  const auto* const name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  return {name != nullptr && is_software_renderer(name), samples_max()};
}

/// Loads the functions of OpenGL before the members of Renderer::State use them.
struct LoadedGl {
  explicit LoadedGl(GlContextLoader loader) { load_gl(loader); }
};

}  // namespace

struct Renderer::State {
  explicit State(GlContextLoader loader) : gl(loader) {}

  LoadedGl gl;
  /// Returns the antialiasing of a frame, and prepares the target with samples for it.
  Antialiasing prepare_edges(const FrameLook& look, int width, int height);
  /// Binds the framebuffer that the world is drawn into.
  void bind_world() const { has_samples ? samples.bind() : target.bind_all(); }
  /// Mixes, smooths and stretches what was drawn, and sets `finished`.
  void finish_picture(Antialiasing edges, int width, int height);

  FrameTarget target;         // of the world
  MultisampleTarget samples;  // of the world, before it is mixed into `target`, if has_samples
  bool has_samples = false;
  FrameTarget smoothed;   // `target` after FXAA
  FrameTarget stretched;  // of the world, in the size of the frame, if `target` has another one
  const FrameTarget* finished = &target;  // the one of them that has the finished frame
  AntialiasingMeans means = antialiasing_means();
  std::optional<FxaaPainter> fxaa;  // made when a frame needs it
  NoiseTexture noise;
  GlowPainter glow_painter;
  std::vector<GlowInView> glows;  // of the present frame
  SkyPainter sky;
  Terrain terrain;
  BodyPainter bodies;
  MarkerPainter markers;
  MaterialTable materials;
  OverlayPainter overlay;
};

Antialiasing Renderer::State::prepare_edges(const FrameLook& look, int width, int height) {
  Antialiasing out = usable(look.antialiasing, look.quality, means);
  has_samples = out == Antialiasing::msaa &&
                samples.prepare(width, height, std::min(kSamplesWanted, means.samples_max));
  if (out == Antialiasing::msaa && !has_samples) {
    means.samples_max = 0;  // the driver has more than it can give
    out = usable(look.antialiasing, look.quality, means);
  }
  return out;
}

void Renderer::State::finish_picture(Antialiasing edges, int width, int height) {
  if (has_samples) samples.copy_colour(target);
  finished = &target;
  if (edges == Antialiasing::fxaa) {
    if (!fxaa) fxaa.emplace();
    smoothed.bind(target.width(), target.height());
    fxaa->draw(target);
    finished = &smoothed;
  }
  if (target.width() == width && target.height() == height) return;
  const FrameTarget& from = *finished;
  stretched.bind(width, height);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, from.framebuffer());
  glBlitFramebuffer(0, 0, from.width(), from.height(), 0, 0, width, height, GL_COLOR_BUFFER_BIT,
                    GL_LINEAR);
  finished = &stretched;
}

Renderer::Renderer(GlContextLoader loader) : state_(std::make_unique<State>(loader)) {}
Renderer::~Renderer() = default;

void Renderer::set_materials(const MaterialTable& materials, ShapeTablePtr shapes) {
  state_->materials = materials;
  state_->terrain.set_materials(materials, std::move(shapes));
}

void Renderer::set_textures(const DrawnTexturesPtr& textures) {
  state_->terrain.set_textures(textures);
}

void Renderer::upload(const ChunkKey& key, std::int32_t edge, const ChunkMesh& mesh,
                      const RunChunk* voxels) {
  state_->terrain.upload(key, edge, mesh, voxels);
}

void Renderer::upload_tile(const ChunkKey& key, std::int32_t edge, const TileMesh& mesh) {
  state_->terrain.upload_tile(key, edge, mesh);
}

void Renderer::remove(const ChunkKey& key) { state_->terrain.remove(key); }

RenderStats Renderer::draw(const Camera& camera, int width, int height,
                           const FrameContents& contents) {
  State& s = *state_;
  const auto scaled = [&contents](int side) {
    return std::max(1, static_cast<int>(std::lround(side * contents.look.scale)));
  };
  const double far = camera.far * kFarPlane;
  FrameView view{.far = far, .depth = {camera.near, far}};
  view.shadow_far = camera.shadow_far > 0 ? camera.shadow_far : far;
  view.eye = {camera.x, camera.y, camera.z};
  view.clip = clip_of(camera, view.depth, width, height);
  view.pixel = 2 * std::tan(camera.fov_y / 2) / scaled(height);
  view.light = day_light(contents.look.time_of_day, camera.far, camera.shadow_far > 0);
  view.look = contents.look;

  glDepthMask(GL_TRUE);
  DepthRange::reset();
  s.terrain.update_light(view);
  view.depth.use();
  if (contents.at_eye != kEmpty && s.materials.knows(contents.at_eye)) {
    view.light =
        light_inside(s.materials[contents.at_eye], view.light, s.terrain.light_at(view, view.eye));
  }
  view.light.eye_height = static_cast<float>(camera.y);
  const int world_width = scaled(width), world_height = scaled(height);
  const Antialiasing edges = s.prepare_edges(contents.look, world_width, world_height);
  s.target.bind(world_width, world_height);
  s.bind_world();
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glDisable(GL_CULL_FACE);
  const TerrainStats drawn = s.terrain.draw_opaque(view, s.noise);
  s.bodies.draw(contents.bodies, view.eye, view.clip, view.light,
                [&](const glm::dvec3& at) { return s.terrain.light_at(view, at); });
  const bool is_low = view.look.quality == Quality::low;
  s.sky.draw({view.clip, view.eye, view.pixel, view.look.seconds, !is_low}, view.depth, view.light,
             s.noise);
  s.glows.clear();
  if (!is_low) {
    s.terrain.glows().find(view.eye, view.light.fog_end, GlowPainter::kGlowsMax, s.glows);
    if (s.terrain.has_transparent() || !s.glows.empty())
      s.has_samples ? s.samples.copy_depth(s.target) : s.target.bind_colour();
  }
  s.terrain.draw_transparent(view, s.target.depth());
  s.glow_painter.draw(s.glows, view.clip, view.depth, view.light, s.target.depth());
  s.bind_world();
  s.terrain.draw_inspection(view, contents.inspection);
  s.terrain.draw_ghosts(view, contents.ghosts);
  s.markers.draw(contents.markers, view.eye, view.clip);
  DepthRange::reset();
  s.finish_picture(edges, width, height);
  RenderStats out;
  out.chunks_drawn = drawn.chunks_drawn;
  out.chunks_culled = drawn.chunks_culled;
  out.quads_drawn = drawn.quads_drawn;
  out.quad_bytes = s.terrain.quad_bytes();
  out.gpu_bytes = s.terrain.gpu_bytes();
  out.is_animated = s.terrain.has_transparent() || !contents.ghosts.empty();
  out.lacks_msaa = contents.look.antialiasing == Antialiasing::msaa && edges != Antialiasing::msaa;
  out.tile_parts_drawn = drawn.tile_parts_drawn;
  out.texture_bytes = s.terrain.texture_bytes();
  out.textures_left_out = static_cast<std::uint32_t>(s.terrain.textures_left_out());
  return out;
}

void Renderer::draw_overlay(const OverlayFrame& overlay) {
  const FrameTarget& target = *state_->finished;
  target.bind_all();
  glViewport(0, 0, target.width(), target.height());
  state_->overlay.draw(overlay, target.width(), target.height());
}

void Renderer::finish() {
  const GLsync fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  // The wait is bounded, so that a driver that hangs does not block the client for ever.
  constexpr GLuint64 kNanosecondsMax = 30'000'000'000;
  const GLenum waited = glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, kNanosecondsMax);
  glDeleteSync(fence);
  if (waited == GL_TIMEOUT_EXPIRED)
    throw std::runtime_error("the OpenGL driver did not finish a frame in 30 s");
  if (waited == GL_WAIT_FAILED) throw std::runtime_error("the OpenGL context is lost");
  if (glGetError() == GL_OUT_OF_MEMORY) throw std::runtime_error("the GPU has no memory left");
}

Image Renderer::read_image() {
  const FrameTarget& target = *state_->finished;
  if (target.width() == 0) throw std::runtime_error("read_image before the first draw");
  Image image{target.width(), target.height(), {}};
  // OpenGL ES reads pixels with alpha only.
  const std::size_t row = static_cast<std::size_t>(image.width) * 4;
  std::vector<std::uint8_t> bottom_up(row * static_cast<std::size_t>(image.height));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, target.framebuffer());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, image.width, image.height, GL_RGBA, GL_UNSIGNED_BYTE, bottom_up.data());
  image.rgb.reserve(bottom_up.size() / 4 * 3);
  for (std::size_t y = static_cast<std::size_t>(image.height); y-- > 0;) {
    for (std::size_t at = y * row; at < (y + 1) * row; at += 4)
      image.rgb.insert(image.rgb.end(), {bottom_up[at], bottom_up[at + 1], bottom_up[at + 2]});
  }
  return image;
}

void Renderer::present(int left, int bottom, int width, int height) {
  const FrameTarget& target = *state_->finished;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, target.framebuffer());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glBlitFramebuffer(0, 0, target.width(), target.height(), left, bottom, left + width,
                    bottom + height, GL_COLOR_BUFFER_BIT, GL_LINEAR);
}

}  // namespace runstone
