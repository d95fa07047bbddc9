#include <algorithm>
#include <array>
#include <bit>
#include <nlohmann/json.hpp>
#include <ostream>
#include <vector>

#include "common/core/coords_text.hpp"
#include "common/formats/npy_header.hpp"
#include "common/os/output_file.hpp"
#include "common/os/progress_line.hpp"
#include "server/history/voxels_at.hpp"
#include "server/replay/command_world.hpp"
#include "server/replay/replay_commands.hpp"

namespace runstone {
namespace {

// The elements of the array are written as they lie in memory, and numpy reads them as "<u2".
static_assert(std::endian::native == std::endian::little);
constexpr const char* kDumpType = "<u2";

struct DumpSides {
  std::uint64_t x, y, z;
  std::uint64_t layer_bytes() const { return y * z * sizeof(Material); }
};

DumpSides dump_sides(const VoxelBox& box) {
  return {static_cast<std::uint64_t>(box.max.x - box.min.x),
          static_cast<std::uint64_t>(box.max.y - box.min.y),
          static_cast<std::uint64_t>(box.max.z - box.min.z)};
}

/// Returns the end of the next part of the box, from x on: up to the next chunk, but no more layers
/// than memory allows.
std::int32_t part_end(const VoxelBox& box, std::int32_t x, std::int32_t edge,
                      std::uint64_t layers_max) {
  const std::int32_t chunk_end = (floor_div(x, edge) + 1) * edge;
  const auto layers = std::min(static_cast<std::uint64_t>(chunk_end - x), layers_max);
  return std::min(box.max.x, x + static_cast<std::int32_t>(layers));
}

/// Writes head and elements, part after part along x. The error is one line.
Result<void, std::string> write_array(const WorldAt& world, Store& store,
                                      const DumpOptions& options, FileWriter& file) {
  const VoxelBox& box = *options.box;
  const DumpSides sides = dump_sides(box);
  const std::uint64_t layers_max = (options.memory_mib << 20) / sides.layer_bytes();
  const std::array<std::uint64_t, 3> shape = {sides.x, sides.y, sides.z};
  const auto cannot_write = [&] { return failure(options.file + ": " + file.error()); };
  if (!file.write(ByteView(npy_header(kDumpType, shape)))) return cannot_write();
  const std::array<WorldReader*, 1> readers = {&store};
  std::vector<Material> part;
  ProgressLine line("layers read", options.common.progress);
  for (VoxelBox slab = box; slab.min.x < box.max.x; slab.min.x = slab.max.x) {
    line.show(static_cast<std::uint64_t>(slab.min.x - box.min.x), sides.x);
    slab.max.x = part_end(box, slab.min.x, store.meta().chunk_edge, layers_max);
    part.resize(static_cast<std::size_t>(slab.max.x - slab.min.x) * sides.y * sides.z);
    if (const auto read = read_voxels(world, readers, slab, part); !read)
      return failure(read.error().message());
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(part.data());
    if (!file.write(ByteView(bytes, part.size() * sizeof(Material)))) return cannot_write();
  }
  const auto finished = file.finish();
  if (!finished) return failure(options.file + ": " + finished.error());
  return {};
}

}  // namespace

void declare_dump(SubcommandOptions& command_line, DumpOptions& options) {
  command_line.common(options.common, "folder of the world; a server may be running it");
  command_line.output_file(
      "FILE", options.file,
      "the .npy file to write, which numpy.load() reads; an old one is replaced",
      SubcommandOptions::Presence::required);
  command_line.parsed(
      "--box",
      [&options](const std::string& text) -> std::string {
        options.box = parse_voxel_box(text);
        return options.box ? "" : "X,Y,Z,X,Y,Z: two opposite corners, both inside";
      },
      "X,Y,Z,X,Y,Z: the box of the world to write, two opposite corners, both inside",
      SubcommandOptions::Presence::required);
  command_line.moment("--at", options.at, "last edit in the array");
  command_line.number("--memory", options.memory_mib, 1, 65'536,
                      "MiB that the voxels in memory may take; default 256");
}

Result<int, std::string> run_dump(const DumpOptions& options, std::ostream& out) {
  if (!options.file.ends_with(".npy"))
    return failure(options.file + ": the name of the file must end in .npy");
  const DumpSides sides = dump_sides(*options.box);
  if (sides.layer_bytes() > options.memory_mib << 20) {
    return failure("--box: one layer of " + std::to_string(sides.y) + " x " +
                   std::to_string(sides.z) + " voxels takes more than the " +
                   std::to_string(options.memory_mib) + " MiB of --memory");
  }
  const auto world = open_for_reading(options.common.world, options.at);
  if (!world) return failure(world.error());
  Store& store = *world->store;
  const auto end = end_in_log(*world);
  if (!end) return failure(end.error());
  const Sequence at = *end;
  const auto then = WorldAt::open(store, *world->generator, at);
  if (!then) return failure(then.error().message());
  auto file = open_output_file(options.file);
  if (!file) return failure(file.error());
  if (const auto done = write_array(*then, store, options, *file); !done)
    return failure(done.error());
  print_world(out, store);
  row(out, "moment") << "after sequence " << at << '\n';
  row(out, "array") << sides.x << " x " << sides.y << " x " << sides.z
                    << " elements of type uint16, axes x, y, z\n";
  row(out, "written") << options.file << '\n';
  const nlohmann::ordered_json json = {{"seq", at},
                                       {"shape", {sides.x, sides.y, sides.z}},
                                       {"lost", store.loss() ? store.loss()->message() : ""}};
  const auto written = write_report(options.common.json, json.dump(1));
  if (!written) return failure(written.error());
  return code_of_output(store);
}

}  // namespace runstone
