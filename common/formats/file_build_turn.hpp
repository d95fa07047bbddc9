// Builds of files that are turned by quarter turns or mirrored: their cells, and the materials
// whose names and states say how they lie. The clipboard of a client, whose materials are those of
// a world, is turned by client/tools/turned_materials.hpp.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/edits/clipboard/orientation.hpp"
#include "common/formats/rsb_build.hpp"

namespace runstone {

/// Returns the material that a material becomes in a turned build: its name, states and shape.
/// `along` and `flips` are those of turned_material_name(). States that are written stay written;
/// others are added if they are not the default. A material without names for its lie keeps its
/// name, and its shape is turned. Returns nullopt if turned_material_name() has no name for it, or
/// if the turned shape has more than kShapeFacesMax faces. Cost: O(rules + bytes), and some shapes.
std::optional<BuildMaterial> turned_build_material(const BuildMaterial& material,
                                                   std::array<Axis, 3> along, std::uint8_t flips);

struct TurnedFileBuild {
  FileBuild build;
  std::size_t stuck =
      0;  // materials that turned_build_material() does not turn, and that stay as they are
};

/// Returns a build as it lies in the world with this orientation. Materials that become equal are
/// one. The origin stays. Turning by four quarters gives back the materials, unless two have become
/// one or some are stuck. Fails with limit_exceeded if the result takes more than `bytes_max`.
/// Cost: that of turned() (common/builds/build_transforms.hpp), and of turned_build_material() for
/// each material.
Result<TurnedFileBuild> turned_file_build(const FileBuild& build, const Orientation& orientation,
                                          std::size_t bytes_max = kBuildBytesMax);

}  // namespace runstone
