// How the textures of a world are drawn. The cases draw off screen. If there is no OpenGL context,
// they say so with WARN and pass.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "client/platform/egl_context.hpp"
#include "client/platform/osmesa_context.hpp"
#include "client/render/renderer.hpp"
#include "common/mesh/quad.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/mesh/visibility.hpp"
#include "common/shapes/shape_faces.hpp"

namespace runstone {
namespace {

constexpr int kViewEdge = 200;  // pixels of a frame
constexpr std::int32_t kTexturedEdge = 16;
constexpr double kViewAngle = 0.1;  // radians: lines that are parallel look parallel

using Rgba = std::array<std::uint8_t, 4>;
constexpr Rgba kRedPixel{230, 20, 20, 255}, kGreenPixel{20, 200, 20, 255},
    kBluePixel{20, 20, 230, 255}, kYellowPixel{220, 220, 20, 255}, kCyanPixel{20, 220, 220, 255},
    kMagentaPixel{220, 20, 220, 255}, kHole{0, 0, 0, 0};
constexpr std::array<Rgba, 6> kSideColours = {kRedPixel,    kGreenPixel, kBluePixel,
                                              kYellowPixel, kCyanPixel,  kMagentaPixel};

/// Returns a picture with the colour that the function gives at right and down, 0 .. 1.
TexturePicture painted(std::uint16_t edge, const std::function<Rgba(double, double)>& colour) {
  TexturePicture out{edge, {}};
  for (unsigned y = 0; y < edge; ++y) {
    for (unsigned x = 0; x < edge; ++x) {
      const Rgba rgba = colour((x + 0.5) / edge, (y + 0.5) / edge);
      out.rgba.insert(out.rgba.end(), rgba.begin(), rgba.end());
    }
  }
  return out;
}

TexturePicture plain(std::uint16_t edge, const Rgba& rgba) {
  return painted(edge, [&rgba](double, double) { return rgba; });
}

/// A picture of four quarters, from left to right and from above, and a square in its middle.
TexturePicture quarters(std::uint16_t edge, const std::array<Rgba, 4>& colours,
                        const Rgba& middle) {
  return painted(edge, [&](double right, double down) {
    if (std::abs(right - 0.5) < 0.125 && std::abs(down - 0.5) < 0.125) return middle;
    return colours[(down < 0.5 ? 0U : 2U) + (right < 0.5 ? 0U : 1U)];
  });
}
constexpr std::array<Rgba, 4> kQuarters = {kRedPixel, kGreenPixel, kBluePixel, kYellowPixel};

class Textures {
 public:
  void add(const TexturePicture& picture, Material material, std::uint8_t sides) {
    TextureEntry entry;
    entry.hash[0] = static_cast<std::uint8_t>(drawn_->pictures.size());
    entry.hash[1] = static_cast<std::uint8_t>(drawn_->pictures.size() >> 8);
    entry.uses = {{material, sides}};
    REQUIRE(table_.add(entry).has_value());
    drawn_->pictures.push_back(std::make_shared<const TextureLevels>(texture_levels(picture)));
  }
  DrawnTexturesPtr take() {
    drawn_->table = std::make_shared<const TextureTable>(table_);
    return drawn_;
  }

