#include "server/replay/timelapse.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <system_error>
#include <vector>

#include "common/os/steady_clock.hpp"
#include "common/os/text_file.hpp"
#include "server/draw/draw_child.hpp"
#include "server/draw/oblique_camera.hpp"
#include "server/replay/camera_path.hpp"
#include "server/replay/timelapse_world.hpp"

namespace runstone {
namespace {

constexpr Sequence kFramesWanted = 300;  // ten seconds of video

/// Returns the moments to draw, ascending, with the first and the last moment of the timelapse.
Result<std::vector<Sequence>, std::string> moments_of(WorldReader& reader,
                                                      const TimelapseOptions& options,
                                                      Sequence at) {
  const auto range = reader.log_range();
  if (!range) return failure(range.error().message());
  const Sequence last = std::min(at, range->last.version.seq);
  const Sequence first = options.from.value_or(range->first - 1);
  if (first > last) {
    return failure(reader.file() + ": there is no edit from seq=" + std::to_string(first) +
                   " to seq=" + std::to_string(last));
  }
  const Sequence edits = last - first;
  const Sequence every = options.every != 0
                             ? options.every
                             : std::max<Sequence>(1, (edits + kFramesWanted - 1) / kFramesWanted);
  if (edits / every >= kTimelapseFramesMax) {
    return failure(std::to_string(edits) + " edits are more than " +
                   std::to_string(kTimelapseFramesMax) + " frames; choose a larger --every");
  }
  std::vector<Sequence> moments;
  for (Sequence done = 0; done < edits; done += std::min(every, edits - done))
    moments.push_back(first + done);
  moments.push_back(last);
  return moments;
}

Result<std::optional<CameraPath>, std::string> path_of(const TimelapseOptions& options,
                                                       const std::vector<Sequence>& moments) {
  if (options.camera.empty()) return std::optional<CameraPath>();
  const auto text = read_text_file(options.camera, kTextFileBytesMax);
  if (!text) return failure(text.error());
  auto path = CameraPath::parse(*text, options.camera, moments.front(), moments.back());
  if (!path) return failure(path.error().message());
  return std::optional<CameraPath>(*std::move(path));
}

/// Makes the folder. Fails if it holds frames of another timelapse, which would become part of the
/// video.
Result<void, std::string> prepare_folder(const std::string& folder) {
  std::error_code wrong;
  std::filesystem::create_directories(folder, wrong);
  if (wrong) return failure(folder + ": cannot be made: " + wrong.message());
  for (std::filesystem::directory_iterator entry(folder, wrong), end; !wrong && entry != end;
       entry.increment(wrong)) {
    const std::string name = entry->path().filename().string();
    if (name.starts_with("frame-") && name.ends_with(".png")) {
      return failure(folder + ": holds frames already (" + name +
                     "); choose another folder or empty this one");
    }
  }
  if (wrong) return failure(folder + ": cannot be read: " + wrong.message());
  return {};
}

/// Returns the chunks in which the camera stands at the moments.
std::vector<ChunkCoord> eyes_of(const CameraPath& path, const std::vector<Sequence>& moments,
                                std::int32_t edge) {
  std::set<ChunkCoord> eyes;
  const auto voxel = [](double v) { return static_cast<std::int32_t>(std::floor(v)); };
  for (const Sequence moment : moments) {
    const DrawCamera camera = path.at(moment);
    eyes.insert(chunk_of({voxel(camera.x), voxel(camera.y), voxel(camera.z)}, edge));
  }
  return {eyes.begin(), eyes.end()};
}

}  // namespace

std::string frame_name(std::uint64_t number) {
  const std::string digits = std::to_string(number);
  return "frame-" + std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits + ".png";
}

Result<TimelapseReport, std::string> make_timelapse(
    WorldReader& reader, const Generator& generator, const TimelapseOptions& options, Sequence at,
    const std::function<void(std::uint64_t, std::uint64_t)>& progress) {
  const auto start = std::chrono::steady_clock::now();
  const auto moments = moments_of(reader, options, at);
  if (!moments) return failure(moments.error());
  const auto path = path_of(options, *moments);
  if (!path) return failure(path.error());
  if (const auto prepared = prepare_folder(options.folder); !prepared)
    return failure(prepared.error());
  auto child = DrawChild::start({options.client});
  if (!child) return failure(child.error());

  const std::int32_t edge = reader.meta().chunk_edge;
  const std::vector<ChunkCoord> eyes =
      path->has_value() ? eyes_of(**path, *moments, edge) : std::vector<ChunkCoord>();
  auto world = TimelapseWorld::open(reader, generator, moments->front(), moments->back(),
                                    static_cast<std::uint32_t>(options.radius), eyes);
  if (!world) return failure(world.error().message());
  if (world->edited().empty() && !path->has_value()) {
    return failure(reader.file() +
                   ": no edit, so there is nothing to look at (--camera FILE looks anywhere)");
  }
  DrawCamera still;
  if (!path->has_value()) still = oblique_camera(world->edited(), options.size);
  const VoxelBox stage = world->stage();

  TimelapseReport report;
  report.first = moments->front();
  report.last = moments->back();
  report.chunks = world->chunk_count();
  report.renderer = child->renderer();
  const auto materials = reader.materials();
  if (!materials) return failure(materials.error().message());
  Result<void, std::string> sent = child->world(edge, *materials);
  const auto send = [&](const ChunkKey& key, const RunChunk& voxels) {
    if (sent) sent = child->chunk(key, voxels);
    ++report.chunks_sent;
    return sent.has_value();
  };
  if (const auto begun = world->begin(send); !begun) return failure(begun.error().message());
  for (const Sequence moment : *moments) {
    if (const auto moved = world->advance(moment, send); !moved)
      return failure(moved.error().message());
    if (!sent) return failure(sent.error());
    DrawCamera camera = path->has_value() ? (*path)->at(moment) : still;
    fit_distances(camera, stage);
    const auto ordered = std::chrono::steady_clock::now();
    const std::string file =
        (std::filesystem::path(options.folder) / frame_name(report.frames + 1)).string();
    if (const auto drawn = child->draw(camera, options.size, file); !drawn)
      return failure(drawn.error());
    report.draw_seconds += seconds_since(ordered);
    ++report.frames;
    if (progress) progress(report.frames, moments->size());
  }
  if (const auto finished = child->finish(); !finished) return failure(finished.error());
  report.seconds = seconds_since(start);
  return report;
}

}  // namespace runstone
