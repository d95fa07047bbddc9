// The subcommands of runstone-replay. Each has its options, a function that declares them on the
// command line, and a function that runs it, prints a table to `out` and returns the exit code.
#pragma once
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "common/core/result.hpp"
#include "common/formats/file_writing.hpp"
#include "server/history/named_moment.hpp"
#include "server/replay/subcommand_options.hpp"
#include "server/replay/timelapse.hpp"

namespace runstone {

/// verify: rebuilds a world from base and log and compares digests.
struct VerifyOptions {
  CommonOptions common;
  std::optional<NamedMoment> at;     // end of the replay; default: the end of the log
  std::vector<std::string> against;  // digest lists
  bool quick = false;                // read no row that the replay does not need
};

void declare_verify(SubcommandOptions& command_line, VerifyOptions& options);
/// Prints what was compared, and the first difference. Returns kReplayEqual, or kReplayDifferent if
/// there is a difference or the world lacks edits that were durable.
Result<int, std::string> run_verify(const VerifyOptions& options, std::ostream& out);

/// diff: the voxels that differ between two moments, and whose edits changed them.
struct DiffOptions {
  CommonOptions common;
  std::optional<NamedMoment> from, to;  // both are set once the command line is parsed
};

void declare_diff(SubcommandOptions& command_line, DiffOptions& options);
/// Prints the table. Requires from and to.
Result<int, std::string> run_diff(const DiffOptions& options, std::ostream& out);

/// copy: writes the world of a moment as a new world.
struct CopyOptions {
  CommonOptions common;
  std::string folder;             // of the new world
  std::optional<NamedMoment> at;  // default: the end of the log
};

void declare_copy(SubcommandOptions& command_line, CopyOptions& options);
/// Makes the new world and prints a table. Returns the code of code_of_output() (command_world.hpp).
Result<int, std::string> run_copy(const CopyOptions& options, std::ostream& out);

/// export: writes a world's log to an .rlog file (docs/edit-log.md), or a box of the world to a file
/// of another format (docs/formats.md).
struct ExportOptions {
  CommonOptions common;
  std::string file;
  std::string luanti;             // folder of a Luanti world to make instead of a file
  std::optional<NamedMoment> at;  // last edit of the file; default: the end of the log
  std::optional<VoxelBox> box;    // of the world; nullopt: the log is exported
  std::string name;               // of the build; empty: the name of the file
  FileWriting writing;
  std::uint64_t memory_mib = 1024;  // of the runs of a box, at most
};

void declare_export(SubcommandOptions& command_line, ExportOptions& options);
/// Writes the file and prints a table. Returns the code of code_of_output() (command_world.hpp).
Result<int, std::string> run_export(const ExportOptions& options, std::ostream& out);

/// dump: writes the materials of a box of the world to an .npy file (docs/replay.md).
struct DumpOptions {
  CommonOptions common;
  std::string file;
  std::optional<VoxelBox> box;     // set once the command line is parsed
  std::optional<NamedMoment> at;   // last edit in the array; default: the end of the log
  std::uint64_t memory_mib = 256;  // of voxels, at most
};

void declare_dump(SubcommandOptions& command_line, DumpOptions& options);
/// Writes the file and prints a table. Requires a box. Returns the code of code_of_output()
/// (command_world.hpp).
Result<int, std::string> run_dump(const DumpOptions& options, std::ostream& out);

/// import: appends an .rlog file to a world's log, or makes the world (docs/replay.md).
struct ImportOptions {
  CommonOptions common;
  std::string file;
  bool until_damage = false;  // make a new world of a damaged file, too
};

void declare_import(SubcommandOptions& command_line, ImportOptions& options);
/// Imports the file up to its first damaged block and prints a table. Fails if anything of the file
/// is damaged; the edits before it stay imported, but a new world is made with until_damage only.
Result<int, std::string> run_import(const ImportOptions& options, std::ostream& out);

/// play: plays a world's log into a live server. Only clients join a server, so runstone-bot plays
/// it, as a child process.
struct PlayOptions {
  CommonOptions common;           // json: the report of runstone-bot
  std::string connect;            // HOST:PORT of the live server
  std::optional<NamedMoment> at;  // last edit; default: the end of the log
  std::string speed = "1";        // times the recorded speed, or "max"; runstone-bot parses it too
  std::string bot;                // path of runstone-bot; empty: see sibling_program()
  bool insecure = false;          // the live server does not encrypt
};

void declare_play(SubcommandOptions& command_line, PlayOptions& options);
/// Exports the log to a temporary file, starts runstone-bot on it and waits for its end. Returns
/// its exit code. Removes the file in every case. Meanwhile SIGINT and SIGTERM are passed on to the
/// child. Blocks.
Result<int, std::string> run_play(const PlayOptions& options, std::ostream& out);

/// timelapse: draws a world as it grew, into pictures and a video.
struct TimelapseCommandOptions {
  CommonOptions common;
  std::optional<NamedMoment> at;  // of the last frame; default: the end of the log
  TimelapseOptions timelapse;
  std::uint64_t fps = 30;  // frames a second of the video, 1..120
};

void declare_timelapse(SubcommandOptions& command_line, TimelapseCommandOptions& options);
/// Draws the frames, joins them into a video if ffmpeg is installed, and prints a table. A missing
/// ffmpeg is no error.
Result<int, std::string> run_timelapse(const TimelapseCommandOptions& options, std::ostream& out);

/// keyframes: makes the keyframes that a world lacks, while no server runs it.
struct KeyframesOptions {
  CommonOptions common;
  std::uint64_t keyframe_edits = 32'768;  // least number of edits between two keyframes, 1..10^9
};

void declare_keyframes(SubcommandOptions& command_line, KeyframesOptions& options);
/// Makes the keyframes and prints their number. The keyframes made before an error stay.
Result<int, std::string> run_keyframes(const KeyframesOptions& options, std::ostream& out);

/// bench: how fast a world's log is read, and how fast the world is rebuilt from it.
struct BenchOptions {
  CommonOptions common;
  std::optional<NamedMoment> at;  // end of the replay; default: the end of the log
  std::uint64_t rounds = 5;       // 1..1000
};

void declare_bench(SubcommandOptions& command_line, BenchOptions& options);
/// Times reading and rebuilding in alternation and prints a table; the JSON report has every time.
/// Fails if the replay finds a difference. Memory: all edited chunks as runs.
Result<int, std::string> run_bench(const BenchOptions& options, std::ostream& out);

}  // namespace runstone