 private:
  TextureTable table_;
  std::shared_ptr<DrawnTextures> drawn_ = std::make_shared<DrawnTextures>();
};

MaterialInfo material_row(const std::string& name, const Shape& shape = {}) {
  MaterialInfo row{name, {120, 120, 120, 255}, Visibility::opaque, {}};
  row.look = MaterialLook{60, 60, 100, 0, MaterialPattern::bricks};
  row.shape = shape;
  return row;
}

MaterialTable materials_of(std::vector<MaterialInfo> rows) {
  MaterialTable out;
  for (MaterialInfo& row : rows) REQUIRE(out.add(std::move(row)).has_value());
  return out;
}

/// Returns the mesh of voxels.
ChunkMesh mesh_of(const MaterialTable& materials,
                  const std::vector<std::pair<LocalPos, Material>>& voxels) {
  RunChunk chunk = uniform_chunk(Extent::cube(kTexturedEdge), kEmpty);
  for (const auto& [at, material] : voxels)
    fill(chunk, index_of(at, chunk.extent, chunk.order), 1, material);
  RdmScratch scratch;
  ChunkMesh out;
  mesh_rdm(chunk, {}, VisibilityTable(visibilities(materials)), scratch, out);
  return out;
}

/// Returns every face of a shape in the voxel (8, 8, 8).
std::vector<Quad> quads_of_shape(const MaterialTable& materials, Material material) {
  std::vector<Quad> out;
  const ShapeFaces faces(materials[material].shape);
  for (std::size_t i = 0; i < faces.faces().size(); ++i) {
    QuadFields quad{8, 8, 8, 1, 1, faces.faces()[i].direction, material};
    quad.face = static_cast<std::uint16_t>(i + 1);
    out.push_back(pack(quad));
  }
  return out;
}

/// A camera far before the middle of the voxel (8, 8, 8) that sees `width` voxels there.
struct Look {
  double yaw = 0, pitch = 0, width = 2;
  Camera camera() const {
    Camera out;
    out.yaw = yaw;
    out.pitch = pitch;
    out.fov_y = kViewAngle;
    const double distance = width / 2 / std::tan(kViewAngle / 2);
    const double flat = std::cos(pitch);
    out.x = 8.5 - distance * std::sin(yaw) * flat;
    out.y = 8.5 - distance * std::sin(pitch);
    out.z = 8.5 - distance * std::cos(yaw) * flat;
    return out;
  }
};
/// Returns the view of the side that faces this direction, from before it.
Look before(Direction side, double width = 2) {
  switch (side) {
    case Direction::neg_x:
      return {M_PI / 2, 0, width};
    case Direction::pos_x:
      return {-M_PI / 2, 0, width};
    case Direction::neg_y:
      return {0, M_PI / 2, width};
    case Direction::pos_y:
      return {M_PI, -M_PI / 2, width};
    case Direction::neg_z:
      return {0, 0, width};
    case Direction::pos_z:
      break;
  }
  return {M_PI, 0, width};
}

class TexturedScene {
 public:
  TexturedScene(GlContext& context, const MaterialTable& materials, const ChunkMesh& mesh)
      : renderer_(context.loader()) {
    renderer_.set_materials(materials);
    renderer_.upload({0, {0, 0, 0}}, kTexturedEdge, mesh);
    contents_.look.quality = Quality::low;
  }
  Renderer& renderer() { return renderer_; }
  void set_quality(Quality quality) { contents_.look.quality = quality; }
  const RenderStats& stats() const { return stats_; }
  Image draw(const Camera& camera) {
    stats_ = renderer_.draw(camera, kViewEdge, kViewEdge, contents_);
    renderer_.finish();
    return renderer_.read_image();
  }

