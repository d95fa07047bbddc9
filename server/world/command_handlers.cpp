#include "server/world/command_handlers.hpp"

#include <algorithm>
#include <utility>

namespace runstone {
namespace {

void send_lines(WorldState& world, SessionId session, std::uint32_t id,
                const std::vector<std::string>& lines, bool is_done, bool is_ok) {
  for (std::size_t first = 0;;) {
    const std::size_t last = std::min(lines.size(), first + kCommandLinesMax);
    CommandOutput output{id, {}, is_done && last == lines.size(), is_ok};
    output.lines.assign(lines.begin() + static_cast<std::ptrdiff_t>(first),
                        lines.begin() + static_cast<std::ptrdiff_t>(last));
    if (!send_or_close(world, session, output)) return;
    first = last;
    if (first == lines.size()) return;
  }
}

}  // namespace

void on_command(WorldState& world, SessionId session, const CommandRequest& request,
                const Clocks& now) {
  WorldSession& mine = *world.find(session);
  if (mine.command) {
    return send_lines(world, session, request.id,
                      {"one command at a time: the one before is still under way"}, true, false);
  }
  if (!mine.commands.take(1, now.steady_us)) {
    return send_lines(world, session, request.id, {"too many commands: wait a second"}, true,
                      false);
  }
  mine.command = request.id;
  world.environment.command(session, mine.author, mine.key, request.text);
}

std::optional<View> restore_preview_view(const WorldState& world, SessionId session) {
  const WorldSession* const mine = world.find(session);
  if (mine == nullptr || mine->state != SessionStage::open ||
      (mine->features & kFeatureRestorePreview) == 0)
    return std::nullopt;
  return world.interest.find(session)->view();
}

void send_restore_preview(WorldState& world, SessionId session, RestorePreview preview) {
  const WorldSession* const mine = world.find(session);
  if (mine == nullptr || !mine->command || (mine->features & kFeatureRestorePreview) == 0) return;
  preview.command = *mine->command;
  send_or_skip(world, session, encode_message(preview));
}

void send_command_output(WorldState& world, SessionId session,
                         const std::vector<std::string>& lines, bool is_done, bool is_ok) {
  WorldSession* const mine = world.find(session);
  if (mine == nullptr || !mine->command) return;
  const std::uint32_t id = *mine->command;
  if (is_done) mine->command.reset();
  send_lines(world, session, id, lines, is_done, is_ok);
}

}  // namespace runstone
