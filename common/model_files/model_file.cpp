#include "common/model_files/model_file.hpp"

#include <signal.h>
#include <sys/wait.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "common/model_files/model_child.hpp"
#include "common/models/printable_line.hpp"
#include "common/os/child_program.hpp"
#include "common/os/private_file.hpp"

namespace runstone {
namespace {

constexpr std::size_t kLineBytesMax = 1024;
constexpr std::uint64_t kMemoryMibMax = std::uint64_t{1} << 20;
constexpr std::chrono::milliseconds kTimeMax{std::chrono::hours(24)};
constexpr int kRefusedExit = 2;  // of runstone-read-model for a file that it cannot read

ModelFileOptions within_ranges(ModelFileOptions options) {
  options.memory_mib = std::clamp<std::uint64_t>(options.memory_mib, 1, kMemoryMibMax);
  options.time_max = std::clamp(options.time_max, std::chrono::milliseconds(1), kTimeMax);
  options.triangles_max = std::clamp<std::size_t>(options.triangles_max, 1, kModelTrianglesMax);
  return options;
}

std::vector<std::string> command_line(const std::string& program, const std::string& file,
                                      const ModelFileOptions& options) {
  // The child's limit of processor time is above that of time, which so ends it first.
  const auto seconds = std::chrono::ceil<std::chrono::seconds>(options.time_max).count() + 1;
  std::vector<std::string> words = {program,
                                    "--memory",
                                    std::to_string(options.memory_mib),
                                    "--seconds",
                                    std::to_string(std::min<std::int64_t>(seconds, 86'400)),
                                    "--triangles",
                                    std::to_string(options.triangles_max)};
  if (options.up) {
    words.push_back("--up");
    words.push_back(*options.up == ModelUp::y ? "y" : "z");
  }
  words.push_back("--");
  words.push_back(file);
  return words;
}

std::string time_text(std::chrono::milliseconds time) {
  if (time.count() % 1000 == 0) return std::to_string(time.count() / 1000) + " s";
  return std::to_string(time.count()) + " ms";
}

/// Returns the first line that the child printed, without the name of the file that begins it.
std::string reason_of(std::string_view errors, const std::string& file) {
  errors = errors.substr(0, errors.find('\n'));
  const std::string prefix = printable_line(file, kLineBytesMax) + ": ";
  if (errors.substr(0, prefix.size()) == prefix) errors.remove_prefix(prefix.size());
  return printable_line(errors, kLineBytesMax);
}

/// Returns why the output of a child ended early.
std::string why_it_ended(ModelChild& child, const std::string& file,
                         const ModelFileOptions& options) {
  const int status = child.wait();
  if (child.stopped() == ModelChild::Stop::unwanted) return "is not wanted any more";
  if (child.stopped() == ModelChild::Stop::deadline)
    return "took longer than " + time_text(options.time_max);
  if (WIFEXITED(status) && WEXITSTATUS(status) == kRefusedExit) {
    const std::string reason = reason_of(child.errors(), file);
    return reason.empty() ? "cannot be read" : reason;
  }
  if (WIFSIGNALED(status)) {
    return "its reader " + how_it_ended(status) + ": the file is damaged, or too deeply nested";
  }
  return "its reader " + how_it_ended(status) + " without a model";
}

/// Receives the model. The error does not name the file.
Result<ReadModel, std::string> receive(ModelChild& child, const std::string& file,
                                       const ModelFileOptions& options) {
  const auto unsound = [](const std::string& why) {
    return failure("its reader sent no sound model: " + why);
  };
  const auto bytes_max = static_cast<std::size_t>(options.memory_mib) << 20;
  auto read = decode_model([&](std::span<std::uint8_t> to) { return child.fill(to); }, bytes_max);
  if (!read && read.error().code != ErrorCode::truncated) return unsound(read.error().what);
  if (!read) return failure(why_it_ended(child, file, options));
  const bool is_whole = child.is_at_end();
  if (!is_whole && child.stopped() == ModelChild::Stop::none) return unsound("bytes are left over");
  if (!is_whole || child.wait() != 0) return failure(why_it_ended(child, file, options));
  if (read->model.triangles.size() > options.triangles_max) return unsound("too many triangles");
  return *std::move(read);
}

}  // namespace

Result<ReadModel, std::string> read_model_file(const std::string& file,
                                               const ModelFileOptions& wanted) {
  const ModelFileOptions options = within_ranges(wanted);
  const std::string name = printable_line(file, kLineBytesMax);
  if (!model_format_of(file)) return failure(name + ": is no .obj, .stl, .ply, .gltf or .glb");
  if (auto regular = check_file_kind(file); !regular)
    return failure(printable_line(regular.error(), kLineBytesMax));
  const std::string program =
      sibling_program(options.program, "RUNSTONE_READ_MODEL", "runstone-read-model");
  auto child =
      ModelChild::start(command_line(program, file, options),
                        ModelChild::Clock::now() + options.time_max, options.should_continue);
  if (!child) {
    return failure(name + ": " + program + " cannot be started: " + child.error() +
                   "; models need this program (RUNSTONE_READ_MODEL says where it is)");
  }
  auto read = receive(*child, file, options);
  if (!read) return failure(name + ": " + read.error());
  return read;
}

}  // namespace runstone