 private:
  Renderer renderer_;
  FrameContents contents_;
  RenderStats stats_;
};

/// Returns the pixel at a place, in voxels to the right of the middle of the image and above it.
Rgba pixel_at(const Image& image, const Look& look, double right, double up) {
  const auto place = [&look](double voxels) {
    return static_cast<std::size_t>(std::lround(kViewEdge * (0.5 + voxels / look.width)));
  };
  const std::size_t at = (place(-up) * kViewEdge + place(right)) * 3;
  return {image.rgb[at], image.rgb[at + 1], image.rgb[at + 2], 255};
}

/// Returns the colour of kSideColours that a pixel shows in some light, or kHole for none.
Rgba named(const Rgba& pixel) {
  const int most = std::max({pixel[0], pixel[1], pixel[2]});
  for (const Rgba& colour : kSideColours) {
    bool is_it = most > 40;
    for (std::size_t c = 0; c < 3; ++c)
      is_it = is_it && (colour[c] > 128) == (pixel[c] > 0.62 * most);
    if (is_it) return colour;
  }
  return kHole;
}

/// Checks that an image shows the four quarters in one voxel, whose middle is at this place. A hole
/// shows what lies behind, which is the same at the left edge of the image.
void check_quarters(const Image& image, const Look& look, const std::array<Rgba, 4>& colours,
                    double right = 0, double up = 0) {
  for (std::size_t i = 0; i < 4; ++i) {
    CAPTURE(i, right, up);
    const double x = right + (i % 2 == 0 ? -0.3 : 0.3), y = up + (i < 2 ? 0.3 : -0.3);
    const Rgba shown = pixel_at(image, look, x, y);
    if (colours[i] != kHole) {
      CHECK(named(shown) == colours[i]);
      continue;
    }
    const Rgba behind = pixel_at(image, look, -0.48 * look.width, y);
    for (std::size_t c = 0; c < 3; ++c) CHECK(std::abs(int{shown[c]} - int{behind[c]}) < 12);
  }
}

std::unique_ptr<GlContext> some_context() {
  std::string tried;
  auto context = make_osmesa_context(tried);
  if (!context) WARN("no context: " << tried);
  return context;
}

using MakeGl = std::unique_ptr<GlContext> (*)(std::string&);

}  // namespace

TEST_CASE("each side of a cube shows its own picture upright and not mirrored, on every path",
          "[render][textures]") {
  const MakeGl make = GENERATE(&make_egl_surfaceless_context, &make_egl_surfaceless_es_context,
                               &make_osmesa_context);
  std::string tried;
  const auto context = make(tried);
  if (!context) {
    WARN("no context: " << tried);
    return;
  }
  const MaterialTable materials = materials_of({material_row("cube")});
  Textures textures;
  for (std::size_t side = 0; side < kDirectionCount; ++side) {
    // Two of the pictures have another size.
    const std::uint16_t edge = side % 3 == 1 ? 64 : 16;
    textures.add(quarters(edge, kQuarters, kSideColours[side]), 1,
                 static_cast<std::uint8_t>(1U << side));
  }
  TexturedScene scene(*context, materials, mesh_of(materials, {{{8, 8, 8}, 1}}));
  scene.renderer().set_textures(textures.take());
  for (std::size_t side = 0; side < kDirectionCount; ++side) {
    CAPTURE(context->name(), side);
    const Look look = before(static_cast<Direction>(side));
    const Image image = scene.draw(look.camera());
    check_quarters(image, look, kQuarters);
    CHECK(named(pixel_at(image, look, 0, 0)) == kSideColours[side]);
  }
  CHECK(scene.stats().textures_left_out == 0);
}

TEST_CASE("faces that are merged to one quad show the picture in each voxel",
          "[render][textures]") {
  const auto context = some_context();
  if (!context) return;
  const MaterialTable materials = materials_of({material_row("wall")});
  std::vector<std::pair<LocalPos, Material>> voxels;
  for (std::uint8_t a = 7; a <= 9; ++a) {
    for (std::uint8_t b = 7; b <= 9; ++b) voxels.push_back({{a, b, 8}, 1});
  }
  const ChunkMesh mesh = mesh_of(materials, voxels);
  REQUIRE(mesh.opaque.quads.size() == 6);
  Textures textures;
  textures.add(quarters(16, kQuarters, kMagentaPixel), 1, kAllTextureSides);
  TexturedScene scene(*context, materials, mesh);
  scene.set_quality(GENERATE(Quality::low, Quality::high));
  scene.renderer().set_textures(textures.take());
  for (const Direction side : {Direction::neg_z, Direction::pos_z}) {
    const Look look = before(side, 4);
    const Image image = scene.draw(look.camera());
    for (const double right : {-1.0, 0.0, 1.0}) {
      for (const double up : {-1.0, 0.0, 1.0}) check_quarters(image, look, kQuarters, right, up);
    }
  }
}

TEST_CASE("the steps of stairs show the part of the picture at their place", "[render][textures]") {
  const auto context = some_context();
  if (!context) return;
  const Shape stairs{ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}, {{8, 8, 0}, {16, 16, 16}}}};
  const MaterialTable materials = materials_of({material_row("stairs", stairs)});
  ChunkMesh mesh;
  mesh.shapes.opaque = quads_of_shape(materials, 1);
  Textures textures;
  textures.add(quarters(32, kQuarters, kCyanPixel), 1, kAllTextureSides);
  TexturedScene scene(*context, materials, mesh);
  scene.renderer().set_textures(textures.take());
  // Seen from the foot of the stairs, from above and from below, the picture is whole.
  for (const Direction side : {Direction::neg_x, Direction::pos_y, Direction::neg_y}) {
    CAPTURE(static_cast<int>(side));
    const Look look = before(side);
    check_quarters(scene.draw(look.camera()), look, kQuarters);
  }
  // From the side, the upper left quarter of the voxel is empty.
  const Look look = before(Direction::pos_z);
  check_quarters(scene.draw(look.camera()), look, {kHole, kGreenPixel, kBluePixel, kYellowPixel});
}

