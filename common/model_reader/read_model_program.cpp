#include "common/model_reader/read_model_program.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <map>
#include <new>
#include <optional>
#include <string>
#include <string_view>

#include "common/command_line/help_options.hpp"
#include "common/core/version.hpp"
#include "common/model_reader/model_file_reader.hpp"
#include "common/model_reader/process_limits.hpp"
#include "common/models/printable_line.hpp"

namespace runstone {
namespace {

constexpr int kFailed = 2;
constexpr std::size_t kErrorBytesMax = 1024;
constexpr std::uint64_t kMebibyte = std::uint64_t{1} << 20;

struct ReadModelOptions {
  std::string file;
  std::uint64_t memory_mib = 2048;
  std::uint32_t seconds = 60;
  std::size_t triangles_max = kModelTrianglesMax;
  std::optional<ModelUp> up;
};

bool write_all(int descriptor, const void* bytes, std::size_t count) {
  const auto* at = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t written = ::write(descriptor, at, count);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    at += written;
    count -= static_cast<std::size_t>(written);
  }
  return true;
}

void print_error(const std::string& line) {
  const std::string text = printable_line(line, kErrorBytesMax) + "\n";
  write_all(STDERR_FILENO, text.data(), text.size());
}

// The text for the moment when memory runs out. It must not take memory then.
std::string& memory_line() {
  static std::string line;
  return line;
}

[[noreturn]] void end_without_memory() {
  write_all(STDERR_FILENO, memory_line().data(), memory_line().size());
  std::_Exit(kFailed);
}

std::string memory_text(std::uint64_t mib) {
  return mib % 1024 == 0 ? std::to_string(mib / 1024) + " GiB" : std::to_string(mib) + " MiB";
}

Result<void, std::string> check_file(const ModelFolder& folder, std::uint64_t bytes_max) {
  const auto opened = folder.open(folder.name());
  if (opened && opened->bytes() > bytes_max) throw std::bad_alloc();
  if (opened) return {};
  switch (opened.error()) {
    case ModelFolder::Refusal::missing:
      return failure(std::string("does not exist"));
    case ModelFolder::Refusal::not_a_file:
      return failure(std::string("is no regular file"));
    default:
      return failure(std::string("cannot be opened"));
  }
}

/// The error is one line that does not name the file.
Result<void, std::string> read_and_write(const ReadModelOptions& options) {
  const auto format = model_format_of(options.file);
  if (!format) return failure(std::string("is no .obj, .stl, .ply, .gltf or .glb"));
  const std::uint64_t memory_bytes = options.memory_mib * kMebibyte;
  if (auto limited = limit_process({memory_bytes, options.seconds}); !limited) return limited;
  const auto folder = ModelFolder::of_file(options.file);
  if (!folder) return failure(folder.error());
  folder->confine_process();  // openat2() bounds the files where the kernel has no Landlock
  if (auto filtered = refuse_other_calls(); !filtered) return filtered;
  if (auto checked = check_file(*folder, memory_bytes); !checked) return checked;
  SceneRules rules;
  rules.format = *format;
  rules.up = options.up.value_or(usual_up(*format));
  rules.triangles_max = options.triangles_max;
  const auto read = read_model_in(*folder, rules);
  if (!read) return failure(read.error());
  const auto write_bytes = [](ByteView bytes) {
    return write_all(STDOUT_FILENO, bytes.data(), bytes.size());
  };
  if (!encode_model(*read, write_bytes))
    return failure("the model cannot be written: " + std::string(std::strerror(errno)));
  return {};
}

}  // namespace

int read_model_program(int argc, const char* const* argv) {
  ReadModelOptions options;
  CLI::App app("Reads a model from a file and writes it to a pipe. Other programs start it.",
               "runstone-read-model");
  app.set_version_flag("--version", "runstone-read-model " + std::string(version()));
  add_help_options(app, "runstone-read-model");
  app.add_option("FILE", options.file, "an .obj, .stl, .ply, .gltf or .glb")->required();
  app.add_option("--memory", options.memory_mib, "MiB that the program may take; default 2048")
      ->check(CLI::Range(1, 1 << 20));
  app.add_option("--seconds", options.seconds, "processor time that it may take; default 60")
      ->check(CLI::Range(1, 86'400));
  app.add_option("--triangles", options.triangles_max, "triangles that the model may have")
      ->check(CLI::Range(std::size_t{1}, kModelTrianglesMax));
  app.add_option("--up", options.up, "axis of the file that points up; default: z in .stl and .ply")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, ModelUp>{{"y", ModelUp::y}, {"z", ModelUp::z}}))
      ->option_text("y|z");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error, std::cout, std::cerr);
    std::cout.flush();  // the program ends without destructors
    return code;
  }
  memory_line() = printable_line(options.file, kErrorBytesMax) + ": needs more than " +
                  memory_text(options.memory_mib) + " of memory\n";
  std::set_new_handler(&end_without_memory);
  try {
    const auto done = read_and_write(options);
    if (done) return 0;
    print_error(options.file + ": " + done.error());
  } catch (const std::bad_alloc&) {
    end_without_memory();
  } catch (const std::exception& error) {
    print_error(options.file + ": cannot be read: " + error.what());
  }
  return kFailed;
}

}  // namespace runstone
