#include <array>
#include <cmath>

#include "common/core/assert.hpp"
#include "common/model_writers/gltf_layout.hpp"
#include "common/model_writers/model_writers.hpp"

namespace runstone {
namespace {

constexpr std::string_view kGltfDataUri = R"(,"uri":"data:application/octet-stream;base64,)";
constexpr std::uint64_t kGlbHeadBytes = 12, kGlbChunkHeadBytes = 8;

/// Passes bytes on as base64.
class Base64Output {
 public:
  explicit Base64Output(ModelOutput& out) : out_(out) {}

  void bytes(ByteView in) {
    for (const std::uint8_t byte : in) {
      group_[count_++] = byte;
      if (count_ == 3) write_group();
    }
  }
  void finish() {
    if (count_ != 0) write_group();
  }

 private:
  void write_group() {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const std::uint32_t bits =
        std::uint32_t{group_[0]} << 16 | std::uint32_t{group_[1]} << 8 | std::uint32_t{group_[2]};
    char digits[4];
    for (std::size_t i = 0; i < 4; ++i)
      digits[i] = i <= count_ ? kDigits[bits >> (18 - 6 * i) & 63] : '=';
    out_.text({digits, 4});
    group_ = {};
    count_ = 0;
  }

  ModelOutput& out_;
  std::array<std::uint8_t, 3> group_{};
  std::size_t count_ = 0;
};

/// Returns the bytes of the JSON up to the buffer.
std::uint64_t gltf_json_bytes(const WrittenBuild& source, const ModelWriting& writing,
                              const GltfLayout& layout) {
  const ModelSink drop = [](ByteView) { return true; };
  ModelOutput counted(drop);
  write_gltf_json(source, writing, layout, counted);
  return counted.size();
}

void write_gltf_buffer(ModelLevels& levels, bool is_quantised, ModelOutput& out) {
  for (std::size_t level = 0; level < levels.count() && out.ok(); ++level) {
    levels.walk(level).for_each_region([&](const RegionModel& region) {
      write_gltf_region(region, is_quantised, out);
      return out.ok();
    });
  }
}

Result<void> gltf_outcome(bool is_written) {
  if (!is_written) return fail(ErrorCode::io_failed, "model: cannot be written");
  return {};
}

void require_scale(const ModelWriting& writing) {
  RUNSTONE_ASSERT(std::isfinite(writing.metres_per_voxel) && writing.metres_per_voxel > 0);
}

}  // namespace

Result<void> write_glb_model(const WrittenBuild& source, const ModelWriting& writing,
                             const ModelSink& sink) {
  require_scale(writing);
  auto levels = ModelLevels::of(source, writing);
  if (!levels) return failure(levels.error());
  const auto layout = GltfLayout::of(*levels, writing.is_quantised);
  if (!layout) return failure(layout.error());
  constexpr std::string_view kEnd = "}]}";
  const std::uint64_t text = gltf_json_bytes(source, writing, *layout) + kEnd.size();
  const std::uint64_t json = (text + 3) / 4 * 4;
  const std::uint64_t size = kGlbHeadBytes + 2 * kGlbChunkHeadBytes + json + layout->buffer_bytes;
  if (size > kGlbBytesMax) {
    return fail(ErrorCode::limit_exceeded,
                "model: a .glb has at most 4 GiB; write a smaller box, fewer levels, or a .ply");
  }
  ModelOutput out(sink);
  out.text("glTF");
  out.u32(2);
  out.u32(static_cast<std::uint32_t>(size));
  out.u32(static_cast<std::uint32_t>(json));
  out.text("JSON");
  write_gltf_json(source, writing, *layout, out);
  out.text(kEnd);
  out.text(std::string_view("   ").substr(0, json - text));
  out.u32(static_cast<std::uint32_t>(layout->buffer_bytes));
  out.text(std::string_view("BIN\0", 4));
  write_gltf_buffer(*levels, writing.is_quantised, out);
  return gltf_outcome(out.flush());
}

Result<void> write_gltf_model(const WrittenBuild& source, const ModelWriting& writing,
                              const ModelSink& sink) {
  require_scale(writing);
  auto levels = ModelLevels::of(source, writing);
  if (!levels) return failure(levels.error());
  const auto layout = GltfLayout::of(*levels, writing.is_quantised);
  if (!layout) return failure(layout.error());
  constexpr std::string_view kEnd = "\"}]}\n";
  const std::uint64_t size = gltf_json_bytes(source, writing, *layout) + kGltfDataUri.size() +
                             (layout->buffer_bytes + 2) / 3 * 4 + kEnd.size();
  if (size > kGltfBytesMax) {
    return fail(ErrorCode::limit_exceeded,
                "model: a .gltf has at most 500,000,000 bytes; write a .glb");
  }
  ModelOutput out(sink);
  write_gltf_json(source, writing, *layout, out);
  out.text(kGltfDataUri);
  Base64Output base64(out);
  const ModelSink encode = [&](ByteView bytes) {
    base64.bytes(bytes);
    return out.ok();
  };
  ModelOutput buffer(encode);
  write_gltf_buffer(*levels, writing.is_quantised, buffer);
  buffer.flush();
  base64.finish();
  out.text(kEnd);
  return gltf_outcome(out.flush());
}

}  // namespace runstone