TEST_CASE("a plant has holes, and its picture is not mirrored from any side",
          "[render][textures]") {
  const auto context = some_context();
  if (!context) return;
  MaterialInfo row = material_row("plant", {ShapeForm::crossed, {ShapeBox{}}});
  row.visibility = GENERATE(Visibility::opaque, Visibility::transparent);
  const MaterialTable materials = materials_of({row});
  ChunkMesh mesh;
  (row.visibility == Visibility::opaque ? mesh.shapes.opaque : mesh.shapes.transparent) =
      quads_of_shape(materials, 1);
  const std::array<Rgba, 4> colours = {kRedPixel, kGreenPixel, kHole, kYellowPixel};
  Textures textures;
  textures.add(quarters(16, colours, kYellowPixel), 1, kAllTextureSides);
  TexturedScene scene(*context, materials, mesh);
  scene.renderer().set_textures(textures.take());
  for (int turn = 0; turn < 4; ++turn) {
    CAPTURE(turn);
    // One plane lies across the sight, and is as wide as the diagonal of a voxel.
    const Look look{M_PI / 4 + turn * M_PI / 2, 0, 2};
    const Image image = scene.draw(look.camera());
    check_quarters(image, look, colours);
    CHECK(named(pixel_at(image, look, -0.55, 0.3)) == kRedPixel);
    CHECK(named(pixel_at(image, look, 0.55, -0.3)) == kYellowPixel);
  }
}

TEST_CASE("holes of opaque cubes have the mean colour, and those of transparent ones are holes",
          "[render][textures]") {
  const auto context = some_context();
  if (!context) return;
  const auto holed = painted(
      16, [](double right, double) { return right < 0.5 ? kRedPixel : Rgba{20, 200, 20, 0}; });
  const Look look = before(Direction::neg_z);
  SECTION("opaque") {
    const MaterialTable materials = materials_of({material_row("leaves")});
    Textures textures;
    textures.add(holed, 1, kAllTextureSides);
    TexturedScene scene(*context, materials, mesh_of(materials, {{{8, 8, 8}, 1}}));
    scene.renderer().set_textures(textures.take());
    check_quarters(scene.draw(look.camera()), look, {kRedPixel, kRedPixel, kRedPixel, kRedPixel});
  }
  SECTION("transparent, before a blue cube") {
    MaterialInfo glass = material_row("glass");
    glass.visibility = Visibility::transparent;
    glass.colour[3] = 72;  // only the picture makes its frame opaque
    MaterialInfo blue = material_row("blue");
    blue.colour = {20, 20, 230, 255};
    blue.look = MaterialLook{0, 0, 100, 0, MaterialPattern::none};
    const MaterialTable materials = materials_of({glass, blue});
    Textures textures;
    textures.add(holed, 1, kAllTextureSides);
    TexturedScene scene(*context, materials, mesh_of(materials, {{{8, 8, 8}, 1}, {{8, 8, 9}, 2}}));
    scene.renderer().set_textures(textures.take());
    check_quarters(scene.draw(look.camera()), look, {kRedPixel, kBluePixel, kRedPixel, kBluePixel});
  }
}

