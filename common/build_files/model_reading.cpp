#include "common/build_files/model_reading.hpp"

#include <array>
#include <utility>

#include "common/models/model_format.hpp"
#include "common/voxelise/voxel_build.hpp"

namespace runstone {
namespace {

constexpr std::array<std::pair<std::string_view, SurfaceMode>, 4> kSurfaceWords = {
    {{"none", SurfaceMode::none},
     {"thin", SurfaceMode::separating_6},
     {"thick", SurfaceMode::separating_26},
     {"all", SurfaceMode::conservative}}};

VoxeliseOptions voxelise_options(const ModelReading& reading, const Model& model) {
  VoxeliseOptions options;
  if (reading.voxels_per_metre) {
    options.scale.voxels_per_unit = *reading.voxels_per_metre * model.metres_per_unit.value_or(1);
  } else {
    options.scale.longest_side = reading.voxels;
  }
  options.is_solid = reading.is_solid;
  options.surface =
      reading.surface.value_or(reading.is_solid ? SurfaceMode::none : SurfaceMode::separating_6);
  options.turn = options.turn.rotated_about_y(reading.quarters);
  options.fills_overlaps = reading.fills_overlaps;
  options.colours_max = kModelColoursMax;
  options.should_continue = reading.file.should_continue;
  return options;
}

void notice_result(const Voxelised& result, const Model& model, bool is_solid,
                   const ReadNotice& notice) {
  if (model.is_cloud()) return notice("the model is a cloud of points: each became a voxel");
  if (!is_solid) return;
  if (result.rule == SolidRule::winding)
    notice("the surface is open: what lies inside was found by its winding number");
}

}  // namespace

std::optional<SurfaceMode> surface_of_word(std::string_view word) {
  for (const auto& [name, mode] : kSurfaceWords) {
    if (name == word) return mode;
  }
  return std::nullopt;
}

bool is_model_file(std::string_view file) { return model_format_of(file).has_value(); }

std::string model_endings() { return ".obj, .stl, .ply, .gltf, .glb"; }

Result<FileBuild, std::string> read_model_build(const std::string& file,
                                                const ModelReading& reading, std::size_t bytes_max,
                                                const ReadNotice& notice) {
  if (!reading.is_solid && reading.surface.value_or(SurfaceMode::separating_6) == SurfaceMode::none)
    return failure(file + ": neither its inside nor its surface is wanted");
  const auto read = read_model_file(file, reading.file);
  if (!read) return failure(read.error());
  const ReadNotice say = [&](const std::string& line) {
    if (notice) notice(file + ": " + line);
  };
  for (const std::string& line : read->notices) say(line);
  VoxeliseOptions options = voxelise_options(reading, read->model);
  auto voxels = voxel_build(read->model, options, bytes_max);
  if (!voxels && voxels.error().code == ErrorCode::bad_value && !reading.surface &&
      reading.is_solid) {
    options.is_solid = false;
    options.surface = SurfaceMode::separating_6;
    voxels = voxel_build(read->model, options, bytes_max);
    if (voxels) say("nothing lies inside: its surface alone was taken");
  }
  if (!voxels) return failure(file + ": " + voxels.error().what);
  notice_result(voxels->result, read->model, options.is_solid, say);
  FileBuild out;
  for (const Material number : voxels->build->palette())
    out.materials.push_back({voxels->materials[number - 1U], {}});
  out.build = std::move(voxels->build);
  const VoxelPos sides = out.build->sides();
  out.info.sides = {static_cast<std::uint32_t>(sides.x), static_cast<std::uint32_t>(sides.y),
                    static_cast<std::uint32_t>(sides.z)};
  return out;
}

}  // namespace runstone
