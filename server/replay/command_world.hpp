// Functions that the subcommands of runstone-replay share. They open a world, find the end of a
// replay, and print a report.
#pragma once
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/generate/generator.hpp"
#include "server/history/named_moment.hpp"
#include "server/store/store.hpp"

namespace runstone {

struct CommandWorld {
  std::unique_ptr<Store> store;
  std::unique_ptr<Generator> generator;
  Sequence end = 0;  // end_of_replay() of the requested moment
};

/// Opens the world at `place` for reading; a server may be running it. Fails if there is no world,
/// if this program lacks its generator, or if the world does not have the moment `end`. The error
/// is one line.
Result<CommandWorld, std::string> open_for_reading(const std::string& place,
                                                   const std::optional<NamedMoment>& end = {});

/// Returns the sequence number of the moment in this world, or the greatest sequence number if
/// there is no moment.
Result<Sequence, std::string> end_of_replay(Store& store, const std::optional<NamedMoment>& moment);

/// Returns the sequence number of the newest edit up to the end of the world that was opened, or of its
/// newest edit if it has fewer. The error is one line. Blocks on the disk.
Result<Sequence, std::string> end_in_log(const CommandWorld& world);

/// Begins a row of a report's table: writes the name in a column of twelve characters.
std::ostream& row(std::ostream& out, const char* name);
/// Writes the row "LOST" if the world lacks edits that were durable.
void print_loss(std::ostream& out, const Store& store);
/// Writes the row "world": id and file. Then print_loss().
void print_world(std::ostream& out, const Store& store);

/// Returns the exit code of a subcommand that has written out a world: kReplayDifferent if the world
/// lacks edits that were durable, because the output lacks them too, and kReplayEqual otherwise.
int code_of_output(const Store& store);

/// Writes a report, given as JSON text, to `file`, or does nothing if `file` is empty. The error is
/// one line.
Result<void, std::string> write_report(const std::string& file, const std::string& json);

}  // namespace runstone