TEST_CASE("far away a side has the mean of its picture, and a plant is still seen",
          "[render][textures]") {
  const auto context = some_context();
  if (!context) return;
  const auto count_of = [](const Image& image, const Rgba& colour) {
    std::size_t out = 0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3)
      out += named({image.rgb[i], image.rgb[i + 1], image.rgb[i + 2], 255}) == colour ? 1 : 0;
    return out;
  };
  SECTION("a wall of small squares") {
    const MaterialTable materials = materials_of({material_row("wall")});
    std::vector<std::pair<LocalPos, Material>> voxels;
    for (std::uint8_t x = 0; x < kTexturedEdge; ++x) {
      for (std::uint8_t y = 0; y < kTexturedEdge; ++y) voxels.push_back({{x, y, 8}, 1});
    }
    Textures textures;
    textures.add(painted(16,
                         [](double right, double down) {
                           const int square =
                               static_cast<int>(16 * right) + static_cast<int>(16 * down);
                           return square % 2 == 0 ? kRedPixel : kGreenPixel;
                         }),
                 1, kAllTextureSides);
    TexturedScene scene(*context, materials, mesh_of(materials, voxels));
    scene.renderer().set_textures(textures.take());
    const Image near = scene.draw(before(Direction::neg_z, 1).camera());
    CHECK(count_of(near, kRedPixel) > kViewEdge * kViewEdge / 3);
    CHECK(count_of(near, kGreenPixel) > kViewEdge * kViewEdge / 3);
    // A square is a quarter of a pixel.
    const Look far = before(Direction::neg_z, 50);
    const Image image = scene.draw(far.camera());
    std::array<int, 3> least{255, 255, 255}, most{0, 0, 0};
    for (double right = -6; right < 6; right += 0.37) {
      for (double up = -6; up < 6; up += 0.41) {
        const Rgba pixel = pixel_at(image, far, right, up);
        for (std::size_t c = 0; c < 3; ++c) {
          least[c] = std::min(least[c], int{pixel[c]});
          most[c] = std::max(most[c], int{pixel[c]});
        }
      }
    }
    for (std::size_t c = 0; c < 3; ++c) CHECK(most[c] - least[c] <= 12);
    CHECK(least[0] > most[2] + 20);  // the mean is yellow
    CHECK(least[1] > most[2] + 20);
  }
  SECTION("a plant of few blades") {
    const MaterialTable materials =
        materials_of({material_row("plant", {ShapeForm::crossed, {ShapeBox{}}})});
    ChunkMesh mesh;
    mesh.shapes.opaque = quads_of_shape(materials, 1);
    Textures textures;
    textures.add(painted(16,
                         [](double right, double) {
                           return static_cast<int>(16 * right) % 4 == 1 ? kRedPixel : kHole;
                         }),
                 1, kAllTextureSides);
    TexturedScene scene(*context, materials, mesh);
    scene.renderer().set_textures(textures.take());
    const Look far{M_PI / 4, 0, 40};
    CHECK(count_of(scene.draw(far.camera()), kRedPixel) >= 4);
  }
}

