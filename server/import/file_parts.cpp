#include <array>
#include <string>
#include <utility>
#include <vector>

#include "common/build_files/build_files.hpp"
#include "server/import/import_parts.hpp"

namespace runstone {
namespace {

/// The bytes of a file.
constexpr std::size_t kFileBytesMax = std::size_t{1} << 30;

class FileParts final : public ImportParts {
 public:
  FileParts(std::string file, VoxelPos at, bool keep_all, std::string colours, ModelReading model)
      : file_(std::move(file)),
        at_(at),
        keep_all_(keep_all),
        colours_(std::move(colours)),
        model_(std::move(model)) {}

  std::size_t count() const override { return 1; }
  std::vector<std::string> notices() const override { return notices_; }
  Result<std::optional<ImportPart>, std::string> read(std::size_t, ImportFaults&) override {
    BuildReading reading;
    reading.foreign.keep_all = keep_all_;
    reading.foreign.bytes_max = kPartBytesMax;
    reading.foreign.colours_file = colours_;
    reading.model = model_;
    notices_.clear();
    reading.notice = [this](const std::string& line) { notices_.push_back(line); };
    auto build = read_build_of_file(file_, std::move(reading), kFileBytesMax);
    if (!build) return failure(build.error());
    const VoxelPos sides = build->build->sides();
    const std::array<std::pair<std::int64_t, std::int64_t>, 3> axes = {
        {{at_.x, sides.x}, {at_.y, sides.y}, {at_.z, sides.z}}};
    for (const auto& [at, side] : axes) {
      if (at < -kWorldLimit || at + side > kWorldLimit)
        return failure(file_ + ": its box does not lie in the world at this place");
    }
    return std::optional(ImportPart{*std::move(build), at_});
  }

 private:
  std::string file_;
  VoxelPos at_;
  bool keep_all_;
  std::string colours_;
  ModelReading model_;
  std::vector<std::string> notices_;  // of the last read()
};

}  // namespace

Result<std::unique_ptr<ImportParts>, std::string> open_file_parts(const std::string& file,
                                                                  VoxelPos at, bool keep_all,
                                                                  const std::string& colours,
                                                                  const ModelReading& model) {
  if (auto why = file_refusal(file, false); !why.empty()) return failure(std::move(why));
  return std::unique_ptr<ImportParts>(
      std::make_unique<FileParts>(file, at, keep_all, colours, model));
}

}  // namespace runstone
