#include "python_build.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "common/build_files/build_files.hpp"
#include "common/builds/build_builder.hpp"
#include "common/runs/run_builder.hpp"
#include "python_world.hpp"

namespace runstone::python {
namespace {

constexpr std::int32_t kSectionEdge = 64;

std::vector<std::int32_t> section_cuts(std::size_t side) {
  return grid_cuts(static_cast<std::int32_t>(side), kSectionEdge);
}

/// Makes a build of an array. Cell numbers are those of the builder. Thread: any; Python's lock is
/// not needed.
Result<BuildPtr> build_of(const VoxelGrid& grid) {
  auto builder = BuildBuilder::of(
      {section_cuts(grid.sides[0]), section_cuts(grid.sides[1]), section_cuts(grid.sides[2])});
  if (!builder) return failure(builder.error());
  const BuildCuts cuts = builder->cuts();
  const bool is_c = grid.order == AxisOrder::zyx;
  const std::array<std::size_t, 3> steps =
      is_c ? std::array<std::size_t, 3>{grid.sides[1] * grid.sides[2], grid.sides[2], 1}
           : std::array<std::size_t, 3>{1, grid.sides[0], grid.sides[0] * grid.sides[1]};
  std::vector<std::uint16_t> numbers(kMaterialCountMax, 0);  // by material; 0: not yet known
  SectionPos at;
  for (at.z = 0; at.z + 1 < cuts[2].size(); ++at.z) {
    for (at.y = 0; at.y + 1 < cuts[1].size(); ++at.y) {
      for (at.x = 0; at.x + 1 < cuts[0].size(); ++at.x) {
        const auto range = [&](std::size_t axis, std::uint32_t i) {
          return std::pair(static_cast<std::size_t>(cuts[axis][i]),
                           static_cast<std::size_t>(cuts[axis][i + 1]));
        };
        const auto [x0, x1] = range(0, at.x);
        const auto [y0, y1] = range(1, at.y);
        const auto [z0, z1] = range(2, at.z);
        RunBuilder cells({static_cast<std::uint8_t>(x1 - x0), static_cast<std::uint8_t>(y1 - y0),
                          static_cast<std::uint8_t>(z1 - z0)},
                         AxisOrder::zyx);
        for (std::size_t x = x0; x < x1; ++x) {
          for (std::size_t y = y0; y < y1; ++y) {
            for (std::size_t z = z0; z < z1; ++z) {
              const Material material = grid.data()[x * steps[0] + y * steps[1] + z * steps[2]];
              std::uint16_t& number = numbers[material];
              if (number == 0) {
                const auto found = builder->number_of(material);
                if (!found)
                  return fail(ErrorCode::limit_exceeded, "more materials than a build can have");
                number = *found;
              }
              cells.append(1, number);
            }
          }
        }
        if (auto put = builder->put(at, cells.finish()); !put) return failure(put.error());
      }
    }
  }
  return builder->finish();
}

MaterialRow row_of_material(Material id, const std::vector<Self<PythonMaterial>>& materials) {
  MaterialRow row;
  const auto found = std::find_if(materials.begin(), materials.end(),
                                  [id](const auto& each) { return each->id == id; });
  if (found != materials.end()) {
    row.name = (*found)->name;
    row.colour = (*found)->colour;
    row.visibility = (*found)->visibility;
  } else if (id == kEmpty) {
    row.name = "air";
    row.colour = {0, 0, 0, 0};
    row.visibility = Visibility::empty;
  } else {
    row.name = "material " + std::to_string(id);
    row.colour = {128, 128, 128, 255};
  }
  return row;
}

std::uint64_t write_build(const py::object& path, const py::array& array,
                          const std::optional<std::vector<Self<PythonMaterial>>>& materials,
                          const Triple& origin, double metres_per_voxel, std::int64_t levels) {
  const std::string file = path_of(path);
  if (auto why = file_refusal(file, true); !why.empty()) refuse(why);
  if (!(metres_per_voxel > 0) || metres_per_voxel > 1e6)
    refuse("metres_per_voxel is above 0 and at most 1000000");
  if (levels < 0 || levels > static_cast<std::int64_t>(kModelLevelsMax))
    refuse("levels is a number from 0 to " + std::to_string(kModelLevelsMax));
  const VoxelGrid grid = voxel_grid(array);
  for (const std::size_t side : grid.sides) {
    if (side < 1 || side > static_cast<std::size_t>(kBuildSideMax))
      refuse("a build has 1 to " + std::to_string(kBuildSideMax) + " voxels a side");
  }
  auto build = [&] {
    const py::gil_scoped_release released;
    return build_of(grid);
  }();
  if (!build) refuse("array", build.error(), "cell");
  FileBuild out;
  out.build = *std::move(build);
  out.info.name = build_name_of_file(file);
  out.info.origin = position_of(origin);
  out.info.sides = {static_cast<std::uint32_t>(grid.sides[0]),
                    static_cast<std::uint32_t>(grid.sides[1]),
                    static_cast<std::uint32_t>(grid.sides[2])};
  const std::vector<Self<PythonMaterial>> none;
  for (const Material id : out.build->palette())
    out.materials.push_back({row_of_material(id, materials ? *materials : none), {}});
  FileWriting writing;
  writing.model.metres_per_voxel = metres_per_voxel;
  writing.model.levels = static_cast<unsigned>(levels);
  const auto written = [&] {
    const py::gil_scoped_release released;
    return write_build_to_file(file, out, writing);
  }();
  if (!written) throw RunstoneError(written.error());
  return *written;
}

}  // namespace

void define_build(py::module_& module) {
  module.def(
      "write_build", &write_build, py::arg("path"), py::arg("array"),
      py::arg("materials") = py::none(), py::arg("origin") = Triple{0, 0, 0},
      py::arg("metres_per_voxel") = 1.0, py::arg("levels") = 0,
      "Write an array of voxels as a file and return its number of bytes.\n\n"
      "The ending of the path chooses the format: .glb, .gltf, .obj and .ply are models, and .vox, "
      ".schem and the others of docs/formats.md are builds. An old file is replaced when the new "
      "one is whole.\n"
      "materials are objects of Material, such as World.materials. A material without one is "
      "grey.\n"
      "origin is the place in a world of the lowest corner. metres_per_voxel and levels, the "
      "number of coarser levels of detail from 0 to 8, are for models.\n"
      "Raise ValueError for an array or an ending that cannot be written, and Error if the file "
      "cannot be written or the array shows no face.");
}

}  // namespace runstone::python
