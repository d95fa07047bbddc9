#include "server/replay/command_world.hpp"

#include <algorithm>
#include <iomanip>
#include <limits>
#include <ostream>
#include <utility>

#include "common/core/hex.hpp"
#include "common/os/output_file.hpp"
#include "server/replay/subcommand.hpp"
#include "server/store/world_folder.hpp"

namespace runstone {

Result<CommandWorld, std::string> open_for_reading(const std::string& place,
                                                   const std::optional<NamedMoment>& end) {
  auto store = open_world(place, StoreAccess::read_only);
  if (!store) return failure(store.error().message());
  auto generator = generator_of(**store);
  if (!generator) return failure(generator.error());
  const auto last = end_of_replay(**store, end);
  if (!last) return failure(last.error());
  return CommandWorld{*std::move(store), *std::move(generator), *last};
}

Result<Sequence, std::string> end_of_replay(Store& store,
                                            const std::optional<NamedMoment>& moment) {
  if (!moment) return std::numeric_limits<Sequence>::max();
  const auto at = sequence_of(store, *moment);
  if (!at) return failure(at.error().message());
  return *at;
}

Result<Sequence, std::string> end_in_log(const CommandWorld& world) {
  const auto last = world.store->last_sequence();
  if (!last) return failure(last.error().message());
  return std::min(world.end, *last);
}

std::ostream& row(std::ostream& out, const char* name) {
  return out << std::left << std::setw(12) << name << std::right;
}

void print_loss(std::ostream& out, const Store& store) {
  if (store.loss()) row(out, "LOST") << store.loss()->message() << '\n';
}

void print_world(std::ostream& out, const Store& store) {
  row(out, "world") << to_hex(store.meta().world_id) << "  " << store.file() << '\n';
  print_loss(out, store);
}

int code_of_output(const Store& store) { return store.loss() ? kReplayDifferent : kReplayEqual; }

Result<void, std::string> write_report(const std::string& file, const std::string& json) {
  if (file.empty()) return {};
  return write_output_file(file, json + "\n");
}

}  // namespace runstone
