#include "server/world/people/commands.hpp"

#include <algorithm>
#include <utility>

namespace runstone {

void Commands::send_lines(Session& session, std::uint32_t id, const std::vector<std::string>& lines,
                          bool is_done, bool is_ok) {
  for (std::size_t first = 0;;) {
    const std::size_t last = std::min(lines.size(), first + kCommandLinesMax);
    CommandOutput output{id, {}, is_done && last == lines.size(), is_ok};
    output.lines.assign(lines.begin() + static_cast<std::ptrdiff_t>(first),
                        lines.begin() + static_cast<std::ptrdiff_t>(last));
    if (!sessions_.send_or_close(session, output)) return;
    first = last;
    if (first == lines.size()) return;
  }
}

void Commands::on_command(Session& session, const CommandRequest& request, const Clocks& now) {
  SessionCommands& mine = by_session_[session.id];
  if (mine.under_way) {
    return send_lines(session, request.id,
                      {"one command at a time: the one before is still under way"}, true, false);
  }
  if (!mine.left.take(1, now.steady_us))
    return send_lines(session, request.id, {"too many commands: wait a second"}, true, false);
  mine.under_way = request.id;
  environment_.command(session.id, session.author, session.key, request.text);
}

std::optional<View> Commands::restore_preview_view(SessionId session) const {
  const Session* const mine = std::as_const(sessions_).find(session);
  if (mine == nullptr || !mine->is_open() || !mine->has(kFeatureRestorePreview))
    return std::nullopt;
  return ground_.view_of(*mine);
}

void Commands::show_restore(SessionId session, RestorePreview preview) {
  const Session* const mine = sessions_.find(session);
  const auto commands = by_session_.find(session);
  if (mine == nullptr || commands == by_session_.end() || !commands->second.under_way ||
      !mine->has(kFeatureRestorePreview))
    return;
  preview.command = *commands->second.under_way;
  sessions_.send_or_skip(*mine, encode_message(preview));
}

void Commands::answer(SessionId session, const std::vector<std::string>& lines, bool is_done,
                      bool is_ok) {
  Session* const mine = sessions_.find(session);
  const auto commands = by_session_.find(session);
  if (mine == nullptr || commands == by_session_.end() || !commands->second.under_way) return;
  const std::uint32_t id = *commands->second.under_way;
  if (is_done) commands->second.under_way.reset();
  send_lines(*mine, id, lines, is_done, is_ok);
}

}  // namespace runstone