TEST_CASE("without textures a frame is the same to the bit, and so are materials without pictures",
          "[render][textures]") {
  const auto context = some_context();
  if (!context) return;
  MaterialInfo water = material_row("water");
  water.visibility = Visibility::transparent;
  water.body = MaterialBody::liquid;
  water.colour = {40, 90, 200, 120};
  const MaterialTable materials = materials_of(
      {material_row("bricks"), material_row("slab", {ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}}}),
       water, material_row("textured")});
  ChunkMesh mesh = mesh_of(materials, {{{7, 8, 8}, 1}, {{8, 7, 8}, 3}, {{9, 8, 8}, 1}});
  mesh.shapes.opaque = quads_of_shape(materials, 2);
  TexturedScene scene(*context, materials, mesh);
  scene.set_quality(GENERATE(Quality::low, Quality::medium, Quality::high));
  Camera camera = Look{0.4, -0.3, 5}.camera();
  camera.x += 0.3;
  const Image before_all = scene.draw(camera);
  Textures textures;
  textures.add(quarters(16, kQuarters, kCyanPixel), 4, kAllTextureSides);
  scene.renderer().set_textures(textures.take());
  const Image with_others = scene.draw(camera);
  scene.renderer().set_textures(nullptr);
  const Image without = scene.draw(camera);
  CHECK(before_all.rgb == with_others.rgb);
  CHECK(before_all.rgb == without.rgb);
}

TEST_CASE("pictures that arrive later are drawn, and those that leave are not",
          "[render][textures]") {
  const auto context = some_context();
  if (!context) return;
  const MaterialTable materials = materials_of({material_row("a"), material_row("b")});
  TexturedScene scene(*context, materials, mesh_of(materials, {{{8, 8, 8}, 1}, {{9, 8, 8}, 2}}));
  Textures both;
  both.add(plain(16, kRedPixel), 1, kAllTextureSides);
  both.add(plain(16, kGreenPixel), 2, kAllTextureSides);
  const DrawnTexturesPtr all = both.take();
  const Look look = before(Direction::pos_z);
  const auto shown = [&](const DrawnTexturesPtr& textures) {
    scene.renderer().set_textures(textures);
    const Image image = scene.draw(look.camera());
    return std::array{named(pixel_at(image, look, 0, 0)), named(pixel_at(image, look, 0.9, 0))};
  };
  auto first = std::make_shared<DrawnTextures>(*all);
  first->pictures[1] = nullptr;
  CHECK(shown(first) == std::array{kRedPixel, kHole});
  const std::uint64_t bytes = scene.stats().texture_bytes;
  CHECK(bytes > 0);
  CHECK(shown(all) == std::array{kRedPixel, kGreenPixel});
  CHECK(scene.stats().texture_bytes == bytes);  // the array had a layer for the second picture
  auto second = std::make_shared<DrawnTextures>(*all);
  second->pictures[0] = nullptr;
  CHECK(shown(second) == std::array{kHole, kGreenPixel});
  second->pictures[0] =
      std::make_shared<const TextureLevels>(texture_levels(plain(64, kBluePixel)));
  CHECK(shown(second) == std::array{kBluePixel, kGreenPixel});  // the array has larger layers now
  CHECK(shown(nullptr) == std::array{kHole, kHole});
}

TEST_CASE("pictures beyond the layers of the driver are counted, and their sides show no picture",
          "[render][textures]") {
  const auto context = some_context();
  if (!context) return;
  const MaterialTable materials = materials_of({material_row("a"), material_row("b")});
  TexturedScene scene(*context, materials, mesh_of(materials, {{{8, 8, 8}, 1}, {{9, 8, 8}, 2}}));
  GLint layers = 0;
  glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &layers);
  if (layers >= static_cast<GLint>(kTextureCountMax)) return;
  Textures textures;
  textures.add(plain(16, kRedPixel), 1, kAllTextureSides);
  for (GLint i = 0; i < layers; ++i)
    textures.add(plain(16, kBluePixel), static_cast<Material>(3 + i), kAllTextureSides);
  textures.add(plain(16, kGreenPixel), 2, kAllTextureSides);
  scene.renderer().set_textures(textures.take());
  const Look look = before(Direction::pos_z);
  const Image image = scene.draw(look.camera());
  CHECK(scene.stats().textures_left_out == 2);
  CHECK(named(pixel_at(image, look, 0, 0)) == kRedPixel);
  CHECK(named(pixel_at(image, look, 0.9, 0)) == kHole);
}

}  // namespace runstone
